//! What a move between two rests was: a turn on the table, or by hand.

use core::f32::consts::PI;
use core::ops::Range;

use nalgebra::{Rotation3, Vector3};

use super::MotionEvent;
use crate::DEGREE_RAD;
use crate::face::Face;
use crate::tape::{Kind, Tape};

/// A box that turns on a table keeps the same axis up within this, rad: twice a 3° table, 1° of wobble, and what a
/// gyroscope 5 % out of true (sheet: 3 % scale, 2 % cross-axis) adds over half a turn, 5 % of 180° = 9°.
pub(super) const ON_TABLE: f32 = 16.0 * DEGREE_RAD;
/// A whole turn within this, rad: 3 % of scale (sheet) is 10.8°, and a hand stops to ±2°, three sigma 6°.
pub const WHOLE_TURN: f32 = 17.0 * DEGREE_RAD;
/// A turn by less, rad, is no step of a whole one: the box was nudged, or settled, and may have left the fence. Both ends
/// of a step are uncertain by [`WHOLE_TURN`].
pub const NUDGE: f32 = 2.0 * WHOLE_TURN;

/// A move as the uncalibrated gyroscope saw it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// The same axis stayed up all the way.
    pub on_table: bool,
    /// Rotation about that axis, rad, counter-clockwise from above positive.
    pub angle_rad: f32,
}

/// Follows the upward direction through the records. `from` and `to` are specific forces at rest before and after.
pub fn trace<const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    records: Range<usize>,
    resting_rate: &Vector3<f32>,
    from: &Vector3<f32>,
    to: &Vector3<f32>,
) -> Path {
    let up = from.normalize();
    let mut now = up;
    let mut angle_rad = 0.0;
    let mut largest = up.angle(&to.normalize());
    for record in records.filter_map(|index| tape.record(index)) {
        let rotation = record.rotation_rad - resting_rate * record.dt_s;
        angle_rad += rotation.dot(&up);
        // A fixed direction seen from a body that rotates by θ rotates by −θ.
        now = Rotation3::new(-rotation) * now;
        largest = largest.max(up.angle(&now));
    }
    Path { on_table: largest < ON_TABLE, angle_rad }
}

/// The nearest whole number of turns to an angle, if it is near enough.
pub fn whole_turns(angle_rad: f32) -> Option<i32> {
    let turns = libm::roundf(angle_rad / (2.0 * PI));
    let tolerance = WHOLE_TURN * libm::fabsf(turns).max(1.0);
    (libm::fabsf(angle_rad - turns * 2.0 * PI) < tolerance).then_some(turns as i32)
}

/// Sums a visit's rotation on one face, so that a turn in steps, with rests between, is a turn.
#[derive(Clone, Copy, Debug, Default)]
pub struct RevolutionCheck {
    face: Option<Face>,
    since_closed_rad: f32,
}

impl RevolutionCheck {
    /// No visit yet.
    pub const fn new() -> Self {
        Self { face: None, since_closed_rad: 0.0 }
    }

    /// Takes the move that ended in a rest on `face`; says whether it completed a turn.
    pub fn arrive(&mut self, kind: &Kind, face: Option<Face>) -> Option<MotionEvent> {
        let Kind::OnTable { face: on, angle_rad } = *kind else {
            *self = Self { face, since_closed_rad: 0.0 };
            return None;
        };
        if self.face != Some(on) {
            *self = Self { face, since_closed_rad: 0.0 };
        }
        self.since_closed_rad += angle_rad;
        if libm::fabsf(angle_rad) < NUDGE {
            return None;
        }
        // A whole turn counts whatever was left open before it.
        let whole = |angle: f32| whole_turns(angle).is_some_and(|turns| turns != 0);
        let total = if whole(angle_rad) { angle_rad } else { self.since_closed_rad };
        match whole_turns(total) {
            Some(turns) if turns != 0 => {
                self.since_closed_rad = 0.0;
                Some(MotionEvent::TurnClosed { face: on, angle_rad: total })
            }
            _ => Some(MotionEvent::TurnOpen { face: on, angle_rad: total }),
        }
    }
}
