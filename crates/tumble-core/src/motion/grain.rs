//! How coarse the sensor's numbers are, and what rounding leaves in a mean.
//!
//! A rest shows one reading x and noise of variance σ², rounded to steps of Δ. The mean of the rounded readings is off from that of
//! the readings by (Fourier series of the sawtooth, averaged over Gaussian noise; Widrow & Kollár 2008, ch. 4)
//!
//! `e(x) = Σₖ (−1)ᵏ Δ/(πk) · sin(2πk x/Δ) · exp(−2π²k²σ²/Δ²)`
//!
//! and no length of rest makes that smaller. Where x lies within its step is not known; over all places e has the variance
//!
//! `b² = Σₖ Δ²/(2π²k²) · exp(−4π²k²σ²/Δ²)`,
//!
//! which is `Δ²/12` without noise (Σ 1/k² = π²/6), and 0.2 % of a step at σ = Δ/2: noise of half a step dithers it away.
//! In motion a reading sweeps over many steps, so that there is no such offset: the rests alone are off.
//!
//! The noise before rounding follows from the variance V of the rounded readings, which over all x is `σ² + Δ²/12 − b²(σ)`, because
//! the rounding error, its mean e included, has the variance Δ²/12 and is uncorrelated with the noise. V is taken of the axis where it is
//! least: one that lies amid its step shows less noise than there is, so that b is rather too large than too small.
//!
//! The step is the least difference but none of two readings in a row. A stream that is not rounded gives some tiny number for
//! it, beside which any noise is large.

use nalgebra::Vector3;

use super::block::Block;
use crate::sample::Sample;

/// Terms of the series. What four leave out is shared by all of them, so that without noise b is Δ/√12 to the last digit.
const TERMS: usize = 4;
/// Halvings of the interval that σ is sought in: to a 2000th of a step.
const HALVINGS: u32 = 11;
/// A rest on something solid, as against one in the hand, shows rates whose variance is at most this many times the quietest's; by chance
/// alone less than one in a million exceeds it (100 independent values: χ²₁₀₀/100 > 2).
pub const SOLID: f32 = 2.0;

/// Sample variances of rests, gyroscope's and accelerometer's axes, and over how many blocks they are summed.
#[derive(Clone, Copy, Debug)]
struct Sums {
    variances: [Vector3<f32>; 2],
    blocks: f32,
}

/// Steps and noise of both triads.
#[derive(Clone, Copy, Debug)]
pub struct Grain {
    last: Option<[Vector3<f32>; 2]>,
    steps: [Option<f32>; 2],
    open: Sums,
    rests: Sums,
    quietest: Option<f32>,
}

impl Sums {
    const NONE: Self = Self { variances: [Vector3::new(0.0, 0.0, 0.0); 2], blocks: 0.0 };

    fn add(&mut self, other: &Self) {
        self.variances[0] += other.variances[0];
        self.variances[1] += other.variances[1];
        self.blocks += other.blocks;
    }
}

impl Default for Grain {
    fn default() -> Self {
        Self::new()
    }
}

impl Grain {
    /// Nothing seen. All of it is zero, as all of a new tape: one other number, an infinity say, would put 48 KB of tape into the
    /// flash of the board, to be copied from there at start.
    pub const fn new() -> Self {
        Self { last: None, steps: [None; 2], open: Sums::NONE, rests: Sums::NONE, quietest: None }
    }

    /// Takes a reading.
    pub fn see(&mut self, sample: &Sample) {
        let now = [sample.angular_rate_rad_s, sample.specific_force_mps2];
        if let Some(last) = self.last.replace(now) {
            for ((step, now), last) in self.steps.iter_mut().zip(&now).zip(&last) {
                for difference in (now - last).iter().map(|difference| libm::fabsf(*difference)) {
                    if difference > 0.0 && step.is_none_or(|step| difference < step) {
                        *step = Some(difference);
                    }
                }
            }
        }
    }

    /// A block of a rest.
    pub fn rest(&mut self, block: &Block) {
        self.open.add(&Sums { variances: block.axis_variances, blocks: 1.0 });
    }

    /// The rest is over, its rates' variance being this in the mean over axes.
    pub fn end_rest(&mut self, rate_variance: f32) {
        let open = core::mem::replace(&mut self.open, Sums::NONE);
        let rate_variance = rate_variance.max(self.toggling());
        let before = self.quietest.unwrap_or(f32::INFINITY);
        if SOLID * rate_variance < before {
            self.rests = Sums::NONE;
        }
        let quietest = before.min(rate_variance);
        self.quietest = Some(quietest);
        if rate_variance <= SOLID * quietest {
            self.rests.add(&open);
        }
    }

    /// Half of the variance of a rate that lies between two numbers and is rounded to either as often, Δ²/4, (rad/s)²: whatever the noise,
    /// rests differ by so much according to where their readings lie.
    pub fn toggling(&self) -> f32 {
        self.steps[0].map_or(0.0, |step| 0.125 * step * step)
    }

    /// Variance of what rounding leaves in the mean of a rest, gyroscope (rad/s)² and accelerometer (m/s²)².
    pub fn offset_variances(&self) -> [f32; 2] {
        core::array::from_fn(|triad| {
            let Some(step) = self.steps[triad] else { return 0.0 };
            let variance = self.rests.variances[triad].min() / (self.rests.blocks * step * step);
            if variance.is_finite() { step * step * offset(noise(variance)) } else { 0.0 }
        })
    }
}

/// b² of a noise of variance σ², in steps.
fn offset(variance: f32) -> f32 {
    const PI2: f32 = core::f32::consts::PI * core::f32::consts::PI;
    let (mut sum, mut all) = (0.0, 0.0);
    for k in 1..=TERMS {
        let square = (k * k) as f32;
        sum += libm::expf(-4.0 * PI2 * square * variance) / square;
        all += 1.0 / square;
    }
    sum / (12.0 * all)
}

/// σ² of what was rounded, from that of the rounded readings, in steps. The latter grows with the former, from nothing.
fn noise(rounded: f32) -> f32 {
    // Beyond one step of noise nothing is left of e, and rounding adds its Δ²/12.
    let (mut low, mut high) = (0.0f32, 1.0f32);
    for _ in 0..HALVINGS {
        let sigma = 0.5 * (low + high);
        let variance = sigma * sigma;
        if variance + 1.0 / 12.0 - offset(variance) < rounded { low = sigma } else { high = sigma }
    }
    low * low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::block::Accumulator;

    /// Readings of known noise at any place within their step: how far their means are off, in steps, and what is said of it.
    fn session(sigma: f32, step: f32) -> (f32, f32) {
        let mut state = 1u32;
        let mut uniform = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        let (mut squares, mut said) = (0.0, 0.0);
        let sessions = 60;
        for _ in 0..sessions {
            let truth = Vector3::from_fn(|_, _| 40.0 * uniform() - 20.0);
            let (mut grain, mut accumulator) = (Grain::new(), Accumulator::new());
            let mut sum = Vector3::zeros();
            let count = 4000;
            for n in 0..count {
                // The sum of twelve is as good as Gaussian here.
                let noise = Vector3::from_fn(|_, _| (0..12).map(|_| uniform()).sum::<f32>() - 6.0) * sigma;
                let read = (truth + noise).map(libm::roundf);
                sum += read;
                let rate = read * step;
                let sample = Sample {
                    t_us: 5000 * n,
                    angular_rate_rad_s: rate,
                    specific_force_mps2: rate,
                    temperature_degc: 25.0,
                };
                grain.see(&sample);
                if let Some(block) = accumulator.push(&sample, 0).block {
                    grain.rest(&block);
                }
            }
            // A move, without which a sensor that never changes its reading would not show its step.
            for rate in [0.0, step, 7.0 * step] {
                let rate = Vector3::repeat(rate);
                let sample =
                    Sample { t_us: 0, angular_rate_rad_s: rate, specific_force_mps2: rate, temperature_degc: 25.0 };
                grain.see(&sample);
            }
            grain.end_rest(1.0);
            squares += (sum / count as f32 - truth).norm_squared() / 3.0;
            said += grain.offset_variances()[0] / (step * step);
        }
        (libm::sqrtf(squares / sessions as f32), libm::sqrtf(said / sessions as f32))
    }

    #[test]
    fn a_mean_of_rounded_readings_is_off_by_as_much_as_is_said() {
        for sigma in [0.0, 0.05, 0.1, 0.2, 0.3] {
            let (off, said) = session(sigma, 1e-3);
            // Never too small; too large where the quietest axis happens to lie amid its step.
            assert!(said > 0.85 * off && said < 0.3, "noise of {sigma} steps: off by {off}, said {said}");
        }
        let (off, said) = session(0.0, 1e-3);
        assert!((off / said - 1.0).abs() < 0.15 && (said - 0.2887).abs() < 1e-3, "{off} {said}");
    }

    #[test]
    fn noise_of_half_a_step_leaves_nothing() {
        for sigma in [0.5, 0.7, 1.3] {
            let (_, said) = session(sigma, 1e-3);
            assert!(said < 0.003, "noise of {sigma} steps: said {said}");
        }
    }

    #[test]
    fn the_formula_has_its_limits() {
        assert!((offset(0.0) - 1.0 / 12.0).abs() < 1e-7);
        let first = libm::expf(-2.0 * (core::f32::consts::PI * 0.4) * (core::f32::consts::PI * 0.4));
        let harmonic = first / (core::f32::consts::PI * core::f32::consts::SQRT_2);
        // The first harmonic's share of the four is 0.92 of what it has in the full series.
        assert!((libm::sqrtf(offset(0.16)) / harmonic - 1.0).abs() < 0.1);
        assert!((noise(0.16 + 1.0 / 12.0) - 0.16).abs() < 1e-2);
    }
}
