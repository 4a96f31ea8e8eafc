//! A stay on one face: which of its rests end whole turns, and from which the next turn counts.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};
use tumble_core::face::Face;
use tumble_core::motion::path::WHOLE_TURN;

/// Less than this between two rests, rad, is no step of a turn: the box was nudged, and stands elsewhere.
const NUDGE: f64 = 2.0 * WHOLE_TURN as f64;

/// Since the first stop.
#[derive(Clone, Debug)]
pub struct Visit {
    /// The face it stands on.
    pub face: Face,
    /// Stretch of the last turn.
    pub last_turn: usize,
    first: UnitQuaternion<f64>,
    turned_rad: f64,
}

/// What a further rest on the face is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rested {
    /// The end of whole turns: what is left of them about the normal, rad, and their sign.
    Closed(f64, f64),
    /// One on the way.
    Between,
    /// A first stop anew.
    Nudged,
}

impl Visit {
    /// The box comes to stand on a face, or anew, in `stretch`.
    pub fn begin(face: Face, first: UnitQuaternion<f64>, stretch: usize) -> Self {
        Self { face, last_turn: stretch, first, turned_rad: 0.0 }
    }

    /// It turns in `stretch`.
    pub fn turn(&mut self, stretch: usize, angle_rad: f64) {
        self.turned_rad += angle_rad;
        self.last_turn = stretch;
    }

    /// It rests at `attitude`, the face's normal being `normal_n` in frame n.
    pub fn rest(&mut self, attitude: &UnitQuaternion<f64>, normal_n: &Vector3<f64>) -> Rested {
        let left = (attitude * self.first.inverse()).scaled_axis().dot(normal_n);
        let turned = self.turned_rad.abs();
        if turned > PI && left.abs() < f64::from(WHOLE_TURN) {
            return Rested::Closed(left, std::mem::take(&mut self.turned_rad).signum());
        }
        if turned > NUDGE { Rested::Between } else { Rested::Nudged }
    }
}
