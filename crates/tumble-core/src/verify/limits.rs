//! How far off a true calibration may be: the limits of [`super::Verifier`], from the calibration's own sigmas.
//!
//! A specific force at rest, `f = C (raw − b)`, is wrong by `δf = δC (raw − b) − C δb`, and raw − b is f to the few per cent of
//! C. Its variance per axis is therefore
//!
//! `v_i = Σ_j σ²(C_ij) f_j² + Σ_j C_ij² σ²(b_j)`
//!
//! to which come the mean's noise `n²/2T` (one-sided density n, T long), the bias instability, and the misfit that the
//! calibration itself showed at rest (what its model does not describe). Along the direction up, `Σ u_i² v_i` is the variance of
//! the length; across it, `max v_i / g²` bounds the variance of the tilt about either level axis.
//!
//! Carrying the direction for T with the path `Θ_j = ∫|ω_j| dt` adds, about either level axis, at most the largest over i of
//!
//! `T² Σ_j C_ij² σ²(b_j) + Σ_j σ²(C_ij) Θ_j²`
//!
//! the gyroscope's random walk `n² T/2`, and its bias instability times T. Both noise densities grow by the calibration's
//! normalised innovations where these show that the sensor is noisier than its sheet.
//!
//! False alarms: 6 lengths and at most 5 levels share one in a thousand, 9·10⁻⁵ each. A length is a normal deviate (two-sided
//! 3.92 σ), a level error the length of two (Rayleigh: `exp(−k²/2)`, 4.32 σ). The bounds above err on the wide side, so a true
//! calibration at its own temperature fails at most one check in a thousand. Temperature is not allowed for: a calibration
//! that does not hold at today's temperature does fail, and the verdict names the temperature.

use nalgebra::{Matrix3, Vector3};

use super::propagate::Propagation;
use crate::calibration::{Calibration, TriadEstimate};
use crate::{DEGREE_RAD, STANDARD_GRAVITY_MPS2};

/// Two-sided normal quantile of 9·10⁻⁵.
const GRAVITY_SIGMAS: f32 = 3.92;
/// Rayleigh quantile of 9·10⁻⁵.
const LEVEL_SIGMAS: f32 = 4.32;
/// 300 µg/√Hz (sheet), m/s²/√Hz.
const ACCEL_DENSITY: f32 = 300e-6 * STANDARD_GRAVITY_MPS2;
/// 0.01 °/s/√Hz (sheet), rad/s/√Hz.
const GYRO_DENSITY: f32 = 0.01 * DEGREE_RAD;
/// Bias instability, m/s²: 100 µg, typical Allan minimum of this family; not in its sheet.
const ACCEL_INSTABILITY: f32 = 100e-6 * STANDARD_GRAVITY_MPS2;
/// Bias instability, rad/s: 20 °/h, typical Allan minimum of this family; not in its sheet.
const GYRO_INSTABILITY: f32 = 20.0 / 3600.0 * DEGREE_RAD;

/// The limits for one calibration.
#[derive(Clone, Debug)]
pub struct Limits {
    accelerometer: Variances,
    gyroscope: Variances,
    /// By how much the noise is larger than the sheet's, at least 1.
    inflation: f32,
    /// Misfit and instability, (m/s²)².
    floor: f32,
}

/// Variances of one triad: of the bias seen through C, and of C.
#[derive(Clone, Debug)]
struct Variances {
    bias: Vector3<f32>,
    correction: Matrix3<f32>,
}

impl Variances {
    fn new(estimate: &TriadEstimate) -> Self {
        let square = |m: &Matrix3<f32>| m.component_mul(m);
        let bias_variance = estimate.bias_sigma.component_mul(&estimate.bias_sigma);
        Self {
            bias: square(&estimate.triad.correction) * bias_variance,
            correction: square(&estimate.correction_sigma),
        }
    }

    /// Per axis, for a bias that acts for `time` and an input of squares `input`.
    fn per_axis(&self, time: f32, input: &Vector3<f32>) -> Vector3<f32> {
        self.bias * (time * time) + self.correction * input
    }
}

impl Limits {
    /// From a calibration's sigmas and fit.
    pub fn new(calibration: &Calibration) -> Self {
        let misfit = calibration.fit.gravity_rms_mps2;
        Self {
            accelerometer: Variances::new(&calibration.accelerometer),
            gyroscope: Variances::new(&calibration.gyroscope),
            inflation: calibration.fit.nis_per_dof.max(1.0),
            floor: misfit * misfit + ACCEL_INSTABILITY * ACCEL_INSTABILITY,
        }
    }

    /// Limit of |‖f‖ − g|, m/s², with `up` the unit direction in box axes and a mean over `rest_s`.
    pub fn gravity(&self, up: &Vector3<f32>, rest_s: f32) -> f32 {
        let variance = up.component_mul(up).dot(&self.force_variance(up)) + self.mean_variance(rest_s);
        GRAVITY_SIGMAS * libm::sqrtf(variance)
    }

    /// Variance of the measured direction about either level axis, rad².
    pub fn tilt_variance(&self, up: &Vector3<f32>, rest_s: f32) -> f32 {
        let variance = self.force_variance(up).max() + self.mean_variance(rest_s);
        variance / (STANDARD_GRAVITY_MPS2 * STANDARD_GRAVITY_MPS2)
    }

    /// Limit of the angle after a move, rad; `end_variance` is the [`Self::tilt_variance`] at its end.
    pub fn level(&self, moved: &Propagation, end_variance: f32) -> f32 {
        let (time_s, path) = (moved.duration_s(), moved.path_rad());
        let carried = self.gyroscope.per_axis(time_s, &path.component_mul(path)).max();
        let walk = self.inflation * GYRO_DENSITY * GYRO_DENSITY * time_s / 2.0;
        let instability = GYRO_INSTABILITY * time_s;
        let variance = carried + walk + instability * instability + moved.start_variance() + end_variance;
        LEVEL_SIGMAS * libm::sqrtf(variance)
    }

    fn force_variance(&self, up: &Vector3<f32>) -> Vector3<f32> {
        let force = up * STANDARD_GRAVITY_MPS2;
        self.accelerometer.per_axis(1.0, &force.component_mul(&force))
    }

    fn mean_variance(&self, rest_s: f32) -> f32 {
        self.floor + self.inflation * ACCEL_DENSITY * ACCEL_DENSITY / (2.0 * rest_s)
    }
}
