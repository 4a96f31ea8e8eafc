//! A short stretch of time over which the twin's filter is carried at once.

use nalgebra::{Matrix3, Vector3};

use super::state::Drive;

/// One step. What its stretch does not need is zero.
#[derive(Clone, Debug)]
pub struct Step {
    /// First sample.
    pub first: usize,
    /// Last sample, the next step's first.
    pub last: usize,
    /// On something solid.
    pub solid: bool,
    /// Length, s.
    pub duration_s: f64,
    /// s.
    pub middle_s: f64,
    /// s.
    pub end_s: f64,
    /// In the second half of its stretch.
    pub late: bool,
    /// How φ grows: `R (δM (ω_raw − b) − M δb) dt − Ω dt` summed.
    pub drive: Drive,
    /// Its mean over the step.
    pub mean_drive: Drive,
    /// `rotation_b_from_n` at the first sample.
    pub to_b: Matrix3<f64>,
    /// `M (raw − b) − Rᵀ Ω`, mean, rad/s.
    pub rate: Vector3<f64>,
    /// `A (raw − a) − Rᵀ g ẑ`, mean, m/s².
    pub force: Vector3<f64>,
    /// What the accelerometer is to read of gravity, `A⁻¹ Rᵀ g ẑ`, mean: the coefficients of δA by prediction, not as measured,
    /// because noise that stands in residual and coefficient alike would pass for information about elements of which nothing
    /// is known yet.
    pub gravity: Vector3<f64>,
    /// `g Rᵀ ẑ×`, mean.
    pub tilt: Matrix3<f64>,
    /// `[ω×]² + [ω̇×]`, mean.
    pub lever: Matrix3<f64>,
}
