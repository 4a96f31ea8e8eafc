//! What the board asks for.

use core::fmt::{self, Write};

use super::words::{self, Arrow, Maybe, any_face, faces};
use crate::face::{Face, FaceSet};
use crate::procedure::Direction;
use crate::setup::TurnStops;

/// A request, which repeats while it waits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ask {
    /// Put one of these faces up.
    Place {
        /// What still lacks something; the first in [`crate::face::ASKING_ORDER`] is what the sentence proposes.
        missing: FaceSet,
    },
    /// Do not touch.
    Hold {
        /// Which axis is up; none for an oblique pose of `verify`.
        face: Option<Face>,
        /// Time still missing, s.
        seconds: f32,
    },
    /// One full turn on the table.
    Turn {
        /// Which axis is up.
        face: Face,
        /// As seen from above; none if it does not matter.
        direction: Option<Direction>,
        /// What a turn ends at.
        stops: TurnStops,
    },
    /// Lay it down and let go.
    Still {
        /// Why.
        why: Unrest,
    },
    /// During `verify`: a fresh pose, any.
    Pose {
        /// Poses so far.
        done: u8,
        /// Poses needed.
        of: u8,
    },
    /// A word is needed; nothing else helps.
    Word {
        /// Which words, and about what.
        choice: Choice,
    },
}

/// Why it is no rest on a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unrest {
    /// A hold was cut short.
    Bumped {
        /// The face that was up.
        face: Face,
    },
    /// It has moved for long.
    Moving {
        /// Test statistic over its threshold, 1 at the threshold.
        excess: f32,
    },
    /// It lies on an edge or leans.
    Oblique,
}

/// What a person has to decide by a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The memory is full and the minimum is there.
    FullEnough,
    /// The memory is full and the minimum is not there.
    FullShort,
    /// The result was rejected; this face is probably to blame.
    Rejected(Option<Face>),
    /// The result is good, but the flash did not take it.
    NotStored,
}

impl Ask {
    /// The same request, whatever its numbers?
    pub fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Hold { face, .. }, Self::Hold { face: of, .. }) => face == of,
            (Self::Still { why: Unrest::Moving { .. } }, Self::Still { why: Unrest::Moving { .. } }) => true,
            _ => self == other,
        }
    }

    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Place { missing } => write!(w, "@ask want=place faces={}", faces(*missing)),
            Self::Hold { face, seconds } => {
                write!(w, "@ask want=hold face={} seconds={seconds:.1}", Maybe(face.map(Face::name)))
            }
            Self::Turn { face, direction, .. } => {
                let direction = direction.map_or("either", Direction::name);
                write!(w, "@ask want=turn face={} direction={direction}", face.name())
            }
            Self::Still { why } => write!(w, "@ask want=still why={}", why.name()),
            Self::Pose { done, of } => write!(w, "@ask want=pose done={done} of={of}"),
            Self::Word { choice } => {
                write!(w, "@ask want=word words={} face={}", choice.words(), Maybe(choice.face().map(Face::name)))
            }
        }
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Place { missing } => place(*missing, w),
            Self::Hold { face: Some(face), seconds } => {
                write!(w, "Face {}: hands off, please. It measures for {seconds:.1} more seconds.", face.name())
            }
            Self::Hold { face: None, seconds } => {
                write!(w, "Hands off, please. It measures for {seconds:.1} more seconds.")
            }
            Self::Turn { face, direction, stops } => turn(*face, *direction, *stops, w),
            Self::Still { why } => why.human(w),
            Self::Pose { done, of } => write!(
                w,
                "Pose {} of {of}: put the box down in a way it has not lain yet in this check - a new face, or leaning \
                 on a book - and let go.",
                done + 1
            ),
            Self::Word { choice } => choice.human(w),
        }
    }
}

fn place(missing: FaceSet, w: &mut impl Write) -> fmt::Result {
    let Some(first) = words::ordered(missing).next() else {
        return w.write_str("Put the box on any face and let go.");
    };
    write!(w, "Put the box on the table with {} (face {}) and let go.", Arrow(first), first.name())?;
    if missing.len() > 1 { write!(w, " Still to do, in any order you like: {}.", any_face(missing)) } else { Ok(()) }
}

fn turn(face: Face, direction: Option<Direction>, stops: TurnStops, w: &mut impl Write) -> fmt::Result {
    let which = match direction {
        Some(Direction::Ccw) => "counter-clockwise",
        Some(Direction::Cw) => "clockwise",
        None => "either way",
    };
    let end = match stops {
        TurnStops::Fenced => "until it rests against its stop again",
        TurnStops::ByHand => "back to where it began, as well as your eye can tell",
    };
    write!(
        w,
        "Face {} ({}): leave it flat on the table and turn it once around, {which} as seen from above, {end}. Then let go.",
        face.name(),
        Arrow(face)
    )
}

impl Unrest {
    fn name(self) -> &'static str {
        match self {
            Self::Bumped { .. } => "bumped",
            Self::Moving { .. } => "moving",
            Self::Oblique => "oblique",
        }
    }

    fn human(self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Bumped { face } => {
                write!(w, "It moved. Leave it on face {} ({}) or lay it down again, and let go.", face.name(), Arrow(face))
            }
            Self::Moving { excess } => write!(
                w,
                "It still moves ({excess:.1} times what counts as rest). Lay it on a face and let go; if it lies there \
                 already, something shakes the table: a fan, a motor, an elbow."
            ),
            Self::Oblique => w.write_str(
                "It rests, but leans or stands on an edge: no arrow points straight up or down. Lay it flat on one of its \
                 six faces and let go.",
            ),
        }
    }
}

impl Choice {
    fn words(self) -> &'static str {
        match self {
            Self::FullEnough => "finish,redo,cancel",
            Self::FullShort | Self::Rejected(_) => "redo,calibrate,cancel",
            Self::NotStored => "finish,cancel",
        }
    }

    fn face(self) -> Option<Face> {
        match self {
            Self::Rejected(face) => face,
            _ => None,
        }
    }

    fn human(self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::FullEnough => w.write_str(
                "The session's memory is full, but enough is there: type \"finish\" to compute with it, or \"redo\" and a \
                 face to make room.",
            ),
            Self::FullShort => w.write_str(
                "The session's memory is full before the minimum was there: type \"redo\" and a face to make room, or \
                 \"calibrate\" to begin again and rest less long between steps.",
            ),
            Self::Rejected(Some(face)) => write!(
                w,
                "Type \"redo {}\" to do that face again (all others are kept), \"calibrate\" to begin afresh or \
                 \"cancel\" to leave. What is in flash is untouched.",
                face.name()
            ),
            Self::Rejected(None) => w.write_str(
                "Type \"redo\" and a face to do it again (all others are kept), \"calibrate\" to begin afresh or \
                 \"cancel\" to leave. What is in flash is untouched.",
            ),
            Self::NotStored => w.write_str(
                "The result is good but not in flash. Type \"finish\" to try to store it once more, or \"cancel\" to drop it.",
            ),
        }
    }
}
