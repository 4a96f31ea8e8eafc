//! A box at rest whose gyroscope's bias has jumped, and a steady turn that was taken for rest: gravity tells the two apart.
//!
//! After a jump by more than two rests may differ ([`super::stillness`]) all that follows is one steady turn to the test
//! of the mean rate, and no rest would ever come. Let d be the rate of a quiet run less that of the last rest. If it were rotation, gravity
//! would turn with the part of d across it, over a chord of `2 sin(|d| T/2) |d⊥|/|d|`. Where gravity stayed within half of that,
//! and half of it lies beyond noise at a rate of 1e-6, the box rests and d is the gyroscope's. Crooked axes (3 %, 3° askew: 8 %) lend a steady turn
//! about gravity a d⊥ as well, so d⊥ must be a third of d. A jump along gravity is told on the next face.
//!
//! On the face of the last rest that is a bias that jumped. On another face it may be what the gyroscope feels of force, 0.5 °/s between opposite
//! faces at 0.25 °/s a g: it is rest, and the estimator tells what of.

use nalgebra::Vector3;

use super::block::Block;
use super::means::{mean_force, mean_rate};
use super::stillness::{Excess, INDEPENDENT, UNKNOWN_OFFSET, Z};
use crate::tape::{Exclusion, Kind, Segment, Tape};

/// The least part of d across gravity.
const LEAST_SHARE: f32 = 1.0 / 3.0;
/// Blocks of a run, at the least, …
const RUN_BLOCKS: u32 = 6;
/// … and their length, s.
pub const RUN_S: f32 = 1.5;

/// A run of blocks that are quiet but for their mean rate.
#[derive(Clone, Debug)]
pub struct Standstill {
    blocks: u32,
    start_us: u64,
    /// Mean rate of the run, rad/s.
    rate: Vector3<f32>,
    /// Mean specific force of its first block, m/s².
    force: Vector3<f32>,
    /// The furthest that a block's specific force lay from it, m/s².
    swing: f32,
}

impl Standstill {
    /// No run.
    pub const fn new() -> Self {
        let zero = Vector3::new(0.0, 0.0, 0.0);
        Self { blocks: 0, start_us: 0, rate: zero, force: zero, swing: 0.0 }
    }

    /// Takes a block that began at `start_us`; `rest` is the last rest's rate, rad/s. The jump, rad/s, once it is certain.
    pub fn step(
        &mut self,
        block: &Block,
        start_us: u64,
        excess: &Excess,
        rest: Option<Vector3<f32>>,
    ) -> Option<Vector3<f32>> {
        let rest = rest.filter(|_| excess.variance.max(excess.wander) <= 1.0 && excess.offset > 1.0);
        let Some(rest) = rest else {
            self.blocks = 0;
            return None;
        };
        if self.blocks == 0 {
            *self = Self { start_us, force: block.mean_force, ..Self::new() };
        }
        self.blocks += 1;
        self.rate += (block.mean_rate - self.rate) / self.blocks as f32;
        self.swing = self.swing.max((block.mean_force - self.force).norm());
        let jump = self.rate - rest;
        let seconds = (block.end_us - self.start_us) as f32 * 1e-6;
        let rests =
            self.blocks >= RUN_BLOCKS && jump.norm() <= UNKNOWN_OFFSET && self.contradicts(&jump, seconds, block);
        rests.then(|| {
            self.blocks = 0;
            jump
        })
    }

    /// Would gravity have turned, had this been rotation?
    fn contradicts(&self, jump: &Vector3<f32>, seconds: f32, block: &Block) -> bool {
        let Some(across) = across(jump, &self.force) else { return false };
        let angle = (jump.norm() * seconds).min(core::f32::consts::PI);
        let half_chord = libm::sinf(0.5 * angle) * across * self.force.norm();
        // Two means of three components each.
        let independent = (block.samples as f32 * INDEPENDENT).max(1.0);
        let noise = Z * libm::sqrtf(6.0 * block.force_variance / independent);
        self.swing < half_chord && noise < half_chord
    }
}

/// The part of a rate across gravity, as a share of it, where it is a third or more.
fn across(rate: &Vector3<f32>, force: &Vector3<f32>) -> Option<f32> {
    let up = force.normalize();
    let share = (rate - up * rate.dot(&up)).norm() / rate.norm();
    (share > LEAST_SHARE).then_some(share)
}

/// Strikes out stills that were steady turns, now that a later rest has the mean rate `rest`, rad/s: two rests cannot differ by more than an
/// offset drifts. None is struck, and the answer is no, where one of them differs across its gravity, which stood still: then none was a turn.
pub fn strike_turns<const R: usize, const S: usize>(tape: &mut Tape<R, S>, rest: &Vector3<f32>) -> bool {
    let usable = |segment: &Segment| matches!(segment.kind, Kind::Still { .. }) && segment.exclusion == Exclusion::None;
    let rested = |still: &Segment| {
        let (first, end) = (usize::from(still.first), usize::from(still.end));
        across(&(mean_rate(tape, first, end) - rest), &mean_force(tape, first, end)).is_some()
    };
    if tape.segments().iter().any(|segment| usable(segment) && rested(segment)) {
        return false;
    }
    for segment in tape.segments_mut().iter_mut().filter(|segment| usable(segment)) {
        segment.exclusion = Exclusion::SteadyTurn;
    }
    true
}
