//! Step 1 in closed form: biases and full 3×3 matrices of both sensors from six faces and their turns.
//!
//! Everything is a linear least-squares problem of at most seven unknowns, so that it runs on the board in milliseconds and
//! every number has a sigma from the session's own noise. Frame `b` is the box: "the plate", its faces taken as square to
//! [`Noise::facet_sigma_rad`]. Models, raw in sensor axes, `ω` and `f` in frame b:
//!
//! ```text
//! raw_gyro  = S ω + b(t)        correction = S⁻¹          (turn.rs, rest.rs)
//! raw_accel = D f + a           correction = D⁻¹          (gravity.rs)
//! ```
//!
//! * **Gyroscope bias** ([`RestRates`]): rests, with the Earth's vertical rate and a linear drift told apart from it.
//! * **Gyroscope 3×3** ([`GyroMatrix`]): over k whole turns about the face normal n, fixed in the box,
//!   `∫ (raw − b) dt = S n · 2πk`, exactly, whatever the speed: column j of S comes from the turns about axis j, its off-
//!   diagonal elements included. What tilt and wobble do to it stands there.
//! * **Accelerometer 3×3** ([`AccelMatrix`]): `mean over a whole turn of raw = a ± g cos τ D e_j`: the tilt τ of the table
//!   turns with the box and leaves the mean. Where a face was not turned its tilt is solved for.
//!
//! **Why gravity alone cannot give nine.** Without the plate only `|D⁻¹(raw − a)| = g` is known. With D⁻¹ = (1 + E)D₀⁻¹ and f
//! = ±g e_j, `δ|f|² = 2 fᵀE f = 2 g² E_jj`: six exact faces see the three scales and (from the difference) the three biases
//! and nothing of the off-diagonal elements to first order. A table's tilt τ only multiplies them by sin τ. So where the box
//! is not known to be square the off-diagonal elements carry half a degree of sigma, which is "not observable".
//!
//! Source: the method follows equations (4)–(7) of the paper (`docs/method.md`), but for its division of the gyroscope's
//! turns by cos β, which is a slip: a box turned on a tilted table turns about its own normal.

use nalgebra::{Matrix3, RealField, Vector3};

use super::conditions::Conditions;
use super::device::Breakdown;
use super::noise::Noise;
use super::prior::CORRECTION_SIGMA;
use super::start;
use crate::DEGREE_RAD;
use crate::calibration::{Triad, TriadEstimate};
use crate::setup::TurnStops;
use crate::tape::Tape;

mod fit;
mod gravity;
mod rest;
#[cfg(test)]
mod tests;
mod turn;
mod visit;

pub use fit::VisitFit;
pub(crate) use fit::rows;
pub use gravity::{AccelMatrix, FaceMean};
pub use rest::RestRates;
pub use turn::{GyroMatrix, Turn, turns};
pub use visit::{Instant, Visit, visits};

/// The arithmetic: `f32` on the board, `f64` as its reference.
pub trait Real: RealField + Copy {}

impl<T: RealField + Copy> Real for T {}

/// A constant in the arithmetic.
pub(crate) fn real<T: Real>(value: f32) -> T {
    nalgebra::convert(f64::from(value))
}

/// Back to what calibrations are kept in.
pub(crate) fn single<T: Real>(value: T) -> f32 {
    nalgebra::try_convert::<T, f64>(value).map_or(f32::NAN, |value| value as f32)
}

/// A record's or estimate's vector in the arithmetic.
pub(crate) fn vector<T: Real>(value: &Vector3<f32>) -> Vector3<T> {
    value.map(real)
}

/// One component of the Earth's rate in any direction, 1σ, rad/s: 7.29e-5 rad/s over √3.
pub(crate) const EARTH_SIGMA: f32 = 4.2e-5;
/// One stop against a fence: uniform within ±0.1°, 1σ 0.058°.
const FENCED_STOP: f32 = 0.057_7 * DEGREE_RAD;
/// One stop by eye: a turn, which has two, closes to 2°, 1σ.
const HAND_STOP: f32 = 1.414 * DEGREE_RAD;
/// A face of a box of which nothing is known, rad.
const UNKNOWN_FACET: f32 = 0.5 * DEGREE_RAD;
/// "Not observable" beyond this sigma, as in [`super::device`].
const OBSERVABLE: f32 = 0.1 * CORRECTION_SIGMA;
/// Linearised rounds: cross-axis errors of 2 % square away twice.
const ROUNDS: usize = 4;

/// What accelerometer means are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tilt {
    /// Turns average it out, and where there was none it is solved for.
    Eliminated,
    /// The first rest on each face, as if the table's tilt lay along the face: the slip that explains the published
    /// non-orthogonality. It leaves a cross-axis error of the size of the tilt.
    Leaking,
}

/// What the session is taken to be, beside the tape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// From the rests' scatter.
    pub noise: Noise,
    /// One stop, 1σ, rad.
    pub stop_sigma_rad: f32,
    /// One face's direction, 1σ, rad.
    pub facet_sigma_rad: f32,
    /// m/s².
    pub gravity_mps2: f32,
}

impl Setting {
    /// From the rests' scatter and what the session was told.
    pub fn new<const R: usize, const S: usize>(tape: &Tape<R, S>, conditions: &Conditions) -> Self {
        let noise = Noise::from_rests(tape, conditions.stops, conditions.faces);
        Self {
            noise,
            stop_sigma_rad: if conditions.stops == TurnStops::Fenced { FENCED_STOP } else { HAND_STOP },
            facet_sigma_rad: noise.facet_sigma_rad.unwrap_or(UNKNOWN_FACET),
            gravity_mps2: conditions.gravity_mps2,
        }
    }
}

/// Step 1's result, frame b.
#[derive(Clone, Debug, PartialEq)]
pub struct SixFace<T: Real> {
    /// Gyroscope bias, drift, and the Earth's vertical rate.
    pub rest: RestRates<T>,
    /// Gyroscope 3×3.
    pub gyro: GyroMatrix<T>,
    /// Accelerometer bias and 3×3.
    pub accel: AccelMatrix<T>,
}

impl<T: Real> SixFace<T> {
    /// All closed forms in order.
    ///
    /// # Errors
    /// Names the place where the tape has nothing to solve from, or where the arithmetic broke down.
    pub fn solve<const R: usize, const S: usize>(
        tape: &Tape<R, S>,
        setting: &Setting,
        tilt: Tilt,
    ) -> Result<Self, Breakdown> {
        let rest = RestRates::solve(tape, setting).ok_or(Breakdown("resting rates"))?;
        let gyro = GyroMatrix::solve(tape, setting, &rest);
        let correction = gyro.matrix.try_inverse().ok_or(Breakdown("gyroscope matrix"))?;
        let start = start::nominal(tape, setting.gravity_mps2).accel;
        let mut accel = AccelMatrix::start(&start);
        let mut round = |tilt| {
            accel = accel.improved(tape, setting, &rest, &correction, tilt).ok_or(Breakdown("accelerometer matrix"))?;
            Ok(())
        };
        for _ in 0..ROUNDS {
            round(Tilt::Eliminated)?;
        }
        if tilt == Tilt::Leaking {
            (0..ROUNDS).try_for_each(|_| round(tilt))?;
        }
        Ok(Self { rest, gyro, accel })
    }

    /// The gyroscope's closed form as a calibration's half.
    pub fn gyroscope(&self) -> Option<TriadEstimate> {
        let correction = self.gyro.matrix.try_inverse()?;
        let squares = correction.map(|c| c * c);
        // δ(S⁻¹) = −S⁻¹ δS S⁻¹, element by element independent.
        let variance = squares * self.gyro.variance * squares;
        Some(triad_estimate(&self.rest.bias(), &self.rest.bias_variance(), &correction, &variance))
    }

    /// The accelerometer's closed form as a calibration's half.
    pub fn accelerometer(&self) -> TriadEstimate {
        let accel = &self.accel;
        triad_estimate(&accel.bias, &accel.bias_variance(), &accel.correction, &accel.correction_variance())
    }
}

fn triad_estimate<T: Real>(
    bias: &Vector3<T>,
    bias_variance: &Vector3<T>,
    correction: &Matrix3<T>,
    variance: &Matrix3<T>,
) -> TriadEstimate {
    let root = |variance: T| libm::sqrtf(single(variance));
    let correction_sigma = variance.map(root);
    TriadEstimate {
        triad: Triad { bias: bias.map(single), correction: correction.map(single) },
        bias_sigma: bias_variance.map(root),
        correction_sigma,
        observable: core::array::from_fn(|i| core::array::from_fn(|j| correction_sigma[(i, j)] < OBSERVABLE)),
    }
}
