//! Nobody does anything, or the wrong thing for long.

use super::*;
use crate::message::Unrest;

#[test]
fn a_request_repeats_every_second_and_its_sentence_every_fifth() {
    let mut hands = Hands::calibrating("calibrate");
    hands.log.clear();
    hands.pass_s(20);
    let (mut reminders, mut sentences) = (0, 0);
    for action in &hands.log {
        match action {
            Action::Remind(Message::Ask(Ask::Place { .. })) => reminders += 1,
            Action::Say(Message::Ask(Ask::Place { .. })) => sentences += 1,
            other => panic!("{other:?}"),
        }
    }
    assert_eq!((reminders, sentences), (16, 4));
}

#[test]
fn after_five_minutes_it_says_what_it_waits_for_and_that_nothing_is_lost() {
    let mut hands = Hands::calibrating("calibrate");
    hands.do_face(Face::PlusX);
    hands.log.clear();
    hands.rest(299.0);
    assert!(!hands.log.iter().any(|action| matches!(action, Action::Say(Message::Note(Note::Waiting { .. })))));
    hands.rest(2.0);
    let note = Action::Say(Message::Note(Note::Waiting { minutes: 5 }));
    let at = hands.log.iter().position(|action| *action == note).expect("said");
    assert!(matches!(hands.log[at + 1], Action::Say(Message::Ask(Ask::Place { .. }))));
    hands.rest(300.0);
    assert!(noted(&hands, Note::Waiting { minutes: 10 }));
    assert_eq!(hands.procedure.coverage().missing(Scheme::Double), 15);
    // Progress starts the count anew.
    hands.do_face(Face::PlusY);
    hands.log.clear();
    hands.rest(290.0);
    assert!(!hands.log.iter().any(|action| matches!(action, Action::Say(Message::Note(Note::Waiting { .. })))));
}

#[test]
fn what_never_comes_to_rest_is_told_why() {
    let mut hands = Hands::calibrating("calibrate");
    hands.place(Face::PlusX);
    hands.move_for(19.0);
    assert!(!matches!(hands.asks(), Some(Ask::Still { why: Unrest::Moving { .. } })));
    hands.pass_s(3);
    assert!(matches!(hands.asks(), Some(Ask::Still { why: Unrest::Moving { excess } }) if excess == 30.0));
}

#[test]
fn idle_is_silent_and_dark() {
    let mut hands = Hands::new();
    hands.do_all();
    hands.pass_s(400);
    assert_eq!(hands.log, []);
    // And what was done before `calibrate` does not count, but where it lies is known.
    hands.type_word("calibrate");
    assert!(matches!(hands.asks(), Some(Ask::Hold { face: Some(Face::MinusZ), seconds }) if seconds == STILL_S));
}
