//! What studies read off a simulated truth.

use nalgebra::{Matrix3, Vector3};
use tumble_sim::Face;

/// A matrix of the truth's.
pub fn matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}

/// The face within 20° of an upward direction in the box: its index and its axis.
pub(super) fn up_face(up_b: &Vector3<f64>) -> Option<(usize, Vector3<f64>)> {
    let cone = f64::from(tumble_core::face::Face::CONE_COS);
    Face::ALL.into_iter().map(|face| (face.index(), face.up_b())).find(|(_, axis)| axis.dot(up_b) > cone)
}
