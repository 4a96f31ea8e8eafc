//! One move: from rest to rest, exact at every instant.

use super::shape::Shape;
use super::station::Station;
use crate::kinematics::{Path, Spin};

/// What kind of move a segment is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Nothing touches the box.
    Rest,
    /// A turn on the table.
    Turn,
    /// Lifted, turned over and put down.
    Carry,
    /// Tumbled in the hands.
    Tumble,
    /// Held in the hands, as still as they can.
    Hold,
}

/// One move with its times and its ends. It begins and ends at rest, so that any two follow each other smoothly.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// s.
    pub start_s: f64,
    /// s.
    pub duration_s: f64,
    /// Where it starts.
    pub from: Station,
    /// Where it ends.
    pub to: Station,
    pub(super) shape: Shape,
}

impl Segment {
    /// When it ends, s.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// What kind of move it is.
    pub fn kind(&self) -> Kind {
        match self.shape {
            Shape::Rest => Kind::Rest,
            Shape::Turn(_) => Kind::Turn,
            Shape::Carry(_) => Kind::Carry,
            Shape::Juggle(_) => Kind::Tumble,
            Shape::Hold(_) => Kind::Hold,
        }
    }

    /// The exact signed angle of a turn about the plate's normal, rad, counter-clockwise from above positive; 0 for
    /// other moves.
    pub fn turned_rad(&self) -> f64 {
        if let Shape::Turn(turn) = &self.shape { turn.angle_rad } else { 0.0 }
    }

    /// Attitude and centre at `t_s`; the ends outside the segment.
    pub(super) fn at(&self, t_s: f64) -> (Spin, Path) {
        let station = if t_s <= self.start_s {
            self.from
        } else if t_s >= self.end_s() {
            self.to
        } else {
            return self.shape.at(t_s - self.start_s, self.duration_s, &self.from);
        };
        (Spin::fixed(station.rotation_n_from_b), Path::fixed(station.position_n_m))
    }
}
