//! What counted, and what did not.

use core::fmt::{self, Write};

use super::words::{self, Arrow, all_faces, degrees, faces};
use crate::face::{Face, FaceSet};
use crate::procedure::Direction;

/// What counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accepted {
    /// A face was held still for long enough.
    Still {
        /// Which axis is up.
        face: Face,
        /// How long, s.
        held_s: f32,
    },
    /// A full turn with its rest behind it.
    Turn {
        /// Which axis is up.
        face: Face,
        /// As seen from above.
        direction: Direction,
        /// By the gyroscope, not yet calibrated; counter-clockwise positive, rad.
        angle_rad: f32,
    },
}

/// What did not count, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// A turn.
    Turn {
        /// Which axis was up.
        face: Face,
        /// What was turned, counter-clockwise positive, rad; none if it left the table.
        angle_rad: Option<f32>,
        /// Why.
        why: RefusedTurn,
    },
    /// A hold that was cut short.
    Hold {
        /// Which axis was up.
        face: Face,
        /// How long it was, s.
        held_s: f32,
        /// How long it should be, s.
        needed_s: f32,
    },
    /// A face that has all it needs.
    Face {
        /// Which axis is up.
        face: Face,
    },
    /// `finish` before the minimum is there.
    Finish {
        /// Faces without a still.
        faces: FaceSet,
        /// Axes without a turn, bits 0 to 2.
        axes: u8,
    },
    /// A pose of `verify` that repeats an earlier one.
    Pose,
}

/// Why a turn does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefusedTurn {
    /// It is no whole number of turns.
    Open,
    /// It was turned back the way it went.
    NoNet,
    /// The box was lifted or tipped on the way.
    Lifted,
    /// The rest behind it was too short.
    NoRest,
    /// This direction is there already.
    Again,
}

impl Accepted {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Still { face, held_s } => {
                write!(w, "@accepted what=still face={} held_s={held_s:.1}", face.name())
            }
            Self::Turn { face, direction, angle_rad } => write!(
                w,
                "@accepted what=turn face={} direction={} angle_deg={:.2}",
                face.name(),
                direction.name(),
                degrees(angle_rad.abs())
            ),
        }
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Still { face, held_s } => {
                write!(w, "Good: face {} was still for {held_s:.1} seconds.", face.name())
            }
            Self::Turn { face, direction, angle_rad } => write!(
                w,
                "Good: face {} was turned {}, {:.1} degrees by the uncalibrated gyroscope.",
                face.name(),
                direction.word(),
                degrees(angle_rad.abs())
            ),
        }
    }
}

impl Refused {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Turn { face, angle_rad, why } => {
                write!(w, "@refused what=turn face={} angle_deg=", face.name())?;
                match angle_rad {
                    Some(angle) => write!(w, "{:.1} why={}", degrees(*angle), why.name()),
                    None => write!(w, "- why={}", why.name()),
                }
            }
            Self::Hold { face, held_s, .. } => {
                write!(w, "@refused what=hold face={} held_s={held_s:.1} why=bumped", face.name())
            }
            Self::Face { face } => write!(w, "@refused what=still face={} why=again", face.name()),
            Self::Finish { faces: missing, axes } => {
                write!(w, "@refused what=finish faces={} axes=", faces(*missing))?;
                write_axes(*axes, ",", w)?;
                w.write_str(" why=minimum")
            }
            Self::Pose => w.write_str("@refused what=pose why=again"),
        }
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Turn { face, angle_rad, why } => why.human(*face, degrees(angle_rad.unwrap_or(0.0)), w),
            Self::Hold { face, held_s, needed_s } => write!(
                w,
                "Face {} moved after {held_s:.1} of {needed_s:.0} seconds, so only that hold begins anew; nothing else is lost.",
                face.name()
            ),
            Self::Face { face } => write!(
                w,
                "Face {} has all it needs already. Nothing is lost, but it does not count twice.",
                face.name()
            ),
            Self::Finish { faces: missing, axes } => finish_human(*missing, *axes, w),
            Self::Pose => {
                w.write_str("That is how it lay before in this check, so it tells nothing new. Choose another pose.")
            }
        }
    }
}

fn finish_human(missing: FaceSet, axes: u8, w: &mut impl Write) -> fmt::Result {
    w.write_str("It is too early to finish: the minimum is six faces held still and one full turn about each axis. Still missing:")?;
    if !missing.is_empty() {
        write!(w, " the faces {}", all_faces(missing))?;
    }
    if axes != 0 {
        w.write_str(if missing.is_empty() { " a turn about " } else { "; a turn about " })?;
        write_axes(axes, " and ", w)?;
    }
    w.write_str(".")
}

fn write_axes(axes: u8, separator: &str, w: &mut impl Write) -> fmt::Result {
    let mut gap = "";
    for i in (0..3).filter(|i| axes >> i & 1 == 1) {
        write!(w, "{gap}{}", words::axis(i))?;
        gap = separator;
    }
    if gap.is_empty() { w.write_str("-") } else { Ok(()) }
}

impl RefusedTurn {
    fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::NoNet => "no_net",
            Self::Lifted => "lifted",
            Self::NoRest => "no_rest",
            Self::Again => "again",
        }
    }

    fn human(self, face: Face, angle_deg: f32, w: &mut impl Write) -> fmt::Result {
        let (name, arrow, turned) = (face.name(), Arrow(face), angle_deg.abs());
        let way = if angle_deg < 0.0 { "clockwise" } else { "counter-clockwise" };
        match self {
            Self::Open => write!(
                w,
                "Face {name}: that was {turned:.0} degrees {way}, not a full turn of 360, so it does not count. Turn it on \
                 to where it began; or lift it, lay it down again with {arrow}, and turn afresh."
            ),
            Self::NoNet => write!(
                w,
                "Face {name}: it was turned back the way it went, so it does not count. Turn it in one direction all the way round."
            ),
            Self::Lifted => write!(
                w,
                "Face {name}: the box was lifted or tipped on the way, so that turn does not count. Keep it flat on the table and \
                 slide it around."
            ),
            Self::NoRest => write!(
                w,
                "Face {name}: the rest after the turn of {turned:.0} degrees was too short to tell where it ended, so it does \
                 not count. After the next turn let go for two seconds."
            ),
            Self::Again => {
                write!(w, "Face {name}: a full turn {way} is there already. It does no harm, but does not count twice.")
            }
        }
    }
}
