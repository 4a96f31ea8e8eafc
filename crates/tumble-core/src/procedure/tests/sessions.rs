//! Whole sessions: as asked, out of order, with every kind of mistake.

use super::*;
use crate::face::FaceSet;

#[test]
fn the_recommended_session_as_asked_ends_in_flash() {
    let mut hands = Hands::calibrating("calibrate fenced square");
    let setup = hands.procedure.setup();
    assert_eq!((setup.stops, setup.box_faces), (TurnStops::Fenced, BoxFaces::Square));
    for face in ASKING_ORDER {
        let Some(Ask::Place { missing }) = hands.asks() else { panic!("{:?}", hands.asks()) };
        assert_eq!(ASKING_ORDER.into_iter().find(|f| missing.contains(*f)), Some(face));
        hands.place(face);
        assert!(matches!(hands.asks(), Some(Ask::Hold { face: Some(f), .. }) if f == face));
        assert_eq!(hands.led(), Pattern::Sampling);
        hands.rest(3.0);
        assert_eq!(hands.led(), Pattern::Accepted);
        for direction in [Direction::Ccw, Direction::Cw] {
            let wanted = Ask::Turn { face, direction: Some(direction), stops: TurnStops::Fenced };
            assert_eq!(hands.asks(), Some(wanted));
            hands.turn(if direction == Direction::Ccw { 359.8 } else { -360.3 });
            assert!(matches!(hands.asks(), Some(Ask::Hold { .. })));
            hands.rest(2.0);
        }
    }
    assert_eq!((hands.accepted(), hands.refusals().len()), (18, 0));
    assert_eq!((hands.procedure.phase(), hands.led()), (Phase::Estimating, Pattern::Busy));
    assert_eq!(hands.count(&Action::Estimate), 1);
    let actions = hands.judge(Verdict::AcceptedWithWarnings);
    assert!(actions.contains(&Action::SayParameters) && actions.contains(&Action::Store));
    hands.store(Ok(Stored { generation: 4, bytes: 260 }));
    assert_eq!((hands.procedure.phase(), hands.led()), (Phase::Idle, Pattern::Done));
    let heard = hands.heard();
    let last: Vec<&str> = heard.iter().rev().take(2).map(String::as_str).collect();
    assert_eq!(last, ["@note about=suggest_verify", "@stored generation=4 bytes=260"]);
}

#[test]
fn any_order_will_do() {
    let orders: [[usize; 6]; 4] = [[5, 4, 3, 2, 1, 0], [2, 0, 5, 1, 3, 4], [1, 3, 5, 0, 2, 4], [4, 1, 0, 5, 3, 2]];
    for order in orders {
        let mut hands = Hands::calibrating("calibrate");
        // Stills first, without turns; then turns, clockwise first; some twice round.
        for index in order {
            hands.place(Face::ALL[index]);
            hands.rest(3.5);
        }
        assert_eq!(hands.procedure.coverage().held(), FaceSet::FULL);
        for index in order {
            hands.place(Face::ALL[5 - index]);
            hands.turn(-720.0);
            hands.rest(2.0);
            hands.turn(360.0);
            hands.rest(2.0);
        }
        assert_eq!((hands.procedure.phase(), hands.refusals().len()), (Phase::Estimating, 0));
    }
}

#[test]
fn a_turn_before_the_still_counts_and_its_rest_serves_both() {
    let mut hands = Hands::calibrating("calibrate");
    hands.place(Face::PlusZ);
    hands.rest(1.0);
    hands.turn(360.0);
    hands.rest(1.5);
    assert_eq!(hands.accepted(), 0);
    assert!(matches!(hands.asks(), Some(Ask::Hold { .. })));
    hands.rest(0.5);
    assert_eq!(hands.accepted(), 2);
    assert_eq!(hands.asks(), ask_turn(Face::PlusZ, Direction::Cw));
}

#[test]
fn the_same_face_is_never_a_new_one() {
    let mut hands = Hands::calibrating("calibrate");
    for _ in 0..6 {
        hands.place(Face::PlusX);
        hands.rest(4.0);
        hands.place(None);
        hands.rest(1.0);
    }
    assert_eq!((hands.accepted(), hands.procedure.coverage().held().len()), (1, 1));
    assert_eq!(hands.asks(), Some(Ask::Still { why: crate::message::Unrest::Oblique }));
    hands.do_face(Face::PlusX);
    hands.log.clear();
    hands.place(Face::PlusY);
    hands.place(Face::PlusX);
    assert_eq!(hands.refusals(), [Refused::Face { face: Face::PlusX }]);
    hands.rest(1.0);
    assert!(matches!(hands.asks(), Some(Ask::Place { missing }) if !missing.contains(Face::PlusX)));
}

#[test]
fn wrong_turns_are_refused_with_what_was_done_and_asked_again() {
    let mut hands = Hands::calibrating("calibrate");
    hands.place(Face::PlusX);
    hands.rest(3.0);
    hands.log.clear();
    hands.turn(271.0);
    let lines = hands.heard();
    assert!(lines.contains(&"@refused what=turn face=+x angle_deg=271.0 why=open".into()), "{lines:?}");
    hands.rest(2.0);
    assert_eq!(hands.asks(), ask_turn(Face::PlusX, Direction::Ccw));
    // Turned on to where it began, it counts.
    hands.turn(89.0);
    hands.rest(2.0);
    assert!(hands.heard().contains(&"@accepted what=turn face=+x direction=ccw angle_deg=360.00".into()));
    // Counter-clockwise again where clockwise is asked.
    hands.turn(360.0);
    let again = Refused::Turn { face: Face::PlusX, angle_rad: Some(360.0_f32.to_radians()), why: RefusedTurn::Again };
    assert_eq!(hands.refusals(), [again]);
    hands.rest(2.0);
    assert_eq!(hands.asks(), ask_turn(Face::PlusX, Direction::Cw));
    // Half a turn and back.
    hands.log.clear();
    hands.turn(-180.0);
    hands.turn(180.0);
    let whys: Vec<RefusedTurn> = hands.refusals().iter().map(why).collect();
    assert_eq!(whys, [RefusedTurn::Open, RefusedTurn::NoNet]);
}

fn why(refused: &Refused) -> RefusedTurn {
    match refused {
        Refused::Turn { why, .. } => *why,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_other_direction_counts_as_what_it_is() {
    let mut hands = Hands::calibrating("calibrate");
    hands.place(Face::MinusY);
    hands.rest(3.0);
    assert_eq!(hands.asks(), ask_turn(Face::MinusY, Direction::Ccw));
    hands.turn(-361.0);
    hands.rest(2.0);
    assert!(hands.procedure.coverage().has_turn(Face::MinusY, Direction::Cw));
    assert_eq!(hands.asks(), ask_turn(Face::MinusY, Direction::Ccw));
}

#[test]
fn a_bump_costs_only_that_hold() {
    let mut hands = Hands::calibrating("calibrate");
    hands.do_face(Face::PlusZ);
    hands.place(Face::PlusX);
    hands.rest(STILL_S - 0.5);
    hands.log.clear();
    hands.move_for(0.5);
    assert_eq!(hands.refusals(), [Refused::Hold { face: Face::PlusX, held_s: STILL_S - 0.5, needed_s: STILL_S }]);
    assert!(matches!(hands.asks(), Some(Ask::Still { .. })));
    assert_eq!(hands.led(), Pattern::Waiting);
    hands.let_go(Some(Face::PlusX));
    hands.rest(3.0);
    assert_eq!((hands.accepted(), hands.procedure.coverage().missing(Scheme::Double)), (1, 14));
    // In the rest behind a turn: the turn is kept, only its rest begins anew.
    hands.turn(360.0);
    hands.rest(1.0);
    hands.move_for(0.5);
    hands.let_go(Some(Face::PlusX));
    hands.rest(2.0);
    assert!(hands.procedure.coverage().has_turn(Face::PlusX, Direction::Ccw));
    // But carried away before its rest was over, the turn is lost, and that is said.
    hands.log.clear();
    hands.turn(-360.0);
    hands.rest(1.0);
    hands.place(Face::PlusY);
    assert_eq!(hands.refusals().iter().filter(|r| matches!(r, Refused::Turn { .. })).map(why).count(), 1);
    assert!(!hands.procedure.coverage().has_turn(Face::PlusX, Direction::Cw));
}

#[test]
fn a_face_lifted_in_a_turn_is_noticed_and_a_touch_is_not() {
    let mut hands = Hands::calibrating("calibrate");
    hands.place(Face::PlusX);
    hands.rest(3.0);
    hands.log.clear();
    hands.place(Face::PlusX);
    hands.rest(0.5);
    assert_eq!(hands.refusals().iter().map(why).collect::<Vec<_>>(), [RefusedTurn::Lifted]);
    assert_eq!(hands.asks(), ask_turn(Face::PlusX, Direction::Ccw));
    hands.log.clear();
    hands.move_for(1.0);
    hands.let_go(Some(Face::PlusX));
    hands.rest(1.0);
    assert_eq!(hands.refusals(), []);
}

#[test]
fn the_single_scheme_asks_for_one_turn_a_face() {
    let mut hands = Hands::calibrating("calibrate single");
    for face in ASKING_ORDER {
        hands.place(face);
        hands.rest(3.0);
        assert_eq!(hands.asks(), ask_turn(face, Direction::Ccw));
        hands.turn(360.0);
        hands.rest(2.0);
    }
    assert_eq!((hands.accepted(), hands.procedure.phase()), (12, Phase::Estimating));
}

#[test]
fn finish_is_offered_and_accepted_from_the_minimum_on() {
    let mut hands = Hands::calibrating("calibrate");
    for face in Face::ALL {
        assert!(!noted(&hands, Note::MinimumReached));
        let refused = lines(&hands.type_word("finish"));
        assert!(refused[0].starts_with("@refused what=finish faces="), "{refused:?}");
        assert!(refused[1].starts_with("@ask"), "{refused:?}");
        hands.place(face);
        hands.rest(3.0);
        if face.sign() < 0.0 {
            hands.turn(-360.0);
            hands.rest(2.0);
        }
    }
    assert!(noted(&hands, Note::MinimumReached) && hands.procedure.coverage().is_minimum());
    assert_eq!(hands.count(&Action::Estimate), 0);
    hands.type_word("finish");
    assert_eq!((hands.procedure.phase(), hands.count(&Action::Estimate)), (Phase::Estimating, 1));
}
