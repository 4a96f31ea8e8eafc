//! What the person's hands did, out of the motion events alone; whether it is wanted is for others to say.

use core::f32::consts::TAU;

use super::Direction;
use crate::DEGREE_RAD;
use crate::face::Face;
use crate::motion::MotionEvent;

/// The least that the uncalibrated gyroscope says of a full turn: 324°. Its scale is good to 3 % (11°, sheet), and a resting
/// rate left over by 0.5 °/s adds 5° in 10 s; the segmenter has judged closure already, this only tells one turn from none.
const FULL_TURN_RAD: f32 = 0.9 * TAU;

/// Less than this since the last closure is a turn undone and not one begun: 34°, twice what the segmenter calls whole.
const UNDONE_RAD: f32 = 34.0 * DEGREE_RAD;

/// A full turn by hand takes longer than this, µs; what is shorter and ends on the same face is a bump.
const BUMP_US: u64 = 2_000_000;

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Happening {
    /// It came to rest.
    Arrived { face: Option<Face>, from: Option<Face> },
    /// One or more full turns on the face that it rests on.
    Turned { face: Face, direction: Direction, angle_rad: f32 },
    /// Turned, but not all the way; the angle since the last closure on this visit of the face.
    Open { face: Face, angle_rad: f32 },
    /// Went and came back.
    NoNet { face: Face },
    /// Still at rest, for `held_s` since it arrived or was last forgotten. `put_back`: before that it was moved for longer than a
    /// bump takes and came back to the same face without having turned on it.
    Held { face: Option<Face>, held_s: f32, put_back: bool },
    /// It moves again.
    Left { face: Option<Face>, held_s: f32 },
}

/// At rest or moving.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Posture {
    Resting { face: Option<Face>, held_s: f32 },
    Moving { from: Option<Face>, since_us: u64, excess: f32 },
}

/// Follows the events.
#[derive(Clone, Debug)]
pub(super) struct Track {
    posture: Posture,
    /// The part of the rest in progress that was forgotten, s.
    forgotten_s: f32,
    /// The face that it left and came back to in more than [`BUMP_US`], until a turn event or the first held event tells
    /// whether it turned there.
    unsettled_from: Option<Face>,
    /// The rest that a turn began from was forgotten.
    origin_lost: bool,
}

impl Track {
    pub(super) const fn new() -> Self {
        Self {
            posture: Posture::Moving { from: None, since_us: 0, excess: 0.0 },
            forgotten_s: 0.0,
            unsettled_from: None,
            origin_lost: false,
        }
    }

    /// At rest or moving; a rest's length counts from when it was last forgotten.
    pub(super) fn posture(&self) -> Posture {
        match self.posture {
            Posture::Resting { face, held_s } => Posture::Resting { face, held_s: self.since_forgotten(held_s) },
            moving @ Posture::Moving { .. } => moving,
        }
    }

    /// What was recorded on `face` (none: on any) is dropped: a rest on it counts from now on, a turn under way does not count.
    pub(super) fn forget(&mut self, face: Option<Face>) {
        let concerns = |on: Option<Face>| face.is_none() || face == on;
        match self.posture {
            Posture::Resting { face: on, held_s } if concerns(on) => self.forgotten_s = held_s,
            Posture::Moving { from, .. } if concerns(from) => self.origin_lost = true,
            _ => {}
        }
    }

    pub(super) fn follow(&mut self, t_us: u64, event: MotionEvent) -> Option<Happening> {
        match event {
            MotionEvent::StillBegan { face } => Some(self.arrive(t_us, face)),
            MotionEvent::TurnClosed { face, angle_rad } => self.closed(face, angle_rad),
            MotionEvent::TurnOpen { face, angle_rad } => self.open(face, angle_rad),
            MotionEvent::StillHeld { face, held_s } => Some(self.hold(face, held_s)),
            MotionEvent::StillEnded { face, held_s } => {
                let held_s = self.since_forgotten(held_s);
                self.forgotten_s = 0.0;
                self.posture = Posture::Moving { from: face, since_us: t_us, excess: 1.0 };
                Some(Happening::Left { face, held_s })
            }
            MotionEvent::Moving { excess: now } => {
                if let Posture::Moving { excess, .. } = &mut self.posture {
                    *excess = now;
                }
                None
            }
            MotionEvent::TapeFull => None,
        }
    }

    fn since_forgotten(&self, held_s: f32) -> f32 {
        (held_s - self.forgotten_s).max(0.0)
    }

    fn arrive(&mut self, t_us: u64, face: Option<Face>) -> Happening {
        let (from, moved_us) = match self.posture {
            Posture::Resting { face, .. } => (face, 0),
            Posture::Moving { from, since_us, .. } => (from, t_us.saturating_sub(since_us)),
        };
        self.unsettled_from = from.filter(|_| moved_us > BUMP_US);
        self.forgotten_s = 0.0;
        self.posture = Posture::Resting { face, held_s: 0.0 };
        Happening::Arrived { face, from }
    }

    /// A turn event belongs to the rest that has just begun; one that does not, or whose beginning was forgotten, is nothing.
    fn belongs(&mut self, face: Face) -> bool {
        self.unsettled_from = None;
        let here = matches!(self.posture, Posture::Resting { face: Some(on), .. } if on == face);
        here && !self.origin_lost
    }

    fn closed(&mut self, face: Face, angle_rad: f32) -> Option<Happening> {
        if !self.belongs(face) {
            return None;
        }
        let turned = angle_rad.abs() >= FULL_TURN_RAD;
        let direction = Direction::of(angle_rad);
        Some(if turned { Happening::Turned { face, direction, angle_rad } } else { Happening::NoNet { face } })
    }

    fn open(&mut self, face: Face, angle_rad: f32) -> Option<Happening> {
        if !self.belongs(face) {
            return None;
        }
        let begun = angle_rad.abs() >= UNDONE_RAD;
        Some(if begun { Happening::Open { face, angle_rad } } else { Happening::NoNet { face } })
    }

    fn hold(&mut self, face: Option<Face>, held_s: f32) -> Happening {
        let put_back = self.unsettled_from.take().is_some_and(|from| Some(from) == face) && !self.origin_lost;
        self.origin_lost = false;
        self.posture = Posture::Resting { face, held_s };
        Happening::Held { face, held_s: self.since_forgotten(held_s), put_back }
    }
}
