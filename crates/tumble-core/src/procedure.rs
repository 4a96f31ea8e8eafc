//! The guided session as a pure state machine: what happened goes in, what to say and do comes out.
//!
//! It is free of order: it asks for what is missing and takes whatever valid thing the person does instead. It owns the words
//! `calibrate`, `redo`, `finish`, `cancel` and `verify` ([`Procedure::owns`]); all others are the firmware's to answer. It keeps
//! no data: recording, estimating and storing are actions, so that the whole of it is tested without any.

mod act;
mod collect;
mod coverage;
#[cfg(test)]
mod tests;
mod track;
mod words;

use crate::calibration::Judgement;
use crate::command::Command;
use crate::face::Face;
use crate::led::Pattern;
use crate::message::{Message, Trouble};
use crate::motion::MotionEvent;
use crate::verify::{PoseCheck, Verification};

pub use crate::setup::{BoxFaces, Scheme, Setup, TurnStops};
pub use collect::{STILL_S, TURN_REST_S};
pub use coverage::{Coverage, Direction};

use collect::Collect;
use track::Track;

/// What happened.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "no heap to box a judgement into; on 32 bits it is not large")]
pub enum Input {
    /// The hands did something. All events are wanted, in a session or not.
    Motion(MotionEvent),
    /// A word was typed.
    Command(Command),
    /// A second has passed.
    Second,
    /// The estimate (or the writing) is so far, 0 to 100.
    Percent(u8),
    /// The estimate is there and judged.
    Estimated {
        /// What the judge says.
        judgement: Judgement,
        /// The face whose data fit worst, if the estimator knows; otherwise the reasons are asked.
        blame: Option<Face>,
    },
    /// The answer to [`Action::Store`].
    Stored(Result<Stored, Trouble>),
    /// Verify judged a pose.
    Pose(PoseCheck),
    /// Verify is through.
    Verified(Verification),
    /// A calibration is in force (read at start), or no more (erased).
    InForce(bool),
}

/// The record that was written and read back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Counts the calibrations stored on this board.
    pub generation: u32,
    /// Size of the record.
    pub bytes: u16,
}

/// What to do, in this order.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Say it, both ways.
    Say(Message),
    /// Repeat it, the machine's line only: the sentence comes every fifth second.
    Remind(Message),
    /// Show this from now on.
    Led(Pattern),
    /// Empty the memory and record from now on.
    Begin(Setup),
    /// Drop what was recorded on this face, the part of a rest on it in progress included; what follows is wanted.
    Forget(Face),
    /// Stop recording and drop everything.
    ForgetAll,
    /// Compute; answered by [`Input::Estimated`].
    Estimate,
    /// Give up computing; no answer is wanted any more.
    StopEstimate,
    /// Say every parameter of the calibration just estimated.
    SayParameters,
    /// Store the accepted calibration just estimated, and read it back; answered by [`Input::Stored`].
    Store,
    /// Check the calibration in force; answered by [`Input::Pose`] and [`Input::Verified`].
    StartVerify,
    /// Give up checking.
    StopVerify,
}

/// At most 13 come of one input: a verdict with eight reasons, parameters, store, a request, the LED.
pub type Actions = heapless::Vec<Action, 16>;

/// Where a session stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// No session.
    Idle,
    /// It asks for stills and turns.
    Collecting,
    /// The memory is full; it asks for a word.
    Full,
    /// It computes.
    Estimating,
    /// It writes.
    Storing,
    /// The result was rejected; it asks for a word. This face is probably to blame.
    Rejected(Option<Face>),
    /// The flash did not take the result; it asks for a word.
    NotStored,
    /// It checks the calibration in force.
    Verifying,
}

/// The sentence repeats with every so many seconds.
const SENTENCE_S: u32 = 5;
/// After so long without progress it says what it waits for and that nothing is lost, s.
const SILENCE_S: u32 = 300;
/// How many poses `verify` asks for.
const POSES: u8 = crate::verify::POSES;

/// The machine.
#[derive(Clone, Debug)]
pub struct Procedure {
    phase: Phase,
    track: Track,
    collect: Collect,
    in_force: bool,
    percent: u8,
    /// Poses done in `verify`, and whether the rest in progress was judged already.
    poses: u8,
    pose_judged: bool,
    /// What is shown, and counted blinks to be shown next.
    led: Pattern,
    led_is_flash: bool,
    flash: Option<Pattern>,
    /// What was asked last, and how often since.
    asked: Option<crate::message::Ask>,
    repeats: u32,
    /// Seconds since the last progress.
    silent_s: u32,
}

impl Procedure {
    /// No session. `in_force`: was a calibration found in flash?
    pub const fn new(in_force: bool) -> Self {
        Self {
            phase: Phase::Idle,
            track: Track::new(),
            collect: Collect::new(Setup::CAUTIOUS),
            in_force,
            percent: 0,
            poses: 0,
            pose_judged: false,
            led: Pattern::Off,
            led_is_flash: false,
            flash: None,
            asked: None,
            repeats: 0,
            silent_s: 0,
        }
    }

    /// Is this word answered here? [`Self::step`] does nothing with any other.
    pub fn owns(command: Command) -> bool {
        use Command::{Calibrate, Cancel, Finish, Redo, Verify};
        matches!(command, Calibrate(_) | Redo(_) | Finish | Cancel | Verify)
    }

    /// Where the session stands.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// What the session has.
    pub fn coverage(&self) -> &Coverage {
        &self.collect.coverage
    }

    /// What was stated when the session began.
    pub fn setup(&self) -> Setup {
        self.collect.setup
    }

    /// What to do about `input`, which happened at `t_us` (µs, any origin, never backwards).
    pub fn step(&mut self, t_us: u64, input: Input) -> Actions {
        let mut actions = Actions::new();
        let second = matches!(input, Input::Second);
        match input {
            Input::Motion(event) => self.motion(t_us, event, &mut actions),
            Input::Command(command) => self.command(command, &mut actions),
            Input::Second => self.second(&mut actions),
            Input::Percent(percent) => self.percent = percent.min(100),
            Input::Estimated { judgement, blame } => self.estimated(&judgement, blame, &mut actions),
            Input::Stored(result) => self.stored(result, &mut actions),
            Input::Pose(pose) => self.pose(pose, &mut actions),
            Input::Verified(verification) => self.verified(verification, &mut actions),
            Input::InForce(in_force) => self.in_force = in_force,
        }
        self.request(t_us, second, &mut actions);
        self.light(&mut actions);
        actions
    }
}

/// The capacity of [`Actions`] covers the longest answer, so that nothing is ever lost here (the fuzz test counts).
fn act(action: Action, actions: &mut Actions) {
    let _ = actions.push(action);
}

fn say(message: Message, actions: &mut Actions) {
    act(Action::Say(message), actions);
}
