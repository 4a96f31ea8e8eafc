//! The session: one value that takes samples, words and seconds, and gives effects for the board to carry out.
//!
//! It joins the rooms: samples go to the segmenter and its tape, events to the procedure, the procedure's wishes to the
//! estimator, its verdict back to the procedure. Firmware and host run this same code.

use heapless::Deque;

use crate::calibration::{AcceptedCalibration, Calibration, Judgement, Verdict};
use crate::command::Command;
use crate::estimate::{Conditions, Estimator, Progress, judge};
use crate::face::Face;
use crate::led::Pattern;
use crate::message::{Message, Trouble};
use crate::motion::segmenter::Segmenter;
use crate::procedure::{Action, Input, Phase, Procedure, Setup, Stored};
use crate::sample::Sample;
use crate::tape::{Exclusion, Tape};
use crate::verify::Verifier;

/// What the board has to do, in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Say it, both ways.
    Say(Message),
    /// Say the machine's line only.
    Remind(Message),
    /// Show it from now on.
    Led(Pattern),
    /// Say every parameter of [`Session::estimated`].
    SayParameters,
    /// Store [`Session::accepted`], read it back, answer with [`Session::stored`].
    Store,
}

/// Room for what one input can bring: the procedure gives at most 16 actions, of which an estimate's end adds as many.
const EFFECTS: usize = 40;

/// Records walked in one slice of work: one or two steps of the filter.
const SLICE_RECORDS: usize = 12;

/// Everything a session needs, with room for `R` records in `S` segments. The tape is lent: it is most of the memory, all
/// zero when new, and so a static that costs no flash.
#[derive(Debug)]
pub struct Session<'t, const R: usize, const S: usize> {
    tape: &'t mut Tape<R, S>,
    segmenter: Segmenter,
    procedure: Procedure,
    estimator: Option<Estimator<S>>,
    estimated: Option<Calibration>,
    accepted: Option<AcceptedCalibration>,
    in_force: Option<Calibration>,
    verifier: Option<Verifier>,
    recording: bool,
    gravity_mps2: f32,
    lost: u32,
    effects: Deque<Effect, EFFECTS>,
}

impl<'t, const R: usize, const S: usize> Session<'t, R, S> {
    /// Idle, with no calibration in force.
    pub const fn new(tape: &'t mut Tape<R, S>) -> Self {
        Self {
            tape,
            segmenter: Segmenter::new(1.0),
            procedure: Procedure::new(false),
            estimator: None,
            estimated: None,
            accepted: None,
            in_force: None,
            verifier: None,
            recording: false,
            gravity_mps2: crate::STANDARD_GRAVITY_MPS2,
            lost: 0,
            effects: Deque::new(),
        }
    }

    /// The next thing to do, until there is none.
    pub fn next_effect(&mut self) -> Option<Effect> {
        self.effects.pop_front()
    }

    /// The calibration in force has changed.
    pub fn set_in_force(&mut self, t_us: u64, calibration: Option<&Calibration>) {
        self.in_force = calibration.copied();
        self.procedure_step(t_us, Input::InForce(calibration.is_some()));
    }

    /// Where it stands.
    pub fn phase(&self) -> Phase {
        self.procedure.phase()
    }

    /// The last estimate, accepted or not.
    pub fn estimated(&self) -> Option<&Calibration> {
        self.estimated.as_ref()
    }

    /// The last estimate, if it was accepted.
    pub fn accepted(&self) -> Option<&AcceptedCalibration> {
        self.accepted.as_ref()
    }

    /// What was recorded.
    pub fn tape(&self) -> &Tape<R, S> {
        self.tape
    }

    /// One sample; `clipped`: channels at an end of their range ([`crate::tape::Segment::clipped`]).
    pub fn sample(&mut self, sample: &Sample, clipped: u8) {
        if let (Some(verifier), Some(calibration)) = (&mut self.verifier, &self.in_force) {
            verifier.sample(&calibration.compensate(sample));
        }
        let events = if self.recording {
            self.tape.note_temperature(sample.temperature_degc);
            self.segmenter.step(sample, clipped, self.tape)
        } else if self.estimator.is_none() {
            let events = self.segmenter.step(sample, clipped, self.tape);
            self.segmenter.drop_closed(self.tape);
            if self.tape.fill() > 0.9 {
                // Nobody records, and one endless rest or move fills the tape: begin again.
                self.begin_tape();
            }
            events
        } else {
            // The tape is being read.
            return;
        };
        for event in events {
            self.procedure_step(sample.t_us, Input::Motion(event));
            let pose = self.verifier.as_mut().and_then(|verifier| verifier.event(&event));
            if let Some(pose) = pose {
                self.procedure_step(sample.t_us, Input::Pose(pose));
                if let Some(verdict) = self.verifier.as_ref().and_then(Verifier::verdict) {
                    self.verifier = None;
                    self.procedure_step(sample.t_us, Input::Verified(verdict));
                }
            }
        }
    }

    /// Samples that never came while it recorded.
    pub fn lost(&mut self, samples: u32) {
        if self.recording {
            self.lost = self.lost.saturating_add(samples);
        }
    }

    /// One of the session's words ([`Procedure::owns`]).
    pub fn command(&mut self, t_us: u64, command: Command) {
        self.procedure_step(t_us, Input::Command(command));
    }

    /// Once a second.
    pub fn second(&mut self, t_us: u64) {
        self.procedure_step(t_us, Input::Second);
    }

    /// The answer to [`Effect::Store`]. What was stored is in force.
    pub fn stored(&mut self, t_us: u64, result: Result<Stored, Trouble>) {
        if let (Ok(_), Some(accepted)) = (&result, &self.accepted) {
            self.in_force = Some(*accepted.calibration());
        }
        self.procedure_step(t_us, Input::Stored(result));
    }

    /// Is there computing to do?
    pub fn is_computing(&self) -> bool {
        self.estimator.is_some()
    }

    /// One slice of it.
    pub fn work(&mut self, t_us: u64) {
        let Some(estimator) = &mut self.estimator else { return };
        match estimator.work(self.tape, SLICE_RECORDS) {
            Ok(Progress::Working(share)) => {
                let percent = (share.min(0.99) * 100.0) as u8;
                self.procedure_step(t_us, Input::Percent(percent));
            }
            Ok(Progress::Done(estimate)) => {
                self.estimator = None;
                self.estimated = Some(estimate.calibration);
                let (judgement, accepted) = judge::judge(&estimate, self.tape, self.lost);
                self.accepted = accepted;
                self.finish_estimate(t_us, judgement);
            }
            Err(breakdown) => {
                self.estimator = None;
                let mut judgement = judge::nothing_to_estimate(self.tape);
                judgement.reasons.clear();
                let _ = judgement.reasons.push(crate::calibration::Reason::Arithmetic { place: breakdown.0 });
                self.finish_estimate(t_us, judgement);
            }
        }
    }

    fn finish_estimate(&mut self, t_us: u64, judgement: Judgement) {
        if judgement.verdict == Verdict::Rejected {
            // More can be added and recorded on.
            self.recording = true;
        }
        self.procedure_step(t_us, Input::Estimated { judgement, blame: None });
    }

    fn procedure_step(&mut self, t_us: u64, input: Input) {
        for action in self.procedure.step(t_us, input) {
            self.carry_out(action);
        }
    }

    fn carry_out(&mut self, action: Action) {
        match action {
            Action::Say(message) => self.effect(Effect::Say(message)),
            Action::Remind(message) => self.effect(Effect::Remind(message)),
            Action::Led(pattern) => self.effect(Effect::Led(pattern)),
            Action::SayParameters => self.effect(Effect::SayParameters),
            Action::Begin(_) => self.begin(),
            Action::Forget(face) => self.forget(face),
            Action::ForgetAll => {
                self.recording = false;
                self.estimator = None;
                self.begin_tape();
            }
            Action::Estimate => {
                self.recording = false;
                self.segmenter.finish(self.tape);
                self.begin_estimate();
            }
            Action::StopEstimate => self.estimator = None,
            Action::Store => self.effect(Effect::Store),
            Action::StartVerify => self.verifier = self.in_force.as_ref().map(Verifier::new),
            Action::StopVerify => self.verifier = None,
        }
    }

    /// Apart from the step, whose stack would hold those 13 KB on every way through it.
    #[inline(never)]
    fn begin_estimate(&mut self) {
        let conditions = self.conditions(self.procedure.setup());
        Estimator::begin(&mut self.estimator, self.tape, conditions);
    }

    fn effect(&mut self, effect: Effect) {
        // The board takes effects out after every input; what does not fit even so repeats within a second.
        let _ = self.effects.push_back(effect);
    }

    /// A session starts from nothing, the noise floor included: what was before is then no part of its result.
    fn begin(&mut self) {
        self.begin_tape();
        self.recording = true;
        self.lost = 0;
        self.accepted = None;
        self.estimated = None;
    }

    fn begin_tape(&mut self) {
        self.tape.clear();
        self.segmenter = Segmenter::new(1.0);
    }

    /// Strikes out what was recorded on a face.
    fn forget(&mut self, face: Face) {
        self.segmenter.cut(self.tape);
        for segment in self.tape.segments_mut() {
            if segment.face() == Some(face) && segment.exclusion == Exclusion::None {
                segment.exclusion = Exclusion::Redone;
            }
        }
    }

    fn conditions(&self, setup: Setup) -> Conditions {
        Conditions { stops: setup.stops, faces: setup.box_faces, gravity_mps2: self.gravity_mps2 }
    }
}
