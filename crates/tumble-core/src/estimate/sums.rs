//! What a pass's innovations say of the noise.

use super::hinge::Hinge;
use super::likelihood::Likelihood;
use super::turn_noise::Pool;

/// What a pass learns about a segment, carried into the next.
#[derive(Clone, Copy, Debug)]
pub struct SegmentNoise {
    /// Factor on the specific force's noise.
    pub force_scale: f32,
    /// Factor on the gyroscope's noise during this move.
    pub rate_scale: f32,
    /// The level after this move; none if there was no rest on both sides.
    pub hinge: Option<Hinge>,
}

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// NIS and count over specific force at rest.
    pub rest: (f32, f32),
    /// Turns: the noise of the specific force.
    pub turn_noise: Pool,
    /// Turns: the pivot's variance.
    pub pivot: Likelihood,
    /// Closure residuals, rad² and count.
    pub closed: (f32, f32),
}
