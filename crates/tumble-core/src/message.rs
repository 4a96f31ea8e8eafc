//! Everything the board says, each thing once: a line for a program and a sentence for the person from the same value.
//!
//! `docs/protocol.md` is the list. The machine line begins with `@`; the sentence names the thing, the place and the
//! remedy for a person with a box at a table. Both are plain ASCII, so that any terminal shows them.

mod ask;
mod board;
mod line;
mod note;
mod outcome;
mod reason;
mod result;
#[cfg(test)]
mod tests;
mod trouble;
mod words;

use core::fmt::{self, Write};

use crate::calibration::{Parameter, Reason, Verdict};
use crate::command::{Command, Word};
use crate::verify::{PoseCheck, Verification};

pub use ask::{Ask, Choice, Unrest};
pub use board::{CalibrationState, Hello, Info, Recording, Streaming};
pub use line::Line;
pub use note::{Note, Progress, Task};
pub use outcome::{Accepted, Refused, RefusedTurn};
pub use trouble::Trouble;

/// One thing the board says.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// After start.
    Hello(Hello),
    /// In answer to `info`.
    Info(Info),
    /// One further counter of `info`.
    Counter {
        /// Its key: no spaces.
        name: &'static str,
        /// Its value.
        value: u64,
    },
    /// One word of `help`.
    Help(&'static Word),
    /// A word was understood and carried out.
    Ok(Command),
    /// Something failed.
    Error(Trouble),
    /// What it waits for.
    Ask(Ask),
    /// What counted.
    Accepted(Accepted),
    /// What did not count.
    Refused(Refused),
    /// How far the session is.
    Progress(Progress),
    /// What else a person wants to know.
    Note(Note),
    /// It computes or writes.
    Busy {
        /// What.
        task: Task,
        /// How far, 0 to 100.
        percent: u8,
    },
    /// The judge's verdict; as many [`Self::Reason`]s follow.
    Result {
        /// In one word.
        verdict: Verdict,
        /// How many reasons follow.
        reasons: u8,
    },
    /// Why.
    Reason(Reason),
    /// One number of a calibration.
    Param(Parameter),
    /// It is in flash, and was read back.
    Stored {
        /// Counts the calibrations stored on this board.
        generation: u32,
        /// Size of the record.
        bytes: u16,
    },
    /// The stored calibration is erased, as was asked for.
    Erased,
    /// One pose of `verify`.
    Pose(PoseCheck),
    /// The verdict of `verify`.
    Verified(Verification),
    /// One axis of the sensor's self-test.
    SelfTest {
        /// `gyro_x` and so on.
        axis: &'static str,
        /// Response over factory trim, 1 when new.
        response: f32,
        /// Within the manufacturer's limits?
        ok: bool,
    },
    /// Frames follow, or no more.
    Stream(Streaming),
    /// What a recording needs in front.
    Recording(Recording),
}

impl Message {
    /// Writes the line for a program, from its `@`, without a line end.
    ///
    /// # Errors
    /// Those of `w`.
    pub fn machine(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Hello(hello) => hello.machine(w),
            Self::Info(info) => info.machine(w),
            Self::Counter { name, value } => write!(w, "@info {name}={value}"),
            Self::Help(word) => {
                write!(w, "@help word={} usage={}", word.name, words::Plain(word.usage))
            }
            Self::Ok(command) => write!(w, "@ok command={}", command.name()),
            Self::Error(trouble) => trouble.machine(w),
            Self::Ask(ask) => ask.machine(w),
            Self::Accepted(accepted) => accepted.machine(w),
            Self::Refused(refused) => refused.machine(w),
            Self::Progress(progress) => progress.machine(w),
            Self::Note(note) => note.machine(w),
            Self::Busy { task, percent } => write!(w, "@busy what={} percent={percent}", task.name()),
            Self::Result { verdict, reasons } => {
                write!(w, "@result verdict={} reasons={reasons}", words::verdict(*verdict))
            }
            Self::Reason(reason) => {
                write!(w, "@reason name={} text=", reason.name())?;
                write!(words::Underscored(w), "{reason}")
            }
            Self::Param(parameter) => result::parameter_machine(parameter, w),
            Self::Stored { generation, bytes } => write!(w, "@stored generation={generation} bytes={bytes}"),
            Self::Erased => w.write_str("@erased"),
            Self::Pose(pose) => result::pose_machine(pose, w),
            Self::Verified(verification) => result::verified_machine(verification, w),
            Self::SelfTest { axis, response, ok } => {
                write!(w, "@selftest axis={axis} response={response:.3} ok={}", words::yes(*ok))
            }
            Self::Stream(streaming) => streaming.machine(w),
            Self::Recording(recording) => recording.machine(w),
        }
    }

    /// Writes the sentence for the person, without a line end.
    ///
    /// # Errors
    /// Those of `w`.
    pub fn human(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Hello(hello) => hello.human(w),
            Self::Info(info) => info.human(w),
            Self::Counter { name, value } => write!(w, "  {name}: {value}"),
            Self::Help(word) => {
                let gap = if word.usage.is_empty() { "" } else { " " };
                write!(w, "  {}{gap}{}: {}.", word.name, word.usage, word.purpose)
            }
            Self::Ok(command) => write!(w, "Understood: {}.", command.name()),
            Self::Error(trouble) => trouble.human(w),
            Self::Ask(ask) => ask.human(w),
            Self::Accepted(accepted) => accepted.human(w),
            Self::Refused(refused) => refused.human(w),
            Self::Progress(progress) => progress.human(w),
            Self::Note(note) => note.human(w),
            Self::Busy { task, percent } => write!(w, "{} {percent} % done.", task.sentence()),
            Self::Result { verdict, reasons } => result::result_human(*verdict, *reasons, w),
            Self::Reason(reason) => write!(w, "{reason}"),
            Self::Param(parameter) => result::parameter_human(parameter, w),
            Self::Stored { generation, bytes } => write!(
                w,
                "Stored: calibration number {generation} of this board is in flash ({bytes} bytes, read back and equal) and in force."
            ),
            Self::Erased => w.write_str("The stored calibration is erased. Type \"calibrate\" to make a new one."),
            Self::Pose(pose) => result::pose_human(pose, w),
            Self::Verified(verification) => result::verified_human(verification, w),
            Self::SelfTest { axis, response, ok } => result::self_test_human(axis, *response, *ok, w),
            Self::Stream(streaming) => streaming.human(w),
            Self::Recording(recording) => recording.human(w),
        }
    }

    /// Writes both: the machine's line, then the person's, each with its `\r\n`.
    ///
    /// # Errors
    /// Those of `w`.
    pub fn write_to(&self, w: &mut impl Write) -> fmt::Result {
        self.write_machine_to(w)?;
        self.human(w)?;
        w.write_str("\r\n")
    }

    /// Writes the machine's line alone with its `\r\n`, for a request that repeats.
    ///
    /// # Errors
    /// Those of `w`.
    pub fn write_machine_to(&self, w: &mut impl Write) -> fmt::Result {
        self.machine(w)?;
        w.write_str("\r\n")
    }
}
