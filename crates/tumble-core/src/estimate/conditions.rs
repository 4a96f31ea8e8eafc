//! What is known of table and box before a session.

use crate::calibration::Frame;
use crate::setup::{BoxFaces, TurnStops};

/// What the session was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// How turns end.
    pub stops: TurnStops,
    /// Whether the box is square.
    pub faces: BoxFaces,
    /// Local gravity, m/s².
    pub gravity_mps2: f32,
}

impl Conditions {
    /// Nothing promised.
    pub const CAUTIOUS: Self =
        Self { stops: TurnStops::ByHand, faces: BoxFaces::Unknown, gravity_mps2: crate::STANDARD_GRAVITY_MPS2 };

    /// The axes that results are given in.
    pub fn frame(&self) -> Frame {
        if self.faces == BoxFaces::Square { Frame::Box } else { Frame::Accelerometer }
    }
}
