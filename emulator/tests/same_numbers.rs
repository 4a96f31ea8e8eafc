//! The device path on the microcontroller and on the host are one arithmetic: from the very samples that the board had, the
//! host's tool computes the very numbers that the board said, bit for bit.

#[path = "common/firmware.rs"]
mod firmware;

use std::path::Path;

use emulator::story::narrator::Telling;
use emulator::story::stage::{Cast, Stage};
use emulator::story::{acts, host_path, replay};
use tumble::recording::{BoxFaces, TurnStops};
use tumble_core::estimate::Conditions;
use tumble_sim::PersonConfig;

#[test]
fn board_and_host_compute_the_same() {
    let mut cast = Cast::new(31, false);
    cast.person = PersonConfig { start_words: None, turn_s: (4.0, 5.0), move_s: (1.5, 2.0), ..cast.person };
    let mut stage = Stage::new(firmware::elf(), &cast).expect("it starts");
    acts::boot(&mut stage).expect("it says hello");
    stage.ask("stream raw", &["@stream kind=raw"], 10.0).expect("it streams");
    let from = stage.lines.len();
    let now_s = stage.now_s();
    stage.person.instruct(now_s, "calibrate fenced square single");
    let session = acts::calibrate(&mut stage, from).expect("it ends");
    assert!(session.is_accepted(), "{}: {:?}", session.verdict, session.reasons);
    let frames = host_path::session_frames(&session.lines, &stage.frames).expect("every sample was streamed");
    assert!(frames.len() > 10_000, "{}", frames.len());
    let conditions = Conditions { stops: TurnStops::Fenced, faces: BoxFaces::Square, ..Conditions::CAUTIOUS };
    assert_eq!(host_path::compute(&frames, conditions).expect("numbers"), session.parameters);
}

#[test]
fn a_real_recording_gives_the_same_on_both() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/recordings/imucal_ferraris_session.csv");
    if !file.exists() {
        println!("skipped: {} is not here", file.display());
        return;
    }
    let replayed = replay::replay(firmware::elf(), &file, Telling::Nothing).expect("a verdict");
    assert!(replayed.is_accepted(), "{}: {:?}", replayed.verdict, replayed.reasons);
    assert_eq!(replayed.same_on_host, Some(true));
    // Published: each turn is 360°, and the raw integrals are 369.97, 353.69 and 359.33°.
    for (axis, published) in [("xx", 0.9730), ("yy", 1.0178), ("zz", 1.0019)] {
        let name = format!("gyro_correction_{axis}");
        let value = replayed.parameters.get(&name).and_then(|parameter| parameter.value).expect("observable");
        assert!((f64::from(value) - published).abs() < 0.005, "{name} = {value}, published {published}");
    }
}
