//! What follows from motion, time and answers; what is asked and shown in each phase.

use super::track::{Happening, Posture};
use super::{Action, Actions, POSES, Phase, Procedure, SENTENCE_S, SILENCE_S, Stored, act, say};
use crate::calibration::{Judgement, Reason, Verdict};
use crate::face::Face;
use crate::led::Pattern;
use crate::message::{Ask, Choice, Message, Note, Refused, Task, Trouble};
use crate::motion::MotionEvent;
use crate::verify::{self, PoseCheck, Verification};

impl Procedure {
    pub(super) fn motion(&mut self, t_us: u64, event: MotionEvent, actions: &mut Actions) {
        let happening = self.track.follow(t_us, event);
        if matches!(happening, Some(Happening::Arrived { .. })) {
            self.pose_judged = false;
        }
        if self.phase != Phase::Collecting {
            return;
        }
        if event == MotionEvent::TapeFull {
            say(Message::Error(Trouble::MemoryFull), actions);
            self.phase = Phase::Full;
        }
        let before = *self.coverage();
        for message in happening.map(|happening| self.collect.take(happening)).into_iter().flatten() {
            say(message, actions);
        }
        if *self.coverage() == before {
            return;
        }
        self.silent_s = 0;
        if self.coverage().is_complete(self.collect.setup.scheme) {
            self.estimate(actions);
        } else {
            self.flash = Some(Pattern::Accepted);
        }
    }

    pub(super) fn estimate(&mut self, actions: &mut Actions) {
        self.phase = Phase::Estimating;
        act(Action::Estimate, actions);
        self.begin_busy(Task::Estimate, actions);
    }

    pub(super) fn store(&mut self, actions: &mut Actions) {
        self.phase = Phase::Storing;
        act(Action::Store, actions);
        self.begin_busy(Task::Store, actions);
    }

    fn begin_busy(&mut self, task: Task, actions: &mut Actions) {
        self.percent = 0;
        self.repeats = 0;
        say(Message::Busy { task, percent: 0 }, actions);
    }

    pub(super) fn estimated(&mut self, judgement: &Judgement, blame: Option<Face>, actions: &mut Actions) {
        if self.phase != Phase::Estimating {
            return;
        }
        let verdict = judgement.verdict;
        say(Message::Result { verdict, reasons: u8::try_from(judgement.reasons.len()).unwrap_or(u8::MAX) }, actions);
        for reason in &judgement.reasons {
            say(Message::Reason(*reason), actions);
        }
        if verdict == Verdict::Rejected {
            let blame = blame.or_else(|| judgement.reasons.iter().find_map(Reason::face_to_redo));
            self.phase = Phase::Rejected(blame);
        } else {
            act(Action::SayParameters, actions);
            self.store(actions);
        }
    }

    pub(super) fn stored(&mut self, result: Result<Stored, Trouble>, actions: &mut Actions) {
        if self.phase != Phase::Storing {
            return;
        }
        match result {
            Ok(Stored { generation, bytes }) => {
                say(Message::Stored { generation, bytes }, actions);
                say(Message::Note(Note::SuggestVerify), actions);
                self.in_force = true;
                self.phase = Phase::Idle;
                self.flash = Some(Pattern::Done);
            }
            Err(trouble) => {
                say(Message::Error(trouble), actions);
                self.phase = Phase::NotStored;
            }
        }
    }

    pub(super) fn pose(&mut self, pose: PoseCheck, actions: &mut Actions) {
        if self.phase != Phase::Verifying {
            return;
        }
        self.pose_judged = true;
        if !pose.fresh {
            say(Message::Refused(Refused::Pose), actions);
            return;
        }
        self.silent_s = 0;
        self.poses = pose.number;
        say(Message::Pose(pose), actions);
        self.flash = Some(Pattern::Accepted);
    }

    pub(super) fn verified(&mut self, verification: Verification, actions: &mut Actions) {
        if self.phase == Phase::Verifying {
            say(Message::Verified(verification), actions);
            self.phase = Phase::Idle;
            self.flash = Some(if verification.pass { Pattern::Done } else { Pattern::Error(7) });
        }
    }

    /// Counts the silence, and speaks after [`SILENCE_S`] of it.
    pub(super) fn second(&mut self, actions: &mut Actions) {
        self.repeats = self.repeats.wrapping_add(1);
        if matches!(self.phase, Phase::Idle | Phase::Estimating | Phase::Storing) {
            return;
        }
        self.silent_s = self.silent_s.saturating_add(1);
        if self.silent_s.is_multiple_of(SILENCE_S) {
            say(Message::Note(Note::Waiting { minutes: self.silent_s / 60 }), actions);
            self.asked = None;
        }
    }

    /// Says what is wanted when that has changed, and again with every second.
    pub(super) fn request(&mut self, t_us: u64, second: bool, actions: &mut Actions) {
        let ask = self.ask(t_us);
        let message = match (self.phase, ask) {
            (Phase::Estimating, _) => Message::Busy { task: Task::Estimate, percent: self.percent },
            (Phase::Storing, _) => Message::Busy { task: Task::Store, percent: self.percent },
            (_, Some(ask)) => Message::Ask(ask),
            (_, None) => {
                self.asked = None;
                return;
            }
        };
        let changed = ask.is_some_and(|ask| !self.asked.is_some_and(|asked| asked.is_like(&ask)));
        if changed {
            self.repeats = 0;
            say(message, actions);
        } else if second && self.repeats.is_multiple_of(SENTENCE_S) {
            say(message, actions);
        } else if second {
            act(Action::Remind(message), actions);
        }
        self.asked = ask;
    }

    fn ask(&self, t_us: u64) -> Option<Ask> {
        let word = |choice| Some(Ask::Word { choice });
        match self.phase {
            Phase::Idle | Phase::Estimating | Phase::Storing => None,
            Phase::Collecting => Some(self.collect.ask(t_us, &self.track)),
            Phase::Full if self.coverage().is_minimum() => word(Choice::FullEnough),
            Phase::Full => word(Choice::FullShort),
            Phase::Rejected(blame) => word(Choice::Rejected(blame)),
            Phase::NotStored => word(Choice::NotStored),
            Phase::Verifying => Some(match self.track.posture() {
                Posture::Resting { face, held_s } if !self.pose_judged => {
                    Ask::Hold { face, seconds: (verify::POSE_S - held_s).max(0.0) }
                }
                _ => Ask::Pose { done: self.poses, of: POSES },
            }),
        }
    }

    /// Shows the phase where that is not shown already. Counted blinks take the place of waiting and of darkness, into which
    /// they run out by themselves, but not of a light that means something at once.
    pub(super) fn light(&mut self, actions: &mut Actions) {
        let phase = self.pattern();
        let stands_for = |flash: &Pattern| match flash {
            Pattern::Accepted => phase == Pattern::Waiting,
            // A failed check keeps its blinks until the next session.
            Pattern::Done | Pattern::Error(_) => phase == Pattern::Off,
            _ => false,
        };
        let fresh = self.flash.take().filter(stands_for);
        if fresh.is_none() && (phase == self.led || self.led_is_flash && stands_for(&self.led)) {
            return;
        }
        self.led_is_flash = fresh.is_some();
        self.led = fresh.unwrap_or(phase);
        act(Action::Led(self.led), actions);
    }

    fn pattern(&self) -> Pattern {
        match self.phase {
            Phase::Idle => Pattern::Off,
            Phase::Full => Pattern::Error(6),
            Phase::Rejected(_) => Pattern::Error(7),
            Phase::NotStored => Pattern::Error(5),
            Phase::Estimating | Phase::Storing => Pattern::Busy,
            Phase::Collecting | Phase::Verifying => match self.asked {
                Some(Ask::Hold { .. }) => Pattern::Sampling,
                _ => Pattern::Waiting,
            },
        }
    }
}
