//! Rotations and positions with their derivatives.

use super::Jet;
use core::ops::AddAssign;
use nalgebra::{UnitQuaternion, Vector3};

/// A rotation `R_outer_from_inner` with the inner frame's angular rate and acceleration, both in the inner frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spin {
    /// `R_outer_from_inner`.
    pub rotation: UnitQuaternion<f64>,
    /// `ω` of inner relative to outer, in the inner frame, rad/s.
    pub rate: Vector3<f64>,
    /// `ω̇` in the inner frame, rad/s².
    pub accel: Vector3<f64>,
}

impl Spin {
    /// A rotation that stands still.
    pub fn fixed(rotation: UnitQuaternion<f64>) -> Self {
        Self { rotation, rate: Vector3::zeros(), accel: Vector3::zeros() }
    }

    /// A turn by `angle` (rad) about the fixed unit `axis`.
    pub fn about(axis: &Vector3<f64>, angle: Jet) -> Self {
        Self {
            rotation: UnitQuaternion::from_scaled_axis(axis * angle.value),
            rate: axis * angle.rate,
            accel: axis * angle.accel,
        }
    }

    /// Composition: `self` is `R_a_from_m`, `inner` is `R_m_from_b`, the result `R_a_from_b`.
    ///
    /// `ω = R_bᵀω_a + ω_b` and `ω̇ = R_bᵀω̇_a + (R_bᵀω_a) × ω_b + ω̇_b`, because `d/dt R_bᵀ = −[ω_b×] R_bᵀ`.
    #[must_use]
    pub fn then(self, inner: Self) -> Self {
        let carried = inner.rotation.inverse_transform_vector(&self.rate);
        Self {
            rotation: self.rotation * inner.rotation,
            rate: carried + inner.rate,
            accel: inner.rotation.inverse_transform_vector(&self.accel) + carried.cross(&inner.rate) + inner.accel,
        }
    }

    /// Three small turns about x, y and z in this order: how tremor enters.
    #[must_use]
    pub fn then_small(self, angles: [Jet; 3]) -> Self {
        let [x, y, z] = angles;
        self.then(Self::about(&Vector3::x(), x)).then(Self::about(&Vector3::y(), y)).then(Self::about(&Vector3::z(), z))
    }

    /// Acceleration (m/s², inner frame) of a point fixed in the inner frame at `lever` from the origin:
    /// `ω̇ × r + ω × (ω × r)`.
    pub fn lever_acceleration(&self, lever: &Vector3<f64>) -> Vector3<f64> {
        self.accel.cross(lever) + self.rate.cross(&self.rate.cross(lever))
    }

    /// Velocity (m/s, inner frame) of that point: `ω × r`.
    pub fn lever_velocity(&self, lever: &Vector3<f64>) -> Vector3<f64> {
        self.rate.cross(lever)
    }
}

/// A point's position, velocity and acceleration in `n`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Path {
    /// m.
    pub position: Vector3<f64>,
    /// m/s.
    pub velocity: Vector3<f64>,
    /// m/s².
    pub acceleration: Vector3<f64>,
}

impl Path {
    /// A point that stands still.
    pub fn fixed(position: Vector3<f64>) -> Self {
        Self { position, ..Self::default() }
    }

    /// A point that moves by `distance` (m) along `direction`.
    pub fn along(direction: &Vector3<f64>, distance: Jet) -> Self {
        Self {
            position: direction * distance.value,
            velocity: direction * distance.rate,
            acceleration: direction * distance.accel,
        }
    }
}

impl AddAssign for Path {
    fn add_assign(&mut self, o: Self) {
        self.position += o.position;
        self.velocity += o.velocity;
        self.acceleration += o.acceleration;
    }
}
