//! The device path on the microcontroller and on the host are one arithmetic: from the very samples that the board had, the
//! host's tool computes the very numbers that the board said.

#[path = "common/firmware.rs"]
mod firmware;

use emulator::story::acts;
use emulator::story::parameters::Parameter;
use emulator::story::stage::{Cast, Stage};
use tumble::calibrate::Session;
use tumble::recording::{BoxFaces, Reading, TurnStops};
use tumble_core::estimate::Conditions;
use tumble_core::sample::Ranges;
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

    // Frames and lines come from one task in one order, so these are the session's samples.
    let place = |pattern: &str| session.lines.iter().find(|line| line.says(pattern)).map(|line| line.after_raw_frames);
    let first = place("@ok command=calibrate").expect("it began");
    let end = place("@busy what=estimate").expect("it computed");
    assert_eq!(stage.frames.damaged, Vec::<String>::new());
    let frames: Vec<_> = stage.frames.raw[first..end].iter().map(|(_, frame)| frame).collect();
    assert!(frames.windows(2).all(|pair| pair[1].seq == pair[0].seq + 1), "a frame is missing");
    let readings: Vec<Reading> = frames
        .iter()
        .map(|frame| Reading {
            sample: Ranges::WIDEST.to_si(frame.t_us, &frame.counts),
            clipped: frame.counts.clipped(),
        })
        .collect();
    assert!(readings.len() > 10_000, "{}", readings.len());
    let conditions = Conditions { stops: TurnStops::Fenced, faces: BoxFaces::Square, ..Conditions::CAUTIOUS };
    let host = Session { readings: &readings, origin_s: 0.0, lost: 0, conditions }.replay(&mut |_| {});
    let calibration = host.calibration.expect("numbers");
    for parameter in calibration.parameters() {
        let said = session.parameters.get(parameter.name).expect("the board said it");
        let computed = Parameter {
            name: parameter.name.to_owned(),
            value: parameter.observable.then_some(parameter.value),
            sigma: parameter.sigma.filter(|_| parameter.observable),
            unit: parameter.unit.to_owned(),
            observable: parameter.observable,
        };
        assert_eq!(*said, computed);
    }
}
