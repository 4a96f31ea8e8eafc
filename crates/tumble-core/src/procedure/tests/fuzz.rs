//! Anything in any order, four hundred thousand inputs: what must hold always.

use super::*;
use crate::calibration::Reason;
use crate::command::CalAction;
use crate::verify::{PoseCheck, Verification};

/// Xorshift; and the rest of a sensible deed under way, without which no session would ever get far.
struct Random(u64, Vec<MotionEvent>);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u64) as usize]
    }

    fn face(&mut self) -> Option<Face> {
        if self.below(8) == 0 { None } else { Some(self.of(&Face::ALL)) }
    }

    fn number(&mut self) -> f32 {
        match self.below(12) {
            0 => self.of(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, 1e30]),
            _ => self.below(800) as f32 / 100.0,
        }
    }

    fn motion(&mut self) -> MotionEvent {
        let (face, some) = (self.face(), self.of(&Face::ALL));
        let turns = [6.3, -6.3, 12.57, 4.7, -4.7, 0.1];
        match self.below(64) {
            0..20 => MotionEvent::StillBegan { face },
            20..28 => MotionEvent::TurnClosed { face: some, angle_rad: self.of(&turns) },
            28..32 => MotionEvent::TurnOpen { face: some, angle_rad: self.number() },
            32..48 => MotionEvent::StillHeld { face, held_s: self.number() },
            48..58 => MotionEvent::StillEnded { face, held_s: self.number() },
            58..63 => MotionEvent::Moving { excess: self.number() },
            _ => MotionEvent::TapeFull,
        }
    }

    fn command(&mut self) -> Command {
        let setup = Setup { scheme: self.of(&[Scheme::Single, Scheme::Double]), ..Setup::default() };
        let redo = Command::Redo(self.face());
        let rare = [Command::Cancel, Command::Verify, Command::Cal(CalAction::Show), redo];
        if self.below(4) == 0 { self.of(&rare) } else { self.of(&[Command::Calibrate(setup), Command::Finish]) }
    }

    fn judgement(&mut self) -> Judgement {
        let verdict = self.of(&[Verdict::Accepted, Verdict::AcceptedWithWarnings, Verdict::Rejected]);
        let mut reasons = heapless::Vec::new();
        for _ in 0..self.below(9) {
            let axis = self.below(256) as u8;
            let _ = reasons.push(self.of(&[
                Reason::Clipped { channel: axis, samples: 1 },
                Reason::TurnsMissing { axes: axis },
                Reason::PoorFit { nis_per_dof: 3.0 },
                Reason::NotObservable { name: "" },
            ]));
        }
        Judgement { verdict, reasons }
    }

    fn input(&mut self, words: u64) -> Input {
        let pose = |number, fresh| PoseCheck {
            number,
            fresh,
            gravity_error_mps2: 0.0,
            gravity_limit_mps2: 0.0,
            level_error_rad: None,
            level_limit_rad: 0.0,
        };
        match self.below(1000) {
            0..100 => Input::Second,
            100..110 => Input::Percent(self.below(256) as u8),
            110..120 => Input::Estimated { judgement: self.judgement(), blame: self.face() },
            120..126 => Input::Stored(Ok(Stored { generation: 1, bytes: 2 })),
            126..130 => Input::Stored(Err(Trouble::Flash { doing: "writing" })),
            130..140 => Input::Pose(pose(self.below(256) as u8, self.below(2) == 0)),
            140..142 => Input::Verified(Verification {
                pass: self.below(2) == 0,
                poses: 6,
                gravity_rms_mps2: 0.0,
                level_max_rad: 0.0,
                temperature_change_degc: None,
            }),
            142..144 => Input::InForce(self.below(2) == 0),
            n if n < 144 + words => Input::Command(self.command()),
            _ if self.below(50) == 0 => Input::Motion(self.motion()),
            _ => Input::Motion(self.deed()),
        }
    }

    /// The next event of a face laid down, turned perhaps, and held.
    fn deed(&mut self) -> MotionEvent {
        if let Some(event) = self.1.pop() {
            return event;
        }
        let face = self.of(&Face::ALL);
        let on = Some(face);
        for tenths in [35, 30, 25, 20, 15, 10, 5] {
            self.1.push(MotionEvent::StillHeld { face: on, held_s: tenths as f32 / 10.0 });
        }
        if self.below(2) == 0 {
            let angle_rad = self.of(&[6.3, -6.3]);
            self.1.push(MotionEvent::TurnClosed { face, angle_rad });
            self.1.push(MotionEvent::StillBegan { face: on });
            self.1.push(MotionEvent::StillEnded { face: on, held_s: 0.5 });
        }
        self.1.push(MotionEvent::StillBegan { face: on });
        MotionEvent::StillEnded { face: on, held_s: 4.0 }
    }
}

/// What must hold of any answer to any input.
fn check(before: &Procedure, input: &Input, after: &Procedure, actions: &[Action]) {
    let context = || std::format!("{input:?} in {:?}: {actions:?}", before.phase());
    assert!(actions.len() < Actions::new().capacity(), "may have been cut: {}", context());
    if actions.contains(&Action::Estimate) {
        assert!(after.coverage().is_minimum(), "{}", context());
    }
    if actions.contains(&Action::Store) {
        let accepted = matches!(input, Input::Estimated { judgement, .. } if judgement.verdict != Verdict::Rejected);
        let again = before.phase() == Phase::NotStored;
        assert!(accepted && before.phase() == Phase::Estimating || again, "{}", context());
    }
    if matches!(input, Input::Second) {
        let heard = lines(actions);
        let is = |start: &str| heard.iter().any(|line| line.starts_with(start));
        match after.phase() {
            Phase::Idle => assert!(heard.is_empty(), "{}", context()),
            Phase::Estimating | Phase::Storing => assert!(is("@busy"), "{}", context()),
            _ => assert!(is("@ask"), "{}", context()),
        }
    }
    for (i, action) in actions.iter().enumerate() {
        if let Action::Say(message) | Action::Remind(message) = action {
            let mut text = String::new();
            message.write_to(&mut text).expect("a String takes all");
            assert!(text.is_ascii() && text.starts_with('@') && text.matches("\r\n").count() == 2, "{text}");
        }
        let led = |action: &&Action| matches!(action, Action::Led(_));
        assert!(!led(&action) || !actions[i + 1..].iter().any(|later| led(&later)), "two lights: {}", context());
    }
}

fn run(seed: u64, steps: usize, words: u64) -> [usize; 3] {
    let mut random = Random(seed, Vec::new());
    let mut procedure = Procedure::new(seed.is_multiple_of(2));
    let (mut t_us, mut counts) = (0, [0; 3]);
    for _ in 0..steps {
        t_us += random.below(3_000_000);
        let input = random.input(words);
        let before = procedure.clone();
        let actions: Vec<Action> = procedure.step(t_us, input.clone()).into_iter().collect();
        check(&before, &input, &procedure, &actions);
        for (count, action) in counts.iter_mut().zip([Action::Estimate, Action::Store, Action::StartVerify]) {
            *count += usize::from(actions.contains(&action));
        }
    }
    counts
}

#[test]
fn anything_in_any_order_keeps_the_promises() {
    let mut totals = [0; 3];
    for seed in 1..=40 {
        // Few words let sessions get far, many shake the phases.
        for (total, count) in totals.iter_mut().zip(run(seed, 10_000, [1, 5, 60][seed as usize % 3])) {
            *total += count;
        }
    }
    assert!(totals.iter().all(|total| *total > 20), "estimates, stores, checks: {totals:?}");
}
