//! The payload of format version 2: that of version 1, and behind it how the gyroscope follows the specific force. Written only
//! where there is such a thing, so that an older firmware reads all other records. Never edit it: a change is a new version.

use super::v1::{matrix, rows};
use crate::calibration::GSensitivity;

/// What stands behind version 1's payload: the matrix by rows, (rad/s)/(m/s²), and its sigma.
pub(super) type Felt = [[[f32; 3]; 3]; 2];

pub(super) fn pack(felt: &GSensitivity) -> Felt {
    [rows(&felt.matrix), rows(&felt.sigma)]
}

pub(super) fn unpack([felt, sigma]: &Felt) -> GSensitivity {
    GSensitivity { matrix: matrix(felt), sigma: matrix(sigma) }
}
