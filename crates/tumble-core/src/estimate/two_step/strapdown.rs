//! Inertial navigation over a turn, about which the filter is linear.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use super::filter::Motion;
use crate::estimate::six_face::{Real, real};

/// Which six numbers of the gyroscope the filter looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// The paper's equation (14): `K = [k12 k13 k21 k23 k31 k32]`, the off-diagonal elements of `A_s^b`, so that
    /// `ω_b = (1 + K̂) ω_s` and `δω_ib^b = ω_s − ω_b = −K̂ ω`.
    NonOrthogonality,
    /// The paper's comparison method: `[s1 s2 s3 a1 a2 a3]`, `ω_b = (1 + diag(s) + [a×]) ω_s`.
    ScaleAndSkew,
}

impl Pattern {
    /// The 3×6 matrix with `K̂ θ = matrix(θ) K`.
    pub fn matrix<T: Real>(self, angle: &Vector3<T>) -> SMatrix<T, 3, 6> {
        let (zero, [x, y, z]) = (T::zero(), [angle.x, angle.y, angle.z]);
        let rows = match self {
            Self::NonOrthogonality => {
                [[y, z, zero, zero, zero, zero], [zero, zero, x, z, zero, zero], [zero, zero, zero, zero, x, y]]
            }
            Self::ScaleAndSkew => {
                [[x, zero, zero, zero, z, -y], [zero, y, zero, -z, zero, x], [zero, zero, z, y, -x, zero]]
            }
        };
        SMatrix::from_fn(|i, j| rows[i][j])
    }

    /// K̂, 3×3.
    pub fn correction<T: Real>(self, k: &SMatrix<T, 6, 1>) -> Matrix3<T> {
        let column =
            |axis: usize| self.matrix(&Vector3::from_fn(|row, _| if row == axis { T::one() } else { T::zero() })) * k;
        Matrix3::from_columns(&[column(0), column(1), column(2)])
    }
}

/// Attitude, velocity and displacement from the turn's start, leap-frog as in [`super::filter`]; frame n level, ENU up to
/// its heading, which is zero at the start: gravity does not tell east from north, and nothing here asks.
///
/// Of equations (8)–(10) this leaves out what a turn of 10 s on a table cannot feel: `φ × ω_in` and `2 ω_ie × δv` (7e-5 rad/s:
/// 0.07 % of φ and δv over the turn), transport rates (1e-9 rad/s) and the curvature of latitude and longitude (δp is in
/// metres, east-north-up). `δω_ie` is noise ([`crate::estimate::six_face`] takes the vertical out of the rates).
#[derive(Clone, Copy, Debug)]
pub struct Strapdown<T: Real> {
    attitude: UnitQuaternion<T>,
    velocity_mps: Vector3<T>,
    displacement_m: Vector3<T>,
    last_dt_s: T,
    last_drive: SMatrix<T, 3, 6>,
    start: UnitQuaternion<T>,
}

/// One record's step.
pub struct Step<T: Real> {
    /// Of the filter, without its noise.
    pub motion: Motion<T>,
    /// `rotation_n_from_b` at the record's middle.
    pub middle: Matrix3<T>,
}

impl<T: Real> Strapdown<T> {
    /// At rest, level by its mean specific force (frame b). None if that vanishes.
    pub fn level(force: &Vector3<T>) -> Option<Self> {
        let attitude = UnitQuaternion::rotation_between(force, &Vector3::z())?;
        Some(Self {
            attitude,
            velocity_mps: Vector3::zeros(),
            displacement_m: Vector3::zeros(),
            last_dt_s: T::zero(),
            last_drive: SMatrix::zeros(),
            start: attitude,
        })
    }

    /// `rotation_n_from_b` at the start.
    pub fn start(&self) -> Matrix3<T> {
        self.start.to_rotation_matrix().into_inner()
    }

    /// Position error as observed, δp = p_INS − p_0: the INS's displacement less that of a sensor that sits at `lever`
    /// (frame b, m) from the axis, both at the last record's middle. The attitude's own error enters by lever · φ, 0.1 mm
    /// for 5 cm and 2 mrad.
    pub fn position_error(&self, middle: &Matrix3<T>, lever: &Vector3<T>) -> Vector3<T> {
        self.displacement_m - (middle * lever - self.start * lever)
    }

    /// One record: its calibrated rotation (rad) and mean specific force (m/s²), frame b.
    pub fn step(
        &mut self,
        rotation: &Vector3<T>,
        force: &Vector3<T>,
        dt_s: T,
        gravity: T,
        pattern: Pattern,
    ) -> Step<T> {
        let half: T = real(0.5);
        let middle = self.attitude * UnitQuaternion::from_scaled_axis(rotation * half);
        let middle = middle.to_rotation_matrix().into_inner();
        let force_n = middle * force;
        let drive = middle * pattern.matrix(rotation);
        let motion = Motion {
            tau_s: (self.last_dt_s + dt_s) * half,
            drive: (self.last_drive + drive) * half,
            impulse: force_n * dt_s,
            attitude_variance: T::zero(),
            velocity_variance: T::zero(),
        };
        self.displacement_m += self.velocity_mps * motion.tau_s;
        self.velocity_mps += (force_n - Vector3::z() * gravity) * dt_s;
        self.attitude =
            UnitQuaternion::new_normalize((self.attitude * UnitQuaternion::from_scaled_axis(*rotation)).into_inner());
        self.last_dt_s = dt_s;
        self.last_drive = drive;
        Step { motion, middle }
    }
}
