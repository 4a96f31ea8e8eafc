//! Sessions as people do them, told as motion events.

extern crate std;
use std::string::String;
use std::vec::Vec;

mod commands;
mod fuzz;
mod sessions;
mod silence;

use super::*;
use crate::calibration::Verdict;
use crate::face::ASKING_ORDER;
use crate::message::{Ask, Note, Refused, RefusedTurn};

/// A procedure with hands: emits the events that the segmenter makes of what the hands do, and a second every second.
struct Hands {
    procedure: Procedure,
    t_us: u64,
    seconds: u64,
    lies_on: Option<Face>,
    held_s: f32,
    since_closed_deg: f32,
    log: Vec<Action>,
}

impl Hands {
    fn new() -> Self {
        let procedure = Procedure::new(false);
        Self { procedure, t_us: 0, seconds: 0, lies_on: None, held_s: 0.0, since_closed_deg: 0.0, log: Vec::new() }
    }

    /// In a session with this setup.
    fn calibrating(words: &str) -> Self {
        let mut hands = Self::new();
        hands.type_word(words);
        hands
    }

    fn give(&mut self, input: Input) -> Vec<Action> {
        let actions: Vec<Action> = self.procedure.step(self.t_us, input).into_iter().collect();
        self.log.extend(actions.iter().cloned());
        actions
    }

    fn type_word(&mut self, line: &str) -> Vec<Action> {
        let command = Command::parse(line).expect("a line").expect("a command");
        self.give(Input::Command(command))
    }

    /// Half a second passes.
    fn pass(&mut self) {
        self.t_us += 500_000;
        while self.seconds * 1_000_000 < self.t_us {
            self.seconds += 1;
            self.give(Input::Second);
        }
    }

    fn pass_s(&mut self, seconds: u32) {
        (0..2 * seconds).for_each(|_| self.pass());
    }

    fn let_go(&mut self, face: Option<Face>) {
        self.lies_on = face;
        self.held_s = 0.0;
        self.give(Input::Motion(MotionEvent::StillBegan { face }));
    }

    fn rest(&mut self, seconds: f32) {
        for _ in 0..(2.0 * seconds) as usize {
            self.pass();
            self.held_s += 0.5;
            let (face, held_s) = (self.lies_on, self.held_s);
            self.give(Input::Motion(MotionEvent::StillHeld { face, held_s }));
        }
    }

    fn move_for(&mut self, seconds: f32) {
        let (face, held_s) = (self.lies_on, self.held_s);
        self.give(Input::Motion(MotionEvent::StillEnded { face, held_s }));
        for _ in 0..(2.0 * seconds) as usize {
            self.pass();
            self.give(Input::Motion(MotionEvent::Moving { excess: 30.0 }));
        }
    }

    /// Picks it up and lays it down, without resting yet.
    fn place(&mut self, face: impl Into<Option<Face>>) {
        self.move_for(3.0);
        self.since_closed_deg = 0.0;
        self.let_go(face.into());
    }

    /// Turns it on the table, without resting yet. As the segmenter's, the angle of an event counts from the last closure.
    fn turn(&mut self, angle_deg: f32) {
        let face = self.lies_on.expect("on a face");
        self.move_for(6.0);
        self.let_go(Some(face));
        self.since_closed_deg += angle_deg;
        let total = self.since_closed_deg;
        let angle_rad = total.to_radians();
        let whole = (total / 360.0).round();
        if whole != 0.0 && (total - whole * 360.0).abs() < 17.0 {
            self.since_closed_deg = 0.0;
            self.give(Input::Motion(MotionEvent::TurnClosed { face, angle_rad }));
        } else {
            self.give(Input::Motion(MotionEvent::TurnOpen { face, angle_rad }));
        }
    }

    /// A face with all its work, as recommended.
    fn do_face(&mut self, face: Face) {
        self.place(face);
        self.rest(3.0);
        for angle in [360.0, -360.0] {
            self.turn(angle);
            self.rest(2.0);
        }
    }

    fn do_all(&mut self) {
        ASKING_ORDER.into_iter().for_each(|face| self.do_face(face));
    }

    fn judge(&mut self, verdict: Verdict) -> Vec<Action> {
        let judgement = Judgement { verdict, reasons: heapless::Vec::new() };
        self.give(Input::Estimated { judgement, blame: None })
    }

    fn store(&mut self, result: Result<Stored, Trouble>) -> Vec<Action> {
        self.give(Input::Stored(result))
    }

    /// A session up to its end.
    fn calibrated() -> Self {
        let mut hands = Self::calibrating("calibrate");
        hands.do_all();
        hands.judge(Verdict::Accepted);
        hands.store(Ok(Stored { generation: 1, bytes: 260 }));
        hands
    }

    /// What was said since last asked, as machine lines.
    fn heard(&mut self) -> Vec<String> {
        self.log.drain(..).filter_map(|action| line(&action)).collect()
    }

    fn asks(&self) -> Option<Ask> {
        self.log.iter().rev().find_map(|action| match action {
            Action::Say(Message::Ask(ask)) | Action::Remind(Message::Ask(ask)) => Some(*ask),
            _ => None,
        })
    }

    fn refusals(&self) -> Vec<Refused> {
        let refused = |action: &Action| match action {
            Action::Say(Message::Refused(refused)) => Some(*refused),
            _ => None,
        };
        self.log.iter().filter_map(refused).collect()
    }

    fn accepted(&self) -> usize {
        self.log.iter().filter(|action| matches!(action, Action::Say(Message::Accepted(_)))).count()
    }

    fn count(&self, action: &Action) -> usize {
        self.log.iter().filter(|logged| *logged == action).count()
    }

    fn led(&self) -> Pattern {
        let shown = |action: &Action| match action {
            Action::Led(pattern) => Some(*pattern),
            _ => None,
        };
        self.log.iter().rev().find_map(shown).unwrap_or_default()
    }
}

fn line(action: &Action) -> Option<String> {
    let (Action::Say(message) | Action::Remind(message)) = action else { return None };
    let mut line = String::new();
    message.machine(&mut line).expect("a String takes all");
    Some(line)
}

fn lines(actions: &[Action]) -> Vec<String> {
    actions.iter().filter_map(line).collect()
}

fn ask_turn(face: Face, direction: Direction) -> Option<Ask> {
    Some(Ask::Turn { face, direction: Some(direction), stops: TurnStops::ByHand })
}

fn noted(hands: &Hands, note: Note) -> bool {
    hands.count(&Action::Say(Message::Note(note))) > 0
}
