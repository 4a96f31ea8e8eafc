//! The demo's story with the product's firmware: once as it is told, and once with a clumsy person.

#[path = "common/firmware.rs"]
mod firmware;

use emulator::story::acts;
use emulator::story::stage::{Cast, Stage};
use emulator::story::whole::{self, Script};
use tumble_sim::PersonConfig;
use tumble_sim::person::Clumsiness;

#[test]
fn the_whole_story_holds() {
    let cast = Cast::new(11, false);
    let outcome =
        whole::tell(firmware::elf(), &cast, Script { tumble_s: Some(12.0), verify: true }).expect("it goes on");
    assert_eq!(outcome.checks.failed(), Vec::<String>::new());
    assert!(outcome.score.within(2.0) >= 18, "{:?}", outcome.score.beyond(2.0));
    assert!(outcome.session.estimate.seconds < 20.0, "{:?}", outcome.session.estimate);
    let (used, size) = outcome.stack.expect("cortex-m-rt's symbols");
    // Bytes free: an exception's frame with floats takes 104, and those of three levels of handlers some hundred each.
    assert!(used + 4096 < size, "stack: {used} of {size} bytes");
}

/// Bumps, wrong directions, turns that stop short, wrong faces: what does not count is refused and asked again, and
/// what counts is kept.
#[test]
fn a_clumsy_person_gets_there_too() {
    let clumsiness =
        Clumsiness { bump: 0.25, wrong_direction: 0.25, short_turn: 0.25, wrong_face: 0.25, at_most: Some(8) };
    let mut cast = Cast::new(12, true);
    let pace = PersonConfig { turn_s: (6.0, 8.0), move_s: (1.8, 2.6), ..cast.person };
    cast.person = PersonConfig { clumsiness, ..pace };
    let mut stage = Stage::new(firmware::elf(), &cast).expect("it starts");
    let session = acts::calibrate(&mut stage, 0).expect("it ends");
    assert!(stage.person.mishaps() >= 5, "{} mishaps", stage.person.mishaps());
    assert!(session.count("@refused") >= 2, "{} refusals", session.count("@refused"));
    assert!(session.is_accepted(), "{}: {:?}", session.verdict, session.reasons);
    assert!(session.stored);
    assert_eq!(session.missing(), Some(0.0));
}
