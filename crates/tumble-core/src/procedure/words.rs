//! The five words of a session, in every phase.

use super::{Action, Actions, Collect, Phase, Procedure, act, say};
use crate::command::Command;
use crate::face::Face;
use crate::message::{Message, Note, Refused, Trouble};
use crate::setup::Setup;

const NO_SESSION: &str = "No session is running. Type \"calibrate\" to start one.";
const NOTHING_TO_LEAVE: &str = "Nothing is running, so there is nothing to leave.";
const WRITING: &str = "It is writing to flash and will be through in a moment; try again then.";
const IN_SESSION: &str = "A session is running: type \"finish\" to complete it or \"cancel\" to leave it first.";
const CHECKING: &str = "A check is running: type \"cancel\" to leave it first.";
const COMPUTING: &str = "It is computing already; type \"cancel\" to leave.";
const NOTHING_WORKED_ON: &str = "No face was worked on yet. Name one, as in \"redo +x\".";

impl Procedure {
    pub(super) fn command(&mut self, command: Command, actions: &mut Actions) {
        self.silent_s = 0;
        let done = match command {
            Command::Calibrate(setup) => self.calibrate(setup, actions),
            Command::Redo(face) => self.redo(face, actions),
            Command::Finish => self.finish(actions),
            Command::Cancel => self.cancel(actions),
            Command::Verify => self.verify(actions),
            _ => return,
        };
        match done {
            // What comes of it was pushed already; the confirmation stands in front.
            Ok(()) => confirm(command, actions),
            Err(why) => {
                if let Some(trouble) = why.trouble(command) {
                    say(Message::Error(trouble), actions);
                }
            }
        }
        // A word deserves an answer that ends with what is wanted now.
        self.asked = None;
    }

    fn calibrate(&mut self, setup: Setup, actions: &mut Actions) -> Result<(), Not> {
        match self.phase {
            Phase::Storing => return Err(Not::Now(WRITING)),
            Phase::Estimating => act(Action::StopEstimate, actions),
            Phase::Verifying => act(Action::StopVerify, actions),
            _ => {}
        }
        let anew = !matches!(self.phase, Phase::Idle | Phase::Verifying);
        act(Action::Begin(setup), actions);
        say(Message::Note(if anew { Note::Restarted(setup) } else { Note::Started(setup) }), actions);
        self.collect = Collect::new(setup);
        self.track.forget(None);
        self.phase = Phase::Collecting;
        Ok(())
    }

    fn redo(&mut self, face: Option<Face>, actions: &mut Actions) -> Result<(), Not> {
        let blamed = match self.phase {
            Phase::Idle => return Err(Not::Now(NO_SESSION)),
            Phase::Storing => return Err(Not::Now(WRITING)),
            Phase::Verifying => return Err(Not::Now(CHECKING)),
            Phase::Rejected(blame) => blame,
            _ => None,
        };
        let face = face.or(blamed).or(self.collect.last_face).ok_or(Not::Now(NOTHING_WORKED_ON))?;
        if self.phase == Phase::Estimating {
            act(Action::StopEstimate, actions);
        }
        act(Action::Forget(face), actions);
        say(Message::Note(Note::Forgotten { face }), actions);
        self.collect.forget(face);
        self.track.forget(Some(face));
        self.phase = Phase::Collecting;
        Ok(())
    }

    fn finish(&mut self, actions: &mut Actions) -> Result<(), Not> {
        match self.phase {
            Phase::Idle => return Err(Not::Now(NO_SESSION)),
            Phase::Estimating => return Err(Not::Now(COMPUTING)),
            Phase::Storing => return Err(Not::Now(WRITING)),
            Phase::Verifying => return Err(Not::Now(CHECKING)),
            Phase::Rejected(_) => {
                return Err(Not::Now(
                    "The same data would be rejected again: type \"redo\" and a face, or \"calibrate\".",
                ));
            }
            Phase::NotStored => self.store(actions),
            Phase::Collecting | Phase::Full if self.coverage().is_minimum() => self.estimate(actions),
            Phase::Collecting | Phase::Full => {
                let (faces, axes) = (self.coverage().held().complement(), self.coverage().axes_without_turn());
                say(Message::Refused(Refused::Finish { faces, axes }), actions);
                return Err(Not::Said);
            }
        }
        Ok(())
    }

    fn cancel(&mut self, actions: &mut Actions) -> Result<(), Not> {
        match self.phase {
            Phase::Idle => return Err(Not::Now(NOTHING_TO_LEAVE)),
            Phase::Storing => return Err(Not::Now(WRITING)),
            Phase::Verifying => {
                act(Action::StopVerify, actions);
                say(Message::Note(Note::VerifyCancelled), actions);
            }
            Phase::Estimating | Phase::Collecting | Phase::Full | Phase::Rejected(_) | Phase::NotStored => {
                if self.phase == Phase::Estimating {
                    act(Action::StopEstimate, actions);
                }
                act(Action::ForgetAll, actions);
                say(Message::Note(Note::Cancelled), actions);
                self.collect = Collect::new(self.collect.setup);
            }
        }
        self.phase = Phase::Idle;
        Ok(())
    }

    fn verify(&mut self, actions: &mut Actions) -> Result<(), Not> {
        match self.phase {
            Phase::Idle if !self.in_force => return Err(Not::Calibrated),
            Phase::Idle => {}
            Phase::Verifying => act(Action::StopVerify, actions),
            Phase::Storing => return Err(Not::Now(WRITING)),
            _ => return Err(Not::Now(IN_SESSION)),
        }
        act(Action::StartVerify, actions);
        say(Message::Note(Note::VerifyStarted), actions);
        self.poses = 0;
        self.pose_judged = false;
        self.track.forget(None);
        self.phase = Phase::Verifying;
        Ok(())
    }
}

/// Why a word is not followed.
enum Not {
    /// Not in this phase.
    Now(&'static str),
    /// Nothing to check.
    Calibrated,
    /// Its refusal is said already.
    Said,
}

impl Not {
    fn trouble(self, command: Command) -> Option<Trouble> {
        match self {
            Self::Now(why) => Some(Trouble::NotNow { command, why }),
            Self::Calibrated => Some(Trouble::NoCalibration),
            Self::Said => None,
        }
    }
}

fn confirm(command: Command, actions: &mut Actions) {
    let _ = actions.insert(0, Action::Say(Message::Ok(command)));
}
