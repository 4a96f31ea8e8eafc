//! Where the box rests.

use nalgebra::{UnitQuaternion, Vector3};

/// Where the box is while it rests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// `R_n_from_b`.
    pub rotation_n_from_b: UnitQuaternion<f64>,
    /// The box's centre in `n`, m.
    pub position_n_m: Vector3<f64>,
}
