//! What a block of samples comes to.

use nalgebra::Vector3;

/// An interval's sums.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Length, s.
    pub dt_s: f32,
    /// Rotation vector by the raw gyroscope, rad, sensor axes; coning included, of rates less the resting rate.
    pub rotation_rad: Vector3<f32>,
    /// Mean raw specific force, m/s², sensor axes.
    pub specific_force_mps2: Vector3<f32>,
}
