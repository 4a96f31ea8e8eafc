//! What a session has and what it lacks.

use super::Scheme;
use crate::face::{Face, FaceSet};

/// Which way a turn goes, as seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Counter-clockwise, positive.
    Ccw,
    /// Clockwise, negative.
    Cw,
}

impl Direction {
    /// Of an angle that is positive counter-clockwise.
    pub fn of(angle_rad: f32) -> Self {
        if angle_rad < 0.0 { Self::Cw } else { Self::Ccw }
    }

    /// `ccw` or `cw`, as on machine lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ccw => "ccw",
            Self::Cw => "cw",
        }
    }

    /// For a person.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ccw => "counter-clockwise",
            Self::Cw => "clockwise",
        }
    }
}

/// Faces held still and turns done. A face or turn done twice counts once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    held: FaceSet,
    ccw: FaceSet,
    cw: FaceSet,
}

impl Coverage {
    /// Nothing done.
    pub const EMPTY: Self = Self { held: FaceSet::EMPTY, ccw: FaceSet::EMPTY, cw: FaceSet::EMPTY };

    /// Faces with a still that is long enough.
    pub fn held(&self) -> FaceSet {
        self.held
    }

    /// The directions that a face was turned in.
    pub fn turns_on(&self, face: Face) -> impl Iterator<Item = Direction> + use<> {
        let has = [(self.ccw.contains(face), Direction::Ccw), (self.cw.contains(face), Direction::Cw)];
        has.into_iter().filter(|(there, _)| *there).map(|(_, direction)| direction)
    }

    /// Is this turn there?
    pub fn has_turn(&self, face: Face, direction: Direction) -> bool {
        self.turns_on(face).any(|there| there == direction)
    }

    /// The turn to ask for on a face: counter-clockwise first, so that the cable is unwound by the second.
    pub fn wanted_turn(&self, face: Face, scheme: Scheme) -> Option<Direction> {
        match (self.ccw.contains(face), self.cw.contains(face), scheme) {
            (false, false, _) | (false, true, Scheme::Double) => Some(Direction::Ccw),
            (true, false, Scheme::Double) => Some(Direction::Cw),
            _ => None,
        }
    }

    /// Faces that lack a still or a turn.
    pub fn incomplete(&self, scheme: Scheme) -> FaceSet {
        let lacks = |face: &Face| !self.held.contains(*face) || self.wanted_turn(*face, scheme).is_some();
        Face::ALL.into_iter().filter(lacks).fold(FaceSet::EMPTY, FaceSet::with)
    }

    /// How many stills and turns are missing: 18 at first (12 in the single scheme).
    pub fn missing(&self, scheme: Scheme) -> usize {
        let turns = |face: Face| match scheme {
            Scheme::Double => 2 - self.turns_on(face).count(),
            Scheme::Single => 1 - self.turns_on(face).count().min(1),
        };
        6 - self.held.len() + Face::ALL.into_iter().map(turns).sum::<usize>()
    }

    /// Axes without any turn: bits 0 to 2 for x, y, z.
    pub fn axes_without_turn(&self) -> u8 {
        let turned = Face::ALL.into_iter().filter(|face| self.turns_on(*face).next().is_some());
        turned.fold(0b111, |axes, face| axes & !(1 << face.axis()))
    }

    /// Six faces and a turn about each axis: what an estimate needs at least.
    pub fn is_minimum(&self) -> bool {
        self.held == FaceSet::FULL && self.axes_without_turn() == 0
    }

    /// Everything that is recommended?
    pub fn is_complete(&self, scheme: Scheme) -> bool {
        self.missing(scheme) == 0
    }

    pub(super) fn add_still(&mut self, face: Face) {
        self.held = self.held.with(face);
    }

    pub(super) fn add_turn(&mut self, face: Face, direction: Direction) {
        match direction {
            Direction::Ccw => self.ccw = self.ccw.with(face),
            Direction::Cw => self.cw = self.cw.with(face),
        }
    }

    pub(super) fn forget(&mut self, face: Face) {
        *self = Self { held: self.held.without(face), ccw: self.ccw.without(face), cw: self.cw.without(face) };
    }
}
