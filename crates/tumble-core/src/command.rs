//! The words a person (or a program) types, and what is said of a wrong one. `docs/protocol.md` lists them.

mod error;
mod line_editor;
#[cfg(test)]
mod tests;

use crate::face::Face;
use crate::setup::{BoxFaces, Scheme, Setup, TurnStops};

use error::{nearest, shorten};

pub use error::{CommandError, Typed};
pub use line_editor::LineEditor;

/// One understood line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// List the words.
    Help,
    /// Firmware, sensor, counters.
    Info,
    /// Start the guided session, or start it again.
    Calibrate(Setup),
    /// Forget a face (none: the last one worked on) and ask for it again.
    Redo(Option<Face>),
    /// Compute with what there is.
    Finish,
    /// Leave the session.
    Cancel,
    /// Check the calibration in force on fresh poses.
    Verify,
    /// The stored calibration.
    Cal(CalAction),
    /// Frames at the sample rate.
    Stream(StreamKind),
    /// Raw frames with a recording's metadata in front.
    Record,
    /// The sensor's built-in self-test.
    SelfTest,
}

/// What to do with the stored calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalAction {
    /// Show it to a person.
    Show,
    /// As `@param` lines.
    Export,
    /// Erase it.
    Reset,
}

/// What to stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StreamKind {
    /// Counts.
    Raw,
    /// Compensated.
    Cal,
    /// Nothing.
    Off,
}

/// One word of the language with its arguments and purpose, for `help` and for error messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word itself.
    pub name: &'static str,
    /// How its arguments are written, empty if it has none.
    pub usage: &'static str,
    /// What its arguments can be; empty if it has none.
    pub arguments: &'static [&'static str],
    /// What it does, in half a sentence.
    pub purpose: &'static str,
}

const FACES: &[&str] = &["+x", "-x", "+y", "-y", "+z", "-z"];

/// Every word, in the order in which `help` lists them.
#[rustfmt::skip]
pub const WORDS: [Word; 11] = [
    Word { name: "help", usage: "", arguments: &[], purpose: "list these words" },
    Word { name: "info", usage: "", arguments: &[], purpose: "tell about the firmware, the sensor and the counters" },
    Word { name: "calibrate", usage: "[fenced|by-hand] [square|unknown] [double|single]",
        arguments: &["fenced", "by-hand", "square", "unknown", "double", "single"],
        purpose: "start the guided session (as it stands: by-hand unknown double)" },
    Word { name: "redo", usage: "[FACE]", arguments: FACES, purpose: "forget one face, or the last one worked on, and do it again" },
    Word { name: "finish", usage: "", arguments: &[], purpose: "compute with what there is, if that is enough" },
    Word { name: "cancel", usage: "", arguments: &[], purpose: "leave the session; the stored calibration stays" },
    Word { name: "verify", usage: "", arguments: &[], purpose: "check the calibration on six fresh poses" },
    Word { name: "cal", usage: "show|export|reset", arguments: &["show", "export", "reset"], purpose: "show, export or erase the stored calibration" },
    Word { name: "stream", usage: "raw|cal|off", arguments: &["raw", "cal", "off"], purpose: "send a frame for every sample, or stop that" },
    Word { name: "record", usage: "", arguments: &[], purpose: "stream raw frames with what a recording needs in front" },
    Word { name: "selftest", usage: "", arguments: &[], purpose: "run the sensor's built-in self-test" },
];

impl Command {
    /// Reads one line without its end; case does not matter. An empty line is none.
    pub fn parse(line: &str) -> Option<Result<Self, CommandError>> {
        let mut typed = line.split_ascii_whitespace();
        let first = typed.next()?;
        Some(find(first).and_then(|word| Self::with_arguments(word, typed)))
    }

    /// The word, as in `@ok command=WORD`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Help => "help",
            Self::Info => "info",
            Self::Calibrate(_) => "calibrate",
            Self::Redo(_) => "redo",
            Self::Finish => "finish",
            Self::Cancel => "cancel",
            Self::Verify => "verify",
            Self::Cal(_) => "cal",
            Self::Stream(_) => "stream",
            Self::Record => "record",
            Self::SelfTest => "selftest",
        }
    }

    fn with_arguments<'a>(word: &'static Word, mut rest: impl Iterator<Item = &'a str>) -> Result<Self, CommandError> {
        if word.name == "calibrate" {
            return setup(word, rest).map(Self::Calibrate);
        }
        let argument = rest.next().map(|typed| choose(word, typed)).transpose()?;
        if let Some(typed) = rest.next() {
            return Err(CommandError::Surplus { word, typed: shorten(typed) });
        }
        Ok(match (word.name, argument) {
            ("help", _) => Self::Help,
            ("info", _) => Self::Info,
            ("redo", face) => Self::Redo(face.and_then(Face::from_name)),
            ("finish", _) => Self::Finish,
            ("cancel", _) => Self::Cancel,
            ("verify", _) => Self::Verify,
            ("record", _) => Self::Record,
            ("selftest", _) => Self::SelfTest,
            ("cal", Some("show")) => Self::Cal(CalAction::Show),
            ("cal", Some("export")) => Self::Cal(CalAction::Export),
            ("cal", Some("reset")) => Self::Cal(CalAction::Reset),
            ("stream", Some("raw")) => Self::Stream(StreamKind::Raw),
            ("stream", Some("cal")) => Self::Stream(StreamKind::Cal),
            ("stream", Some("off")) => Self::Stream(StreamKind::Off),
            _ => return Err(CommandError::MissingArgument { word }),
        })
    }
}

impl CalAction {
    /// As typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Show => "show",
            Self::Export => "export",
            Self::Reset => "reset",
        }
    }
}

impl StreamKind {
    /// As typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Raw => "raw",
            Self::Cal => "cal",
            Self::Off => "off",
        }
    }
}

fn setup<'a>(word: &'static Word, rest: impl Iterator<Item = &'a str>) -> Result<Setup, CommandError> {
    let (mut stops, mut box_faces, mut scheme) = (None, None, None);
    for typed in rest {
        let taken = match choose(word, typed)? {
            "fenced" => stops.replace(TurnStops::Fenced).is_some(),
            "by-hand" => stops.replace(TurnStops::ByHand).is_some(),
            "square" => box_faces.replace(BoxFaces::Square).is_some(),
            "unknown" => box_faces.replace(BoxFaces::Unknown).is_some(),
            "single" => scheme.replace(Scheme::Single).is_some(),
            _ => scheme.replace(Scheme::Double).is_some(),
        };
        if taken {
            return Err(CommandError::Surplus { word, typed: shorten(typed) });
        }
    }
    Ok(Setup {
        stops: stops.unwrap_or_default(),
        box_faces: box_faces.unwrap_or_default(),
        scheme: scheme.unwrap_or_default(),
    })
}

fn find(typed: &str) -> Result<&'static Word, CommandError> {
    const TABLE: &[Word] = &WORDS;
    TABLE.iter().find(|word| word.name.eq_ignore_ascii_case(typed)).ok_or_else(|| CommandError::UnknownWord {
        typed: shorten(typed),
        nearest: nearest(typed, TABLE.iter().map(|word| word.name)),
    })
}

fn choose(word: &'static Word, typed: &str) -> Result<&'static str, CommandError> {
    if word.arguments.is_empty() {
        return Err(CommandError::Surplus { word, typed: shorten(typed) });
    }
    // A face's plus sign may be left out, as `Face::from_name` has it.
    let is = |valid: &&&str| {
        valid.eq_ignore_ascii_case(typed) || valid.strip_prefix('+').is_some_and(|v| v.eq_ignore_ascii_case(typed))
    };
    word.arguments.iter().find(is).copied().ok_or_else(|| CommandError::UnknownArgument {
        word,
        typed: shorten(typed),
        nearest: nearest(typed, word.arguments.iter().copied()),
    })
}
