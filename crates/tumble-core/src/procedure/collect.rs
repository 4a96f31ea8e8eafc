//! One session's bookkeeping: what counts, what does not, what to ask next.

use super::track::{Happening, Posture, Track};
use super::{Coverage, Direction, Setup};
use crate::face::Face;
use crate::message::{Accepted, Ask, Message, Note, Progress, Refused, RefusedTurn, Unrest};

/// A face's still, s. It must give gravity's direction: white noise of 300 µg/√Hz (sheet) averages over 2 s to
/// 300/√(2·2) = 150 µg, where the 1/f floor of some 100 µg makes a longer wait ever less worth. A face of a complete session
/// rests two or three times, so that six of them still carry the accelerometer's offset to 20 µg: against 3 s the bound
/// of a session with turns both ways grows from 18.5 to 19.6 µg, that of the gyroscope's non-orthogonality from 53 to
/// 55 µrad (`docs/method.md` §2). As the block at either edge counts as motion (up to 0.75 s together), this is what a rest of
/// 3 s by the clock surely holds.
pub const STILL_S: f32 = 2.0;

/// The rest behind a turn, s. What it must tell is the heading rate at rest (0.01 °/s/√Hz over 2 s: 5 mdps, 0.05° in a turn of
/// 10 s before the session's other rests improve on it tenfold) and the tilt (150 µg: 0.009°).
pub const TURN_REST_S: f32 = 2.0;

/// Motion that goes on for longer than this is no turn and no re-orientation any more, s.
const LONG_MOVE_S: f32 = 20.0;

/// A rest cut shorter than this is somebody letting go, not a spoilt hold, s.
const LETTING_GO_S: f32 = 0.5;

/// A turn whose rest is not yet long enough.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pending {
    face: Face,
    direction: Direction,
    angle_rad: f32,
}

/// What is said of a happening: at most a refusal or two, or two acceptances with progress.
pub(super) type Said = heapless::Vec<Message, 6>;

/// The session in progress.
#[derive(Clone, Debug)]
pub(super) struct Collect {
    pub(super) setup: Setup,
    pub(super) coverage: Coverage,
    pub(super) last_face: Option<Face>,
    pending: Option<Pending>,
    /// The hold that was cut short by the motion in progress.
    bumped: Option<Face>,
}

impl Collect {
    pub(super) const fn new(setup: Setup) -> Self {
        Self { setup, coverage: Coverage::EMPTY, last_face: None, pending: None, bumped: None }
    }

    /// Drops what was collected on a face.
    pub(super) fn forget(&mut self, face: Face) {
        self.coverage.forget(face);
        self.pending = self.pending.filter(|turn| turn.face != face);
        self.bumped = None;
        self.last_face = Some(face);
    }

    /// Books a happening and says so.
    pub(super) fn take(&mut self, happening: Happening) -> Said {
        let mut said = Said::new();
        match happening {
            Happening::Arrived { face, from } => self.arrived(face, from, &mut said),
            Happening::Turned { face, direction, angle_rad } => {
                self.drop_pending(&mut said);
                if self.coverage.has_turn(face, direction) {
                    refuse_turn(face, Some(angle_rad), RefusedTurn::Again, &mut said);
                } else {
                    self.pending = Some(Pending { face, direction, angle_rad });
                }
                self.last_face = Some(face);
            }
            Happening::Open { face, angle_rad } => {
                self.drop_pending(&mut said);
                refuse_turn(face, Some(angle_rad), RefusedTurn::Open, &mut said);
                self.last_face = Some(face);
            }
            Happening::NoNet { face } => {
                self.drop_pending(&mut said);
                refuse_turn(face, None, RefusedTurn::NoNet, &mut said);
            }
            Happening::Held { face: Some(face), held_s, put_back } => {
                if put_back {
                    self.put_back(face, &mut said);
                }
                self.held(face, held_s, &mut said);
            }
            Happening::Left { face: Some(face), held_s } => self.left(face, held_s, &mut said),
            Happening::Held { face: None, .. } | Happening::Left { face: None, .. } => {}
        }
        said
    }

    /// How long a rest on `face` has to be, s; 0 if nothing is missing there.
    fn hold_s(&self, face: Face) -> f32 {
        let still = if self.coverage.held().contains(face) { 0.0 } else { STILL_S };
        let turn = if self.pending.is_some_and(|turn| turn.face == face) { TURN_REST_S } else { 0.0 };
        f32::max(still, turn)
    }

    /// What to ask for.
    pub(super) fn ask(&self, t_us: u64, track: &Track) -> Ask {
        let place = Ask::Place { missing: self.coverage.incomplete(self.setup.scheme) };
        match track.posture() {
            Posture::Resting { face: None, .. } => Ask::Still { why: Unrest::Oblique },
            Posture::Resting { face: Some(face), held_s } => {
                let seconds = self.hold_s(face) - held_s;
                if seconds > 0.0 { Ask::Hold { face: Some(face), seconds } } else { self.turn(face).unwrap_or(place) }
            }
            Posture::Moving { since_us, excess, .. } if t_us.saturating_sub(since_us) as f32 > LONG_MOVE_S * 1e6 => {
                Ask::Still { why: Unrest::Moving { excess } }
            }
            Posture::Moving { from, .. } => match (self.bumped, from) {
                (Some(face), _) => Ask::Still { why: Unrest::Bumped { face } },
                (None, Some(face)) => self.turn(face).unwrap_or(place),
                (None, None) => place,
            },
        }
    }

    fn turn(&self, face: Face) -> Option<Ask> {
        let direction = self.coverage.wanted_turn(face, self.setup.scheme)?;
        let held = self.coverage.held().contains(face);
        held.then_some(Ask::Turn { face, direction: Some(direction), stops: self.setup.stops })
    }

    fn arrived(&mut self, face: Option<Face>, from: Option<Face>, said: &mut Said) {
        self.bumped = None;
        if face == from {
            return;
        }
        self.drop_pending(said);
        if let Some(face) = face.filter(|face| !self.coverage.incomplete(self.setup.scheme).contains(*face)) {
            say(Message::Refused(Refused::Face { face }), said);
        }
    }

    fn put_back(&mut self, face: Face, said: &mut Said) {
        if self.pending.is_some() {
            self.drop_pending(said);
        } else if self.turn(face).is_some() {
            refuse_turn(face, None, RefusedTurn::Lifted, said);
        }
    }

    fn held(&mut self, face: Face, held_s: f32, said: &mut Said) {
        let (before, was_minimum) = (self.coverage, self.coverage.is_minimum());
        if let Some(turn) = self.pending.take_if(|turn| turn.face == face && held_s >= TURN_REST_S) {
            let Pending { face, direction, angle_rad } = turn;
            self.coverage.add_turn(face, direction);
            say(Message::Accepted(Accepted::Turn { face, direction, angle_rad }), said);
        }
        if held_s >= STILL_S && !self.coverage.held().contains(face) {
            self.coverage.add_still(face);
            say(Message::Accepted(Accepted::Still { face, held_s }), said);
        }
        if self.coverage == before {
            return;
        }
        self.last_face = Some(face);
        let (coverage, scheme) = (self.coverage, self.setup.scheme);
        say(Message::Progress(Progress { coverage, scheme }), said);
        if coverage.is_minimum() && !was_minimum && !coverage.is_complete(scheme) {
            say(Message::Note(Note::MinimumReached), said);
        }
    }

    fn left(&mut self, face: Face, held_s: f32, said: &mut Said) {
        let needed_s = self.hold_s(face);
        if held_s >= needed_s {
            return;
        }
        self.bumped = Some(face);
        if held_s >= LETTING_GO_S {
            say(Message::Refused(Refused::Hold { face, held_s, needed_s }), said);
        }
    }

    fn drop_pending(&mut self, said: &mut Said) {
        if let Some(Pending { face, angle_rad, .. }) = self.pending.take() {
            refuse_turn(face, Some(angle_rad), RefusedTurn::NoRest, said);
        }
    }
}

fn refuse_turn(face: Face, angle_rad: Option<f32>, why: RefusedTurn, said: &mut Said) {
    say(Message::Refused(Refused::Turn { face, angle_rad, why }), said);
}

/// No happening says more than four things, so that nothing is ever lost here.
fn say(message: Message, said: &mut Said) {
    let _ = said.push(message);
}
