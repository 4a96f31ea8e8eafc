//! What goes wrong around the product's firmware: the sensor, the words, the program itself. It says what and how to
//! cure it, keeps its flash, and goes on when the fault has gone.

#[path = "common/firmware.rs"]
mod firmware;

use emulator::story::acts;
use emulator::story::stage::{Cast, Stage};
use emulator::{BoardOptions, SensorFault};

/// A board with a fault, and nobody who types of itself.
fn stage(fault: Option<SensorFault>) -> Stage {
    let mut cast = Cast::new(1, false);
    cast.person.start_words = None;
    cast.options = BoardOptions { sensor_fault: fault, ..cast.options };
    Stage::new(firmware::elf(), &cast).expect("it starts")
}

fn blinks(stage: &Stage, count: u8) -> bool {
    stage.notes.iter().any(|note| note.text == format!("the LED blinks {count} times"))
}

/// Sensor faults from the start: named at once with a remedy, shown by the LED, `calibrate` refused, other words answered,
/// flash untouched, and cured as soon as the sensor is.
fn told_and_cured(fault: SensorFault, code: u8, thing: &str) {
    let mut stage = stage(Some(fault));
    let hello = acts::boot(&mut stage).expect("it says hello even so");
    assert_eq!(hello.value("calibration"), Some("none"), "{}", hello.text);
    let error = format!("@error code={code} thing={thing}");
    let at = stage.until(0, &[&error], 3.0).expect("it says what is wrong");
    stage.run_for(0.1).expect("it runs");
    let remedy = stage.lines[at + 1].text.clone();
    assert!(!remedy.starts_with('@') && remedy.len() > 40, "a sentence with the remedy: {remedy:?}");
    let from = stage.ask("calibrate", &["@error", "@ok"], 10.0).expect("it answers");
    let answer = stage.lines[from..].iter().find(|line| line.says("@error") || line.says("@ok"));
    assert!(answer.is_some_and(|line| line.says(&error)), "no session without a sensor: {answer:?}");
    stage.ask("help", &["@ok command=help"], 10.0).expect("other words are answered");
    stage.run_for(12.0).expect("it runs");
    assert!(blinks(&stage, code), "the LED shows {code}: {:?}", stage.notes);
    assert_eq!(stage.board.flash_operations(), (0, 0));
    assert!(stage.board.resets().is_empty(), "{:?}", stage.board.resets());

    stage.board.inject_fault(None);
    stage.run_for(3.0).expect("it runs");
    let now_s = stage.now_s();
    stage.person.instruct(now_s, "calibrate fenced square");
    let from = stage.lines.len();
    stage.until(from, &["@ok command=calibrate"], 10.0).expect("cured, it calibrates");
    let from = stage.lines.len();
    stage.until(from, &["@accepted what=still"], 30.0).expect("and samples");
}

#[test]
fn a_missing_sensor_is_told_and_cured() {
    told_and_cured(SensorFault::Missing { miso_high: true }, 1, "sensor");
}

#[test]
fn a_sensor_without_power_is_told_and_cured() {
    told_and_cured(SensorFault::Missing { miso_high: false }, 1, "sensor");
}

#[test]
fn a_foreign_sensor_is_told_and_cured() {
    told_and_cured(SensorFault::Foreign { who_am_i: 0x68 }, 2, "sensor");
}

#[test]
fn a_stuck_data_ready_line_is_told_and_cured() {
    told_and_cured(SensorFault::DataReadyStuck, 3, "data_ready");
}

/// A sensor that begins to fail in mid-session: told within two seconds, and the session goes on with what it had.
fn told_in_mid_session(fault: SensorFault, codes: &[&str]) {
    let mut stage = stage(None);
    acts::boot(&mut stage).expect("it says hello");
    stage.ask("calibrate fenced square", &["@ok command=calibrate"], 10.0).expect("it starts");
    stage.until(0, &["@accepted what=still"], 30.0).expect("a first rest");
    let from = stage.lines.len();
    stage.board.inject_fault(Some(fault));
    stage.until(from, codes, 2.0).expect("it says what is wrong");
    stage.run_for(3.0).expect("it runs");
    stage.board.inject_fault(None);
    let from = stage.lines.len();
    stage.until(from, &["@accepted"], 90.0).expect("it goes on with what is missing");
    assert!(stage.board.resets().is_empty(), "{:?}", stage.board.resets());
    assert_eq!(stage.board.flash_operations(), (0, 0));
}

#[test]
fn garbage_on_the_bus_is_told_and_survived() {
    told_in_mid_session(SensorFault::Garbage { from_s: 0.0 }, &["@error code=4", "@error code=1", "@error code=2"]);
}

#[test]
fn a_sensor_lost_in_mid_session_is_told_and_survived() {
    told_in_mid_session(SensorFault::Lost { from_s: 0.0, miso_high: false }, &["@error code=1", "@error code=4"]);
}

#[test]
fn wrong_words_are_named_with_the_right_ones() {
    let mut stage = stage(None);
    acts::boot(&mut stage).expect("it says hello");
    for word in
        ["dance", "calibrate upside-down", "finish", "redo +w", "cal", "stream cal", "verify", "calibrate x y z"]
    {
        let from = stage.ask(word, &["@error code=0", "@ok"], 10.0).expect("an answer");
        stage.run_for(0.1).expect("it runs");
        let error = stage.lines[from..].iter().position(|line| line.says("@error code=0"));
        let error = from + error.unwrap_or_else(|| panic!("{word} was understood"));
        assert!(stage.lines[error + 1].text.len() > 20, "a sentence: {:?}", stage.lines[error + 1].text);
    }
    let noise: Vec<u8> = (0..3000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    stage.board.serial_write(&noise);
    stage.run_for(0.5).expect("it runs");
    stage.board.serial_write(b"\x03\r\n");
    stage.run_for(0.5).expect("it runs");
    stage.ask("info", &["@ok command=info"], 10.0).expect("it listens still");
    assert!(stage.board.resets().is_empty(), "{:?}", stage.board.resets());
    assert_eq!(stage.board.flash_operations(), (0, 0));
}

/// A stack that grows too far meets nothing that it could overwrite.
#[test]
fn below_the_stack_there_is_no_memory() {
    let mut stage = stage(None);
    acts::boot(&mut stage).expect("it says hello");
    let end = stage.board.symbol("_stack_end").expect("memory.x's symbol");
    let (used, size) = stage.board.stack_high_water().expect("memory.x's symbols");
    assert!((1000..size).contains(&used) && stage.board.read_memory(end, 4).is_some(), "{used} of {size}");
    assert_eq!(stage.board.read_memory(end - 4, 4), None);
}

/// The program runs astray (its stack is overwritten): the watchdog starts it anew, and it says so.
#[test]
fn a_program_run_astray_is_started_anew() {
    let mut stage = stage(None);
    acts::boot(&mut stage).expect("it says hello");
    stage.run_for(1.0).expect("it runs");
    let top = stage.board.symbol("_stack_start").expect("cortex-m-rt's symbol");
    assert!(stage.board.write_memory(top - 4096, vec![0xDEAD_BEEF; 1024]));
    let from = stage.lines.len();
    let at = stage.until(from, &["@hello"], 30.0).expect("it starts again");
    let hello = &stage.lines[at];
    assert!(matches!(hello.value("reset"), Some("watchdog" | "software")), "{}", hello.text);
    assert_eq!(stage.board.resets().len(), 1, "{:?}", stage.board.resets());
    let info = acts::info(&mut stage).expect("it answers");
    let samples = info.iter().find(|(key, _)| key == "samples").and_then(|(_, value)| value.parse().ok());
    assert!(samples.is_some_and(|samples: u32| samples > 10), "it samples again: {info:?}");
}
