//! What is calibrated on the host is calibrated by the board's own session: it must not ask a recorded person for more rest than
//! the recording's scheme has.

use tumble_core::command::Command;
use tumble_core::message::{Message, Refused};
use tumble_core::procedure::{BoxFaces, Scheme, Setup, TurnStops};
use tumble_core::session::{Effect, Session};
use tumble_core::tape::Tape;
use tumble_sim::SchemeConfig;

/// Refusals of the session, and whether all was collected.
fn replay(scheme: tumble_sim::Scheme, wanted: Scheme, seed: u64) -> (Vec<Refused>, bool) {
    let samples = SchemeConfig::new(scheme, seed).record().expect("a valid configuration").samples;
    let readings = tumble::study::trial::readings(&samples);
    let mut tape = Box::new(Tape::<3072, 160>::new());
    let mut session = Session::new(&mut tape);
    let setup = Setup { stops: TurnStops::Fenced, box_faces: BoxFaces::Square, scheme: wanted };
    session.command(0, Command::Calibrate(setup));
    let mut refused = Vec::new();
    for reading in &readings {
        session.sample(&reading.sample, 0);
        while let Some(effect) = session.next_effect() {
            if let Effect::Say(Message::Refused(why)) = effect {
                refused.push(why);
            }
        }
    }
    (refused, session.is_computing())
}

#[test]
fn a_session_with_rests_of_three_seconds_is_complete() {
    for seed in 1..=12 {
        let (refused, complete) = replay(tumble_sim::Scheme::Double, Scheme::Double, seed);
        assert!(complete && refused.is_empty(), "seed {seed}: {refused:?}");
    }
}

#[test]
fn so_is_one_with_single_turns() {
    for seed in 1..=4 {
        let (refused, complete) = replay(tumble_sim::Scheme::Single, Scheme::Single, seed);
        assert!(complete && refused.is_empty(), "seed {seed}: {refused:?}");
    }
}
