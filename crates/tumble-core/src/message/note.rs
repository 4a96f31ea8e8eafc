//! How far it is, what it does, and what else a person wants to know.

use core::fmt::{self, Write};

use super::words::{faces, ordered, yes};
use crate::face::Face;
use crate::procedure::{Coverage, Scheme, Setup, TurnStops};

/// How far the session is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is there.
    pub coverage: Coverage,
    /// What is recommended.
    pub scheme: Scheme,
}

/// What the board computes or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// The estimate.
    Estimate,
    /// The record.
    Store,
}

/// News that is neither request nor result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Note {
    /// A session begins.
    Started(Setup),
    /// A session begins anew; what was recorded is dropped.
    Restarted(Setup),
    /// A face was forgotten on request.
    Forgotten {
        /// Which.
        face: Face,
    },
    /// The session was left on request.
    Cancelled,
    /// The check was left on request.
    VerifyCancelled,
    /// `finish` may be typed from now on.
    MinimumReached,
    /// Nothing happened for long.
    Waiting {
        /// For how long.
        minutes: u32,
    },
    /// What to do after a calibration is stored.
    SuggestVerify,
    /// The check begins.
    VerifyStarted,
}

impl Progress {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        let coverage = &self.coverage;
        write!(w, "@progress faces={} turns=", faces(coverage.held()))?;
        let mut gap = "";
        for face in ordered(crate::face::FaceSet::FULL) {
            for direction in coverage.turns_on(face) {
                write!(w, "{gap}{}:{}", face.name(), direction.name())?;
                gap = ",";
            }
        }
        if gap.is_empty() {
            w.write_str("-")?;
        }
        write!(w, " missing={} minimum={}", coverage.missing(self.scheme), yes(coverage.is_minimum()))
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        let missing = self.coverage.missing(self.scheme);
        let all = Coverage::default().missing(self.scheme);
        write!(w, "{} of {all} steps done", all - missing)?;
        w.write_str(if missing == 0 { "; that is all." } else { "." })
    }
}

impl Task {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Estimate => "estimate",
            Self::Store => "store",
        }
    }

    pub(super) fn sentence(self) -> &'static str {
        match self {
            Self::Estimate => "Computing; the box may be moved.",
            Self::Store => "Writing to flash; please leave the power on.",
        }
    }
}

impl Note {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Started(setup) => setup_machine("started", setup, w),
            Self::Restarted(setup) => setup_machine("restarted", setup, w),
            Self::Forgotten { face } => write!(w, "@note about=forgotten face={}", face.name()),
            Self::Cancelled => w.write_str("@note about=cancelled"),
            Self::VerifyCancelled => w.write_str("@note about=verify_cancelled"),
            Self::MinimumReached => w.write_str("@note about=minimum"),
            Self::Waiting { minutes } => write!(w, "@note about=waiting minutes={minutes}"),
            Self::SuggestVerify => w.write_str("@note about=suggest_verify"),
            Self::VerifyStarted => w.write_str("@note about=verify_started"),
        }
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Started(setup) => started_human(setup, w),
            Self::Restarted(setup) => {
                w.write_str("Beginning again: what this session had recorded is dropped; what is in flash stays. ")?;
                started_human(setup, w)
            }
            Self::Forgotten { face } => write!(w, "Face {} is forgotten and will be asked for again; all others are kept.", face.name()),
            Self::Cancelled => w.write_str("The session is left. What was recorded is dropped; what is in flash stays in force."),
            Self::VerifyCancelled => w.write_str("The check is left. The calibration stays in force."),
            Self::MinimumReached => w.write_str(
                "The minimum is there: you may type \"finish\" now. Going on makes the result better and its errors smaller.",
            ),
            Self::Waiting { minutes } => write!(
                w,
                "Nothing new for {minutes} minutes. Nothing is lost: what was recorded is kept for as long as the power is on. \
                 Type \"cancel\" to leave. I still wait for this:"
            ),
            Self::SuggestVerify => w.write_str("To see for yourself that it is right, type \"verify\"."),
            Self::VerifyStarted => {
                w.write_str("Checking the calibration in force: six poses of your choice, two seconds each, moved by hand in between.")
            }
        }
    }
}

fn setup_machine(about: &str, setup: &Setup, w: &mut impl Write) -> fmt::Result {
    let (stops, box_faces, scheme) = (setup.stops.name(), setup.box_faces.name(), setup.scheme.name());
    write!(w, "@note about={about} turns={stops} box={box_faces} scheme={scheme}")
}

fn started_human(setup: &Setup, w: &mut impl Write) -> fmt::Result {
    w.write_str("Let us calibrate: on each of the six faces a rest, then ")?;
    w.write_str(match setup.scheme {
        Scheme::Double => "a full turn each way. About three minutes. ",
        Scheme::Single => "one full turn. About two minutes. ",
    })?;
    match setup.stops {
        TurnStops::Fenced => w.write_str("Turns end against a stop."),
        TurnStops::ByHand => w.write_str("Turns end by eye."),
    }
}
