//! The power fails while the product's firmware writes its flash. Afterwards the old record is found or the new one, whole,
//! and never anything else.

#[path = "common/firmware.rs"]
mod firmware;

use std::sync::OnceLock;

use emulator::story::acts;
use emulator::story::parameters::Parameters;
use emulator::story::stage::{Cast, Stage};
use emulator::{SensorFault, Stopped};
use tumble_sim::PersonConfig;

/// One turn on each face, briskly.
fn brisk(seed: u64) -> Cast {
    let mut cast = Cast::new(seed, false);
    let start_words = Some("calibrate fenced square single".to_owned());
    cast.person = PersonConfig { start_words, turn_s: (4.0, 5.0), move_s: (1.5, 2.0), ..cast.person };
    cast
}

/// What a calibration left: the flash, what it exports, and how many flash operations it took.
struct Calibrated {
    flash: Vec<u8>,
    exported: Parameters,
    operations: u64,
}

fn calibrate(stage: &mut Stage) -> Calibrated {
    let session = acts::calibrate(stage, 0).expect("it ends");
    assert!(session.stored, "{}: {:?}", session.verdict, session.reasons);
    let operations = stage.board.flash_operations().0;
    Calibrated { flash: stage.board.flash(), exported: session.parameters, operations }
}

fn first() -> &'static Calibrated {
    static ONCE: OnceLock<Calibrated> = OnceLock::new();
    ONCE.get_or_init(|| calibrate(&mut Stage::new(firmware::elf(), &brisk(21)).expect("it starts")))
}

/// Another over the first. The emulated board does the same whenever it is asked the same, so this is what a cut one
/// would have become.
fn second() -> &'static Calibrated {
    static ONCE: OnceLock<Calibrated> = OnceLock::new();
    ONCE.get_or_init(|| calibrate(&mut stage_with(&first().flash, brisk(22))))
}

fn stage_with(flash: &[u8], mut cast: Cast) -> Stage {
    cast.options.flash = Some(flash.to_vec());
    Stage::new(firmware::elf(), &cast).expect("it starts")
}

fn run_to_the_cut(stage: &mut Stage, at_most_s: f64) {
    let end_s = stage.now_s() + at_most_s;
    while stage.now_s() < end_s {
        if stage.step().expect("it runs") == Stopped::PowerCut {
            return;
        }
    }
    panic!("no flash operation was cut within {at_most_s} s");
}

/// What the board knows after the power has come back.
fn after_the_cut(stage: &mut Stage) -> (String, Parameters) {
    stage.power_cycle(1.0).expect("the power comes back");
    let hello = acts::boot(stage).expect("it starts");
    let state = hello.value("calibration").unwrap_or("none").to_owned();
    let exported = acts::export(stage).expect("it answers");
    (state, exported)
}

/// The second calibration, cut in its `k`th flash operation.
fn second_calibration_cut(k: u64) {
    let mut stage = stage_with(&first().flash, brisk(22));
    stage.board.power_cut_at_flash_op(k);
    run_to_the_cut(&mut stage, 400.0);
    let (state, found) = after_the_cut(&mut stage);
    assert_eq!(state, "stored", "cut at operation {k}");
    assert!(found == first().exported || found == second().exported, "cut at operation {k}: {found:?}");
}

#[test]
fn a_store_cut_at_its_first_operation_leaves_a_whole_record() {
    second_calibration_cut(0);
}

#[test]
fn a_store_cut_in_its_middle_leaves_a_whole_record() {
    second_calibration_cut(second().operations / 2);
}

#[test]
fn a_store_cut_at_its_last_operation_leaves_a_whole_record() {
    second_calibration_cut(second().operations - 1);
}

/// A sensor of another kind in the same board: the old one's calibration is kept, and not used until that is back.
#[test]
fn a_calibration_of_another_sensor_is_kept_and_not_used() {
    let mut cast = brisk(24);
    cast.person.start_words = None;
    let mut stage = stage_with(&first().flash, cast);
    stage.board.inject_fault(Some(SensorFault::Foreign { who_am_i: 0x73 }));
    let (state, found) = after_the_cut(&mut stage);
    assert_eq!((state.as_str(), found.0.is_empty()), ("other_sensor", true));
    stage.board.inject_fault(None);
    assert_eq!(after_the_cut(&mut stage), ("stored".to_owned(), first().exported.clone()));
}

/// The same for the word that forgets a calibration: it is there whole or it is gone.
#[test]
fn forgetting_cut_anywhere_leaves_all_or_nothing() {
    let quiet = || {
        let mut cast = brisk(23);
        cast.person.start_words = None;
        stage_with(&first().flash, cast)
    };
    for k in 0..64 {
        let mut stage = quiet();
        acts::boot(&mut stage).expect("it starts");
        let from = stage.lines.len();
        stage.board.power_cut_at_flash_op(k);
        stage.board.serial_write(b"cal reset\r\n");
        let mut cut = false;
        for _ in 0..200 {
            cut |= stage.step().expect("it runs") == Stopped::PowerCut;
            if cut || stage.lines[from..].iter().any(|line| line.says("@erased")) {
                break;
            }
        }
        if !cut {
            assert!(k > 0, "nothing was written");
            assert_eq!(after_the_cut(&mut stage), ("none".to_owned(), Parameters::default()));
            return;
        }
        let (state, found) = after_the_cut(&mut stage);
        match state.as_str() {
            "stored" => assert_eq!(found, first().exported, "cut at operation {k}"),
            "none" => assert!(found.0.is_empty(), "cut at operation {k}"),
            other => panic!("cut at operation {k}: calibration={other}"),
        }
    }
    panic!("forgetting takes more than 64 operations");
}
