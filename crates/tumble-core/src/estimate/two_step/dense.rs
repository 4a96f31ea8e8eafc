//! The same step as textbooks write it, with dense 15×15 products: the reference for tests and benchmarks, not for use.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::filter::{ATTITUDE, Covariance, Filter, GYRO, Motion, POSITION, STATES, State, VELOCITY};
use crate::estimate::six_face::Real;

/// F of [`Motion`], 15×15.
pub fn transition<T: Real>(motion: &Motion<T>) -> Covariance<T> {
    let mut position = Covariance::identity();
    position.fixed_view_mut::<3, 3>(POSITION, VELOCITY).copy_from(&Matrix3::from_diagonal_element(motion.tau_s));
    let mut attitude = Covariance::identity();
    attitude.fixed_view_mut::<3, 6>(ATTITUDE, GYRO).copy_from(&motion.drive);
    let mut velocity = Covariance::identity();
    velocity.fixed_view_mut::<3, 3>(VELOCITY, ATTITUDE).copy_from(&motion.impulse.cross_matrix());
    velocity * attitude * position
}

/// `P ← F P Fᵀ + Q`, then `K = P Hᵀ (H P Hᵀ + R)⁻¹`, `P ← (1 − K H) P` with `H = [0₃ₓ₆ I₃ 0₃ₓ₆]` and all three components of
/// position at once. None if the innovation's covariance is singular.
#[inline(never)]
pub fn step<T: Real>(
    state: &State<T>,
    covariance: &Covariance<T>,
    transition: &Covariance<T>,
    process: &Covariance<T>,
    position: &Vector3<T>,
    variance: T,
) -> Option<(State<T>, Covariance<T>)> {
    let predicted = transition * state;
    let p = transition * covariance * transition.transpose() + process;
    let mut h = SMatrix::<T, 3, STATES>::zeros();
    h.fixed_view_mut::<3, 3>(0, POSITION).fill_with_identity();
    let innovation = h * p * h.transpose() + Matrix3::from_diagonal_element(variance);
    let gain = p * h.transpose() * innovation.try_inverse()?;
    let updated = predicted + gain * (position - h * predicted);
    Some((updated, (Covariance::identity() - gain * h) * p))
}

/// Q of [`Motion`], 15×15.
pub fn process<T: Real>(motion: &Motion<T>) -> Covariance<T> {
    let mut q = Covariance::zeros();
    for axis in 0..3 {
        q[(ATTITUDE + axis, ATTITUDE + axis)] = motion.attitude_variance;
        q[(VELOCITY + axis, VELOCITY + axis)] = motion.velocity_variance;
    }
    q
}

/// One sparse step, the work of [`step`] as the estimator does it.
#[inline(never)]
pub fn sparse_step<T: Real>(filter: &mut Filter<T>, motion: &Motion<T>, position: &Vector3<T>, variance: T) {
    filter.predict(motion);
    for axis in 0..3 {
        filter.observe(POSITION + axis, position[axis], variance);
    }
}
