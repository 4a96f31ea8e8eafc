//! How step 1's errors leak into step 2's K.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::filter::{ATTITUDE, GYRO, Innovation, Motion, POSITION, STATES, VELOCITY};
use crate::estimate::six_face::{AccelMatrix, FaceMean, Instant, Real, Setting, SixFace, Visit, VisitFit, rows};

/// Step 1's errors: rows (β_i, E_i0, E_i1, E_i2) of the accelerometer, then the gyroscope's bias.
pub const ERRORS: usize = 15;

/// The derivative of the filter's error (estimate minus truth) by errors c that stay in its corrected data, 15×15:
/// `f = (1 + E) f_true + β`, `ω = ω_true + δb`, frame b. It goes through the filter's own transitions and gains:
///
/// ```text
/// D ← F D − B,   D ← D − gain · D[index],   B = ∂(INS error)/∂c over the record
/// ```
///
/// An accelerometer cross-axis error turns with the box as one of the gyroscope does, and goes into K one to one
/// (`∂k_ij/∂E_ij` = 1.00; `design.md` §1 has 0.8 to 0.95, for K's opposite sign); a transverse gyroscope bias looks like
/// one of K times the rate (1.6 s for turns of 10 s that go the same way about a sensor axis, 0 if they go both ways).
///
/// The accelerometer's noise in a turn enters twice: through the filter, and before that through step 1, with opposite
/// signs. So the filter's error is correlated with c, `X = E[e cᵀ]`, which goes the same way with the input of
/// [`Response`], and Schmidt's consider covariance is
///
/// ```text
/// cov K = P_KK + D cov(c) Dᵀ + X Dᵀ + D Xᵀ     (rows of K)
/// ```
///
/// Without X, sigma comes out 1.4 to 1.9 times too large (sim). What is left out is the lever arm's error, which cancels part
/// of c's in a turn: sigma is still 1.2 to 1.4 times too large (24 seeds each of the paper's, single and double turns).
/// Costs 1500 multiply–adds a step, outside of
/// [`super::filter::STEP_MULTIPLY_ADDS`]: whoever does without a true sigma can leave it out.
#[derive(Clone, Debug, PartialEq)]
pub struct Leak<T: Real> {
    derivative: SMatrix<T, STATES, ERRORS>,
    correlation: SMatrix<T, STATES, ACCEL_ERRORS>,
}

/// The accelerometer's share of [`ERRORS`].
const ACCEL_ERRORS: usize = 12;

/// `E[n cᵀ]`, 3×12, of a record's mean force noise n (frame b): step 1 is linear in the records, with weights of `dt` over
/// density, against n's variance of density over `dt`: neither remains.
pub type Response<T> = SMatrix<T, 3, ACCEL_ERRORS>;

/// What makes responses out of a visit's records.
pub struct Source<'a, T: Real> {
    visit: &'a Visit,
    fit: &'a VisitFit<T>,
    /// Per frame-b row: `P_i h / variance_i`.
    rows: [nalgebra::Vector4<T>; 3],
}

impl<'a, T: Real> Source<'a, T> {
    /// Of a visit.
    pub fn new(setting: &Setting, accel: &AccelMatrix<T>, visit: &'a Visit, fit: &'a VisitFit<T>) -> Self {
        let FaceMean { expected, variance, .. } = accel.face_mean(setting, visit, fit);
        let h = nalgebra::Vector4::new(T::one(), expected.x, expected.y, expected.z);
        Self { visit, fit, rows: core::array::from_fn(|axis| accel.rows[axis] * h / variance[axis]) }
    }

    /// A record's response; what step 1 took for an error of the sensor is missing from the corrected data: the minus.
    pub fn response(&self, instant: &Instant<T>) -> Response<T> {
        let [u, v] = self.visit.plane::<T>();
        let up = self.visit.up::<T>();
        let [row_u, row_v] = rows(instant);
        let (from_u, from_v) = (self.fit.gain * row_u, self.fit.gain * row_v);
        let vertical = up.dot(&self.fit.variance.component_mul(&up));
        // How the visit's mean moves with noise along u, v and up: 3×3, frame b.
        let mean = (u * from_u.x + v * from_u.y) * u.transpose()
            + (u * from_v.x + v * from_v.y) * v.transpose()
            + up * up.transpose() * vertical;
        Response::from_fn(|noise, error| -mean[(error / 4, noise)] * self.rows[error / 4][error % 4])
    }
}

impl<T: Real> Leak<T> {
    /// K's prior knows nothing of these errors.
    pub fn new() -> Self {
        Self { derivative: SMatrix::zeros(), correlation: SMatrix::zeros() }
    }

    /// ∂K/∂c, 6×15.
    pub fn of_gyro(&self) -> SMatrix<T, 6, ERRORS> {
        self.derivative.fixed_view::<6, ERRORS>(GYRO, 0).into_owned()
    }

    /// A turn begins, level by a rest's mean `force` (frame b): `ẑ × φ = −(C δf)ₓᵧ/g`.
    pub fn restart(&mut self, to_n: &Matrix3<T>, force: &Vector3<T>, response: &Response<T>, gravity: T) {
        self.derivative.fixed_rows_mut::<9>(0).fill(T::zero());
        self.correlation.fixed_rows_mut::<9>(0).fill(T::zero());
        for (column, error) in force_errors(to_n, force).into_iter().enumerate() {
            self.derivative[(ATTITUDE, column)] = error.y / gravity;
            self.derivative[(ATTITUDE + 1, column)] = -error.x / gravity;
        }
        let noise = to_n * response;
        for column in 0..ACCEL_ERRORS {
            self.correlation[(ATTITUDE, column)] = noise[(1, column)] / gravity;
            self.correlation[(ATTITUDE + 1, column)] = -noise[(0, column)] / gravity;
        }
    }

    /// One record; `force`: mean specific force, frame b.
    pub fn predict(
        &mut self,
        motion: &Motion<T>,
        middle: &Matrix3<T>,
        force: &Vector3<T>,
        response: &Response<T>,
        dt_s: T,
    ) {
        carry(&mut self.derivative, motion);
        carry(&mut self.correlation, motion);
        let w = motion.impulse.cross_matrix();
        let bias = middle * dt_s;
        let mut attitude = self.derivative.fixed_view_mut::<3, 3>(ATTITUDE, ACCEL_ERRORS);
        attitude += bias;
        let mut velocity = self.derivative.fixed_view_mut::<3, 3>(VELOCITY, ACCEL_ERRORS);
        velocity += w * bias;
        for (column, error) in force_errors(middle, force).into_iter().enumerate() {
            let mut velocity = self.derivative.fixed_view_mut::<3, 1>(VELOCITY, column);
            velocity -= error * dt_s;
        }
        let mut velocity = self.correlation.fixed_rows_mut::<3>(VELOCITY);
        velocity -= middle * response * dt_s;
    }

    /// The filter has observed one component of position.
    pub fn observe(&mut self, index: usize, innovation: &Innovation<T>) {
        let row = self.derivative.row(index).into_owned();
        self.derivative -= innovation.gain * row;
        let row = self.correlation.row(index).into_owned();
        self.correlation -= innovation.gain * row;
    }

    /// What step 1 adds to the filter's covariance of K, 6×6.
    pub fn covariance(&self, first: &SixFace<T>) -> SMatrix<T, 6, 6> {
        let mut errors = SMatrix::<T, ERRORS, ERRORS>::zeros();
        for (axis, row) in first.accel.rows.iter().enumerate() {
            errors.fixed_view_mut::<4, 4>(4 * axis, 4 * axis).copy_from(row);
        }
        let bias = first.rest.covariance.fixed_view::<3, 3>(0, 0);
        errors.fixed_view_mut::<3, 3>(12, 12).copy_from(&bias);
        let k = self.of_gyro();
        let correlation = self.correlation.fixed_rows::<6>(GYRO) * k.fixed_columns::<ACCEL_ERRORS>(0).transpose();
        k * errors * k.transpose() + correlation + correlation.transpose()
    }
}

/// `D ← F D`.
fn carry<T: Real, const N: usize>(d: &mut SMatrix<T, STATES, N>, motion: &Motion<T>) {
    let position = d.fixed_rows::<3>(VELOCITY) * motion.tau_s;
    let mut rows = d.fixed_rows_mut::<3>(POSITION);
    rows += position;
    let attitude = motion.drive * d.fixed_rows::<6>(GYRO);
    let mut rows = d.fixed_rows_mut::<3>(ATTITUDE);
    rows += attitude;
    let velocity = motion.impulse.cross_matrix() * d.fixed_rows::<3>(ATTITUDE);
    let mut rows = d.fixed_rows_mut::<3>(VELOCITY);
    rows += velocity;
}

impl<T: Real> Default for Leak<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// `C δf` for each of the accelerometer's twelve errors of size 1.
fn force_errors<T: Real>(to_n: &Matrix3<T>, force: &Vector3<T>) -> [Vector3<T>; 12] {
    core::array::from_fn(|column| {
        let (row, element) = (column / 4, column % 4);
        let size = if element == 0 { T::one() } else { force[element - 1] };
        to_n.column(row) * size
    })
}
