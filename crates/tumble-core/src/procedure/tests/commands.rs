//! The words, in every phase; results, storage and verify.

use super::*;
use crate::calibration::Reason;
use crate::verify::{POSES, PoseCheck, Verification};

/// A machine in each phase.
fn in_every_phase() -> Vec<(Phase, Hands)> {
    let calibrating = || Hands::calibrating("calibrate");
    let all_done = || {
        let mut hands = calibrating();
        hands.do_all();
        hands
    };
    let judged = |verdict| {
        let mut hands = all_done();
        hands.judge(verdict);
        hands
    };
    let mut full = calibrating();
    full.do_face(Face::PlusX);
    full.give(Input::Motion(MotionEvent::TapeFull));
    let mut not_stored = judged(Verdict::Accepted);
    not_stored.store(Err(Trouble::Flash { doing: "writing" }));
    let mut verifying = Hands::calibrated();
    verifying.type_word("verify");
    let phases = [
        (Phase::Idle, Hands::new()),
        (Phase::Collecting, calibrating()),
        (Phase::Full, full),
        (Phase::Estimating, all_done()),
        (Phase::Rejected(None), judged(Verdict::Rejected)),
        (Phase::Storing, judged(Verdict::Accepted)),
        (Phase::NotStored, not_stored),
        (Phase::Verifying, verifying),
    ];
    assert!(phases.iter().all(|(phase, hands)| hands.procedure.phase() == *phase));
    phases.into()
}

#[test]
fn every_word_is_answered_in_every_phase() {
    for word in ["calibrate", "redo", "redo -z", "finish", "cancel", "verify"] {
        for (phase, mut hands) in in_every_phase() {
            let heard = lines(&hands.type_word(word));
            let answers = ["@ok", "@error", "@refused"];
            assert!(answers.iter().any(|answer| heard[0].starts_with(answer)), "{word} in {phase:?}: {heard:?}");
        }
    }
    for word in ["help", "info", "stream raw", "cal show", "record", "selftest"] {
        for (phase, mut hands) in in_every_phase() {
            assert_eq!(hands.type_word(word), [], "{word} in {phase:?}");
        }
    }
}

#[test]
fn every_phase_tells_every_second_what_it_waits_for() {
    for (phase, mut hands) in in_every_phase() {
        for second in 0..20 {
            let heard = lines(&hands.give(Input::Second));
            match phase {
                Phase::Idle => assert_eq!(heard, [] as [String; 0]),
                Phase::Estimating | Phase::Storing => assert!(heard[0].starts_with("@busy"), "{heard:?}"),
                _ => assert!(heard[0].starts_with("@ask"), "{phase:?} {second}: {heard:?}"),
            }
        }
    }
}

#[test]
fn cancel_leaves_every_phase_but_writing() {
    for (phase, mut hands) in in_every_phase() {
        hands.type_word("cancel");
        let now = if phase == Phase::Storing { Phase::Storing } else { Phase::Idle };
        assert_eq!(hands.procedure.phase(), now, "{phase:?}");
        if now == Phase::Idle {
            assert!(matches!(hands.led(), Pattern::Off | Pattern::Done), "{phase:?}: {:?}", hands.led());
            // And what comes late changes nothing.
            assert_eq!(hands.judge(Verdict::Accepted), []);
            assert_eq!(hands.store(Ok(Stored { generation: 1, bytes: 1 })), []);
            assert_eq!(hands.procedure.phase(), Phase::Idle);
        }
    }
}

#[test]
fn calibrate_in_a_session_begins_anew_and_says_so() {
    for (phase, mut hands) in in_every_phase() {
        let heard = lines(&hands.type_word("calibrate fenced"));
        if phase == Phase::Storing {
            assert!(heard[0].contains("calibrate_not_now"), "{heard:?}");
            continue;
        }
        let anew = !matches!(phase, Phase::Idle | Phase::Verifying);
        let about = if anew { "@note about=restarted turns=fenced" } else { "@note about=started turns=fenced" };
        assert!(heard[1].starts_with(about), "{phase:?}: {heard:?}");
        assert_eq!(hands.procedure.coverage().missing(Scheme::Double), 18);
        assert_eq!(hands.count(&Action::StopEstimate), usize::from(phase == Phase::Estimating));
        assert_eq!(hands.count(&Action::StopVerify), usize::from(phase == Phase::Verifying));
    }
}

#[test]
fn redo_forgets_one_face_and_a_rest_on_it_counts_from_then_on() {
    let mut hands = Hands::calibrating("calibrate");
    assert!(lines(&hands.type_word("redo"))[0].contains("redo_not_now"));
    hands.do_face(Face::PlusX);
    hands.do_face(Face::PlusY);
    hands.type_word("redo x");
    assert_eq!(hands.count(&Action::Forget(Face::PlusX)), 1);
    assert_eq!(hands.procedure.coverage().missing(Scheme::Double), 15);
    hands.type_word("redo +y");
    assert!(matches!(hands.asks(), Some(Ask::Hold { face: Some(Face::PlusY), seconds }) if seconds == STILL_S));
    hands.rest(STILL_S - 0.5);
    assert!(!hands.procedure.coverage().held().contains(Face::PlusY));
    hands.rest(0.5);
    assert!(hands.procedure.coverage().held().contains(Face::PlusY));
    // Without a face: the last one worked on. In the middle of a turn: that turn is gone.
    hands.move_for(3.0);
    hands.type_word("redo");
    assert_eq!(hands.count(&Action::Forget(Face::PlusY)), 2);
    hands.log.clear();
    hands.let_go(Some(Face::PlusY));
    hands.give(Input::Motion(MotionEvent::TurnClosed { face: Face::PlusY, angle_rad: 6.3 }));
    hands.rest(STILL_S - 0.5);
    assert!(!hands.procedure.coverage().has_turn(Face::PlusY, Direction::Ccw));
    assert_eq!((hands.accepted(), hands.refusals().len()), (0, 0));
}

#[test]
fn a_full_memory_offers_what_helps() {
    let mut hands = Hands::calibrating("calibrate");
    hands.do_face(Face::PlusX);
    hands.give(Input::Motion(MotionEvent::TapeFull));
    assert_eq!(hands.led(), Pattern::Error(6));
    hands.do_face(Face::PlusY);
    assert!(!hands.procedure.coverage().held().contains(Face::PlusY), "nothing is recorded, so nothing counts");
    assert!(hands.heard().last().is_some_and(|line| line.contains("words=redo,calibrate,cancel")));
    hands.type_word("redo +x");
    assert_eq!(hands.procedure.phase(), Phase::Collecting);
    for face in Face::ALL {
        hands.place(face);
        hands.rest(3.0);
        hands.turn(360.0);
        hands.rest(2.0);
    }
    hands.give(Input::Motion(MotionEvent::TapeFull));
    assert!(hands.heard().last().is_some_and(|line| line.contains("words=finish,redo,cancel")));
    hands.type_word("finish");
    assert_eq!(hands.procedure.phase(), Phase::Estimating);
}

#[test]
fn a_rejected_result_keeps_the_flash_and_asks_for_the_face_to_blame() {
    let mut hands = Hands::calibrating("calibrate");
    hands.do_all();
    let clipped = Reason::Clipped { channel: 2, samples: 12 };
    let reasons = heapless::Vec::from_slice(&[Reason::PoorFit { nis_per_dof: 9.0 }, clipped]).expect("fits");
    hands.log.clear();
    hands.give(Input::Estimated { judgement: Judgement { verdict: Verdict::Rejected, reasons }, blame: None });
    assert_eq!((hands.count(&Action::Store), hands.count(&Action::SayParameters)), (0, 0));
    assert_eq!((hands.procedure.phase(), hands.led()), (Phase::Rejected(Some(Face::PlusZ)), Pattern::Error(7)));
    let heard = hands.heard();
    assert_eq!(heard[0], "@result verdict=rejected reasons=2");
    assert!(heard[3].ends_with("words=redo,calibrate,cancel face=+z"), "{heard:?}");
    hands.type_word("redo");
    assert_eq!((hands.count(&Action::Forget(Face::PlusZ)), hands.procedure.phase()), (1, Phase::Collecting));
    hands.do_face(Face::PlusZ);
    assert_eq!(hands.count(&Action::Estimate), 1);
}

#[test]
fn a_failed_flash_can_be_tried_again() {
    let mut hands = Hands::calibrating("calibrate");
    hands.do_all();
    hands.judge(Verdict::Accepted);
    hands.log.clear();
    hands.store(Err(Trouble::Flash { doing: "erasing" }));
    assert_eq!((hands.procedure.phase(), hands.led()), (Phase::NotStored, Pattern::Error(5)));
    hands.type_word("finish");
    assert_eq!((hands.procedure.phase(), hands.count(&Action::Store)), (Phase::Storing, 1));
    hands.store(Ok(Stored { generation: 2, bytes: 260 }));
    assert_eq!((hands.procedure.phase(), hands.led()), (Phase::Idle, Pattern::Done));
}

fn pose(number: u8, fresh: bool) -> PoseCheck {
    PoseCheck {
        number,
        fresh,
        gravity_error_mps2: 0.001,
        gravity_limit_mps2: 0.01,
        level_error_rad: Some(0.001),
        level_limit_rad: 0.01,
    }
}

#[test]
fn verify_needs_a_calibration_and_asks_for_six_poses() {
    assert!(lines(&Hands::new().type_word("verify"))[0].starts_with("@error code=0 thing=calibration"));
    let mut hands = Hands::calibrated();
    hands.give(Input::InForce(false));
    assert!(lines(&hands.type_word("verify"))[0].starts_with("@error"));
    hands.give(Input::InForce(true));
    hands.type_word("verify");
    for number in 1..=POSES {
        hands.place(None);
        assert!(matches!(hands.asks(), Some(Ask::Hold { face: None, .. })));
        assert_eq!(hands.led(), Pattern::Sampling);
        hands.rest(2.0);
        hands.give(Input::Pose(pose(number, false)));
        assert_eq!(hands.asks(), Some(Ask::Pose { done: number - 1, of: POSES }));
        hands.place(Face::PlusZ);
        hands.rest(2.0);
        hands.give(Input::Pose(pose(number, true)));
        assert_eq!((hands.asks(), hands.led()), (Some(Ask::Pose { done: number, of: POSES }), Pattern::Accepted));
    }
    let verification = Verification {
        pass: false,
        poses: POSES,
        gravity_rms_mps2: 0.1,
        level_max_rad: 0.1,
        temperature_change_degc: Some(-9.0),
    };
    hands.give(Input::Verified(verification));
    assert_eq!((hands.procedure.phase(), hands.led()), (Phase::Idle, Pattern::Error(7)));
    hands.type_word("calibrate");
    assert_eq!(hands.led(), Pattern::Sampling, "it lies on a face");
}
