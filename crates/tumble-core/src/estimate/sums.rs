//! What a pass's innovations say of the noise.

use super::likelihood::Likelihood;
use super::turn_noise::Pool;

/// What a pass learns about a segment, carried into the next.
#[derive(Clone, Copy, Debug)]
pub struct SegmentNoise {
    /// Factor on the specific force's noise.
    pub force_scale: f32,
    /// Factor on the gyroscope's noise during this move.
    pub rate_scale: f32,
    /// Level error after this move about the nominal, normalised without `rate_scale`: χ² with 2 degrees of freedom if the
    /// move fits. NaN if there was no rest on both sides.
    pub hinge_nis: f32,
    /// By what factor of the gyroscope's noise half of such moves would end as far off, if no bias walked.
    pub hinge_scatter: f32,
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
