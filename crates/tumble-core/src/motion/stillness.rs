//! Is it still? A test on quarter-second blocks, with limits from the sensor's own noise and a false-alarm rate.
//!
//! Under rest the pooled sample variance of a block is `σ² χ²_ν / ν`. It passes up to
//! `σ² (1 + m²) q`, where q is the χ²_ν/ν quantile at a false-alarm rate of 1e-6 a block (once in 70 hours; Wilson and
//! Hilferty's approximation) and m = 3 admits a trembling of three times the sensor's noise: people do not hold a board
//! perfectly still, and what trembles more than its noise is told later by its scatter. σ² is learnt as the smallest
//! one-second mean so far.
//!
//! Variance alone would pass a steady turn. So the mean rate must also lie near the resting rate of earlier stills (before
//! the first: within what a sensor's zero offset can be), and neither mean may wander from block to block.

use nalgebra::Vector3;

use super::block::Block;
use crate::DEGREE_RAD;

/// Upper 1e-6 point of the normal distribution.
pub(super) const Z: f32 = 4.753;
/// Share of samples that count as independent: a 41 Hz low-pass sampled at 200 Hz passes noise of about 64 Hz equivalent
/// bandwidth, so 2·64/200 = 0.64 at best; sensors with lower filters have less.
pub(super) const INDEPENDENT: f32 = 0.4;
/// Admitted trembling over the sensor's noise.
const TREMBLING: f32 = 3.0;
/// No MEMS of this class is noisier at rest in its widest bandwidth (MPU-6050, low-pass off: 0.1 °/s, 8 mg).
const RATE_CAP: f32 = 0.8 * DEGREE_RAD;
const FORCE_CAP: f32 = 0.3;
/// No quieter floor is believed: half a count of the finest range, so that repeated values do not make every hand's touch
/// a move.
const RATE_FLOOR: f32 = 0.01 * DEGREE_RAD;
const FORCE_FLOOR: f32 = 0.003;
/// Zero offset before any rest is known: the MPU9250's sheet has ±5 °/s, its siblings up to twice that in practice.
pub(super) const UNKNOWN_OFFSET: f32 = 10.0 * DEGREE_RAD;
/// Zero offset against the rest before: ±30 °/s over −40…85 °C (sheet) is 0.24 °/s a degree; two degrees at most lie
/// between two rests.
const KNOWN_OFFSET: f32 = 0.5 * DEGREE_RAD;
/// Slow wandering of a resting box (a table that gives): per block.
const RATE_WANDER: f32 = 0.05 * DEGREE_RAD;
const FORCE_WANDER: f32 = 0.02;
/// Blocks in the mean that the noise floor is learnt from.
const FLOOR_BLOCKS: usize = 4;
/// Leaving rest by variance takes this many times the limit of entering it.
const HYSTERESIS: f32 = 2.0;
/// Blocks after which a rest's mean forgets (5 s), so that it follows a warming sensor.
const MEMORY_BLOCKS: f32 = 20.0;

/// The detector's memory.
#[derive(Clone, Debug)]
pub struct Stillness {
    rate_floor: f32,
    force_floor: f32,
    recent: [(f32, f32); FLOOR_BLOCKS],
    seen: usize,
    reference: Option<Reference>,
    resting_rate: Option<Vector3<f32>>,
    tolerance: f32,
}

/// What a block's means are held against.
#[derive(Clone, Copy, Debug)]
struct Reference {
    blocks: f32,
    rate: Vector3<f32>,
    force: Vector3<f32>,
    rate_variance: f32,
    force_variance: f32,
}

/// A block's distance from rest: each test's statistic over its limit, 1 at the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excess {
    /// Variances.
    pub variance: f32,
    /// Means against those before.
    pub wander: f32,
    /// Mean rate against the resting rate.
    pub offset: f32,
}

impl Excess {
    /// What decides whether it comes to rest.
    pub fn of_entering(&self) -> f32 {
        self.variance.max(self.wander).max(self.offset)
    }

    /// What decides whether it stays at rest.
    pub fn of_leaving(&self) -> f32 {
        (self.variance / HYSTERESIS).max(self.wander).max(self.offset)
    }
}

impl Stillness {
    /// `tolerance` multiplies every limit (as a standard deviation); 1 is the derived value.
    pub const fn new(tolerance: f32) -> Self {
        Self {
            rate_floor: f32::INFINITY,
            force_floor: f32::INFINITY,
            recent: [(0.0, 0.0); FLOOR_BLOCKS],
            seen: 0,
            reference: None,
            resting_rate: None,
            tolerance,
        }
    }

    /// The resting rate of the last still, rad/s.
    pub fn resting_rate(&self) -> Option<Vector3<f32>> {
        self.resting_rate
    }

    /// Takes a still's mean rate as the new reference.
    pub fn set_resting_rate(&mut self, rate: Vector3<f32>) {
        self.resting_rate = Some(rate);
    }

    /// Forgets the blocks before, after a gap.
    pub fn interrupt(&mut self) {
        self.reference = None;
        self.seen = 0;
    }

    /// Judges a block and learns from it. `resting`: it has rested so far.
    pub fn judge(&mut self, block: &Block, resting: bool) -> Excess {
        self.learn(block);
        let clipped = if block.clipped > 0 { f32::INFINITY } else { 0.0 };
        let excess = Excess {
            variance: (self.variance_excess(block) / self.tolerance).max(clipped),
            wander: self.wander_excess(block) / self.tolerance,
            offset: self.offset_excess(block) / self.tolerance,
        };
        let before = self.reference.filter(|_| resting && excess.of_leaving() <= 1.0);
        self.reference = Some(Reference::with(before, block));
        excess
    }

    fn learn(&mut self, block: &Block) {
        self.recent[self.seen % FLOOR_BLOCKS] = (block.rate_variance, block.force_variance);
        self.seen += 1;
        if self.seen >= FLOOR_BLOCKS {
            let mean = |f: fn(&(f32, f32)) -> f32| self.recent.iter().map(f).sum::<f32>() / FLOOR_BLOCKS as f32;
            self.rate_floor = self.rate_floor.min(mean(|r| r.0)).max(RATE_FLOOR * RATE_FLOOR);
            self.force_floor = self.force_floor.min(mean(|r| r.1)).max(FORCE_FLOOR * FORCE_FLOOR);
        }
    }

    fn variance_excess(&self, block: &Block) -> f32 {
        let ratio = (1.0 + TREMBLING * TREMBLING) * chi_squared_ratio(degrees_of_freedom(block));
        let rate_limit = (self.rate_floor * ratio).min(RATE_CAP * RATE_CAP);
        let force_limit = (self.force_floor * ratio).min(FORCE_CAP * FORCE_CAP);
        libm::sqrtf((block.rate_variance / rate_limit).max(block.force_variance / force_limit))
    }

    /// Difference of two means against its own sigma at the same one-sided false-alarm rate.
    fn wander_excess(&self, block: &Block) -> f32 {
        let Some(reference) = self.reference else { return 0.0 };
        let independent = (block.samples as f32 * INDEPENDENT).max(1.0);
        let share = (1.0 + 1.0 / reference.blocks) / independent;
        let limit = |variance: f32, wander: f32| Z * libm::sqrtf(variance * share) + wander;
        let rate = (block.mean_rate - reference.rate).amax();
        let force = (block.mean_force - reference.force).amax();
        let rate_limit = limit(block.rate_variance.min(2.0 * reference.rate_variance), RATE_WANDER);
        let force_limit = limit(block.force_variance.min(2.0 * reference.force_variance), FORCE_WANDER);
        (rate / rate_limit).max(force / force_limit)
    }

    fn offset_excess(&self, block: &Block) -> f32 {
        let independent = (block.samples as f32 * INDEPENDENT).max(1.0);
        match self.resting_rate {
            Some(rest) => {
                let limit = KNOWN_OFFSET + Z * libm::sqrtf(block.rate_variance / independent);
                (block.mean_rate - rest).amax() / limit
            }
            None => block.mean_rate.amax() / UNKNOWN_OFFSET,
        }
    }
}

impl Reference {
    fn with(before: Option<Self>, block: &Block) -> Self {
        let Some(before) = before else {
            return Self {
                blocks: 1.0,
                rate: block.mean_rate,
                force: block.mean_force,
                rate_variance: block.rate_variance,
                force_variance: block.force_variance,
            };
        };
        let blocks = (before.blocks + 1.0).min(MEMORY_BLOCKS);
        let share = 1.0 / blocks;
        Self {
            blocks,
            rate: before.rate.lerp(&block.mean_rate, share),
            force: before.force.lerp(&block.mean_force, share),
            rate_variance: before.rate_variance + (block.rate_variance - before.rate_variance) * share,
            force_variance: before.force_variance + (block.force_variance - before.force_variance) * share,
        }
    }
}

/// Three axes, less one mean each, thinned to independent samples.
fn degrees_of_freedom(block: &Block) -> f32 {
    (3.0 * (block.samples as f32 - 1.0) * INDEPENDENT).max(3.0)
}

/// Upper 1e-6 quantile of χ²_ν/ν (Wilson & Hilferty 1931).
fn chi_squared_ratio(nu: f32) -> f32 {
    let c = 2.0 / (9.0 * nu);
    let root = 1.0 - c + Z * libm::sqrtf(c);
    root * root * root
}
