//! The paper's two-step method: closed forms first, then its 15-state filter for the gyroscope's non-orthogonality.
//!
//! Step 1 ([`super::six_face`]) corrects the data; step 2 navigates by them through every turn, from the level attitude of
//! the rest before it with v = p = 0, and observes at each record that the position has not changed (equations (8)–(16)):
//!
//! ```text
//! φ̇ = φ × ω_in + δω_ie + δω_en − C δω_ib      δv̇ = fⁿ × φ      δṗ = δv      K̇ = 0
//! −C δω_ib = M_k K,  M_k = C [ω_y ω_z 0 0 0 0; 0 0 ω_x ω_z 0 0; 0 0 0 0 ω_x ω_y]
//! Z = p_INS − p_0 = H x + noise,  H = [0₃ₓ₆ I₃ 0₃ₓ₆]
//! ```
//!
//! φ turns the true level frame into the computed one: `C̃ = (1 − φ×) C`. The sign of (14) against (8) says what K is: the off-
//! diagonal elements of `A_s^b` (`δω_ib = −K̂ ω`), so `correction = (1 − K̂)⁻¹ diag(1/s)`, s the diagonal of S; to first order
//! `(1 + K̂) diag(1/s)`, `k_ij = −S_ij/s_i`. With the paper's angles k12 = −θxz, k13 = θxy, k21 = θyz, k23 = −θyx, k31 = −θzy,
//! k32 = θzx.
//!
//! Here the filter is linear about step 1's own K, so that one pass is enough and nothing is fed back.
//!
//! **What the position costs.** A sensor off the axis does move, on a circle: its displacement `C l − C₀ l` is predicted with
//! the visit's lever arm, whose error (some mm, from step 1) is added to the position noise of 0.5 mm. With p known to
//! nothing the filter would see the specific force itself; 3 mm at 12 Hz is as noisy as this accelerometer at 1.5 rad/s,
//! three times faster than the attitude wanders: 0.2 mm instead of 1 mm lowers the sigma of K by 1 % (sim). But a constant lever error is no white noise: its centripetal
//! acceleration turns with the box as a cross-axis error does, and leaks into K likewise. A box that slides on the table by
//! centimetres shows in `nis_per_dof`, which then widens every sigma of K.
//!
//! **What it cannot bear**: a spin axis that wobbles (1° puts 5 mrad into K, by way of step 1's accelerometer and unknown to
//! the sigma), a box that is not square though said to be. The estimator of [`super::device`] follows both.

use nalgebra::SMatrix;

use super::conditions::Conditions;
use super::device::Breakdown;
use super::six_face::{Real, Setting, SixFace, Tilt, visits};
use crate::tape::Tape;

pub mod dense;
pub mod filter;
mod leak;
mod nominal;
mod outcome;
mod pass;
mod strapdown;
#[cfg(test)]
mod tests;

use filter::{GYRO, STATES};
pub use leak::{ERRORS, Leak, Response};
use nominal::Nominal;
pub use outcome::Outcome;
use pass::Pass;
pub use strapdown::{Pattern, Step, Strapdown};

/// Which method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// As its equations say, correctly coded.
    Corrected,
    /// As its published results look: the table's tilt left in the accelerometer by step 1, the gyroscope's turns divided
    /// by cos β, the sensor on the axis, linear about K = 0.
    Literal,
    /// The paper's comparison: scale and an antisymmetric non-orthogonality together in the filter, from an identity.
    Traditional,
}

impl Variant {
    fn tilt(self) -> Tilt {
        if self == Self::Literal { Tilt::Leaking } else { Tilt::Eliminated }
    }

    fn pattern(self) -> Pattern {
        if self == Self::Traditional { Pattern::ScaleAndSkew } else { Pattern::NonOrthogonality }
    }

    fn passes(self) -> usize {
        if self == Self::Traditional { 3 } else { 1 }
    }
}

/// Column of the k-th of `[k12 k13 k21 k23 k31 k32]`, its row being k/2.
pub(crate) fn other(k: usize) -> usize {
    [1, 2, 0, 2, 0, 1][k % 6]
}

/// Both steps over a tape.
///
/// # Errors
/// Names the place where there is nothing to solve from, or where the arithmetic broke down.
pub fn estimate<T: Real, const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    conditions: &Conditions,
    variant: Variant,
) -> Result<Outcome<T>, Breakdown> {
    let setting = Setting::new(tape, conditions);
    let first: SixFace<T> = SixFace::solve(tape, &setting, variant.tilt())?;
    let mut nominal = Nominal::new(variant, &first).ok_or(Breakdown("gyroscope matrix"))?;
    let mut pass = Pass::new(&first, &setting, variant, &nominal);
    for number in 0..variant.passes() {
        if number > 0 {
            pass = Pass::new(&first, &setting, variant, &nominal);
        }
        for visit in visits(tape) {
            pass.visit(tape, &visit).ok_or(Breakdown("turn"))?;
        }
        let found = pass.filter.state().fixed_rows::<6>(GYRO).into_owned();
        nominal = nominal.moved(variant.pattern(), &found).ok_or(Breakdown("gyroscope matrix"))?;
    }
    if !nominal.correction.iter().all(|value| value.is_finite()) {
        return Err(Breakdown("gyroscope matrix"));
    }
    let (filter, leak) = (pass.filter, pass.leak);
    let nis_per_dof = pass.nis / pass.observations.max(T::one());
    Outcome::new(tape, &setting, variant, nominal.correction, nominal.gyro, first, &filter, &leak, nis_per_dof)
}

/// Six of the state's covariance.
pub(crate) fn gyro_covariance<T: Real>(covariance: &SMatrix<T, STATES, STATES>) -> SMatrix<T, 6, 6> {
    covariance.fixed_view::<6, 6>(GYRO, GYRO).into_owned()
}
