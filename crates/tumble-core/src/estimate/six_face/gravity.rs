//! The accelerometer's bias and 3×3 from what each face says on average.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use super::{CORRECTION_SIGMA, Real, RestRates, Setting, Tilt, Visit, VisitFit, real, vector, visits};
use crate::calibration::Triad;
use crate::tape::Tape;

/// Prior of a table's tilt along one box axis, 1: 3°.
pub(super) const TILT_SIGMA: f32 = 0.052;
/// Prior of a bias, m/s²: sheet 80 mg.
const BIAS_SIGMA: f32 = 0.8;
/// A tilt along one axis is known when it is better than this, 1: its cosine is then good to 4e-5 at 1.5°.
const TILT_KNOWN: f32 = 1.5e-3;

/// `f = (1 + E)⁻¹ (correction (raw − bias) − β)` with E, β = 0 at the last round: 3×3, dimensionless; bias in sensor axes.
///
/// Each visit gives its mean m = β + g cos τ (1 + E) n ([`VisitFit`]); each row i of frame b is then a regression on
/// `(β_i, E_i0, E_i1, E_i2)` over the visits, weighted by their variances. Where a face was not turned, its transverse
/// components are as uncertain as the tilt, and the opposite face and the other axes' biases decide.
#[derive(Clone, Debug, PartialEq)]
pub struct AccelMatrix<T: Real> {
    /// m/s², sensor axes.
    pub bias: Vector3<T>,
    /// Dimensionless.
    pub correction: Matrix3<T>,
    /// For each row i of frame b, of (β_i in m/s², E_i0, E_i1, E_i2).
    pub rows: [Matrix4<T>; 3],
    /// Mean sin² τ over the visits that know it; none if no visit does.
    pub tilt_squared: Option<T>,
}

/// A visit as an observation of the accelerometer.
pub struct FaceMean<T: Real> {
    /// g cos τ n, frame b, m/s².
    pub expected: Vector3<T>,
    /// Of each component of the mean about that, the face's own direction included.
    pub variance: Vector3<T>,
    /// sin² τ, if this visit tells.
    pub tilt_squared: Option<T>,
}

impl<T: Real> AccelMatrix<T> {
    /// Opposite faces' offsets and scales: near enough to be linear about.
    pub fn start(start: &Triad) -> Self {
        Self {
            bias: vector(&start.bias),
            correction: start.correction.map(real),
            rows: [Matrix4::zeros(); 3],
            tilt_squared: None,
        }
    }

    /// Calibrated specific force, frame b.
    pub fn force(&self, raw: &Vector3<T>) -> Vector3<T> {
        self.correction * (raw - self.bias)
    }

    /// One more round about this one; none if the arithmetic breaks down. `gyro` is the gyroscope's correction.
    pub fn improved<const R: usize, const S: usize>(
        &self,
        tape: &Tape<R, S>,
        setting: &Setting,
        rest: &RestRates<T>,
        gyro: &Matrix3<T>,
        tilt: Tilt,
    ) -> Option<Self> {
        let square = |sigma: f32| real::<T>(sigma * sigma);
        let prior = Vector4::from_fn(|i, _| square(if i == 0 { BIAS_SIGMA } else { CORRECTION_SIGMA })).map(T::recip);
        let mut information = [Matrix4::from_diagonal(&prior); 3];
        let mut sums = [Vector4::<T>::zeros(); 3];
        let (mut tilt_sum, mut tilt_count) = (T::zero(), T::zero());
        for visit in visits(tape) {
            let fit = visit.gravity(tape, setting, rest, gyro, self, tilt)?;
            let FaceMean { expected, variance, tilt_squared } = self.face_mean(setting, &visit, &fit);
            if let Some(squared) = tilt_squared {
                tilt_sum += squared;
                tilt_count += T::one();
            }
            let row = Vector4::new(T::one(), expected.x, expected.y, expected.z);
            for (axis, (information, sums)) in information.iter_mut().zip(&mut sums).enumerate() {
                *information += row * row.transpose() / variance[axis];
                *sums += row * ((fit.mean[axis] - expected[axis]) / variance[axis]);
            }
        }
        let tilt_squared = if tilt_count > T::zero() { Some(tilt_sum / tilt_count) } else { self.tilt_squared };
        self.moved(&information, &sums, tilt_squared)
    }

    /// What a visit's mean should be, and how well it should be that.
    pub fn face_mean(&self, setting: &Setting, visit: &Visit, fit: &VisitFit<T>) -> FaceMean<T> {
        let gravity: T = real(setting.gravity_mps2);
        let square = |sigma: f32| real::<T>(sigma * sigma);
        let known = fit.tilt_variance < square(TILT_KNOWN * setting.gravity_mps2);
        let own = known.then(|| fit.tilt.norm_squared() / (gravity * gravity));
        let tilt_squared = own.or(self.tilt_squared);
        let along = gravity * (T::one() - tilt_squared.unwrap_or(T::zero())).max(T::zero()).sqrt();
        let mut variance = fit.variance + Vector3::repeat(square(setting.facet_sigma_rad * setting.gravity_mps2));
        let normal = visit.face.axis();
        variance[normal] = fit.variance[normal];
        if tilt_squared.is_none() {
            variance[normal] += square(0.5 * TILT_SIGMA * TILT_SIGMA * setting.gravity_mps2);
        }
        FaceMean { expected: visit.up::<T>() * along, variance, tilt_squared: own }
    }

    fn moved(&self, information: &[Matrix4<T>; 3], sums: &[Vector4<T>; 3], tilt_squared: Option<T>) -> Option<Self> {
        let mut next = Self { tilt_squared, ..self.clone() };
        let mut offset = Vector3::zeros();
        let mut stretch = Matrix3::identity();
        for axis in 0..3 {
            next.rows[axis] = information[axis].cholesky()?.inverse();
            let found = next.rows[axis] * sums[axis];
            offset[axis] = found[0];
            for column in 0..3 {
                stretch[(axis, column)] += found[column + 1];
            }
        }
        next.bias += self.correction.lu().solve(&offset)?;
        next.correction = stretch.lu().solve(&self.correction)?;
        Some(next)
    }

    /// One σ² of [`Self::bias`]: correction ≈ 1 within 3 %.
    pub fn bias_variance(&self) -> Vector3<T> {
        Vector3::from_fn(|axis, _| self.rows[axis][(0, 0)])
    }

    /// Of each element of [`Self::correction`]: `δ correction = −E correction`.
    pub fn correction_variance(&self) -> Matrix3<T> {
        let errors = Matrix3::from_fn(|i, j| self.rows[i][(j + 1, j + 1)]);
        errors * self.correction.map(|c| c * c)
    }
}
