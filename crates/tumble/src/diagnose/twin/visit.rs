//! A stay on one face: which of its rests end whole turns, and from which the next turn counts.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};
use tumble_core::face::Face;
use tumble_core::motion::path::{NUDGE, WHOLE_TURN};

/// Since the first stop.
#[derive(Clone, Debug)]
pub struct Visit {
    /// The face it stands on.
    pub face: Face,
    /// Stretch of the last turn.
    pub last_turn: usize,
    first: Option<UnitQuaternion<f64>>,
    turned_rad: f64,
}

/// What a further rest on the face is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rested {
    /// The end of whole turns: what is left of them about the normal, rad, and their sign.
    Closed(f64, f64),
    /// One on the way.
    Between,
    /// From here on turns are counted: the first rest on the face, or the box was nudged and stands elsewhere.
    First,
}

impl Visit {
    /// The box comes to stand on a face.
    pub fn begin(face: Face) -> Self {
        Self { face, last_turn: 0, first: None, turned_rad: 0.0 }
    }

    /// It turns in `stretch`.
    pub fn turn(&mut self, stretch: usize, angle_rad: f64) {
        self.turned_rad += angle_rad;
        self.last_turn = stretch;
    }

    /// It rests at `attitude`, the face's normal being `normal_n` in frame n.
    pub fn rest(&mut self, attitude: &UnitQuaternion<f64>, normal_n: &Vector3<f64>) -> Rested {
        let turned = self.turned_rad.abs();
        let Some(first) = self.first.filter(|_| turned > f64::from(NUDGE)) else {
            (self.first, self.turned_rad) = (Some(*attitude), 0.0);
            return Rested::First;
        };
        let left = (attitude * first.inverse()).scaled_axis().dot(normal_n);
        if turned < PI || left.abs() > f64::from(WHOLE_TURN) {
            return Rested::Between;
        }
        Rested::Closed(left, std::mem::take(&mut self.turned_rad).signum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turned in two steps, nudged by 12°, turned back whole, and turned by half: what the nudge did is nobody's closure.
    #[test]
    fn turns_count_from_where_a_nudge_left_the_box() {
        let degree = PI / 180.0;
        let at = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle * degree);
        let (z, mut now) = (Vector3::z(), 0.0);
        let mut visit = Visit::begin(Face::PlusZ);
        assert_eq!(visit.rest(&at(now), &z), Rested::First);
        let mut by = |visit: &mut Visit, angle: f64| {
            now += angle;
            visit.turn(1, angle * degree);
            visit.rest(&at(now), &z)
        };
        assert_eq!(by(&mut visit, 200.0), Rested::Between);
        let Rested::Closed(left, sign) = by(&mut visit, 159.0) else { panic!("a whole turn") };
        assert!((left + degree).abs() < 1e-9 && sign == 1.0, "{left} {sign}");
        assert_eq!(by(&mut visit, 12.0), Rested::First);
        let Rested::Closed(left, sign) = by(&mut visit, -360.5) else { panic!("a whole turn") };
        assert!((left + 0.5 * degree).abs() < 1e-9 && sign == -1.0, "{left} {sign}");
        assert_eq!(by(&mut visit, 180.0), Rested::Between);
    }
}
