//! One of every message, in every shape that it can take.

use super::*;
use crate::command::{CalAction, WORDS};
use crate::record::RecordError;
use crate::setup::{BoxFaces, Setup};

const SETUP: Setup = Setup { stops: TurnStops::Fenced, box_faces: BoxFaces::Square, scheme: Scheme::Double };

pub(super) fn hello(calibration: CalibrationState) -> Hello {
    let (firmware, board, sensor) = ("0.1.0", "Black Pill F411", "MPU9250");
    Hello { firmware, board, sensor, whoami: 0x71, reset: "power", calibration }
}

pub(super) fn reasons() -> Vec<Reason> {
    std::vec![
        Reason::FacesMissing { missing: FaceSet::EMPTY.with(Face::PlusX).with(Face::MinusZ) },
        Reason::TurnsMissing { axes: 0b101 },
        Reason::Clipped { channel: 2, samples: 12 },
        Reason::Clipped { channel: 4, samples: 1 },
        Reason::OutOfRange { name: "accel_bias_z", value: 3.5, limit: 1.0 },
        Reason::PoorFit { nis_per_dof: 9.3 },
        Reason::Unsettled { sigmas: 27.0 },
        Reason::NotObservable { name: "gyro_correction_xy" },
        Reason::Uncertain { name: "gyro_correction_zz", sigma: 2e-3, limit: 1e-3 },
        Reason::BiasDrift { axis: 1, drift_rad_s: 0.001 },
        Reason::BiasJump { axis: 2, jump_rad_s: -0.02 },
        Reason::CrookedBox { facet_rad: 0.008 },
        Reason::LooseContact { lean_rad: 0.003 },
        Reason::SegmentExcluded { segment: 7, nis_per_dof: 40.0 },
        Reason::SamplesLost { samples: 3 },
        Reason::Arithmetic { place: "update" },
    ]
}

fn asks() -> Vec<Ask> {
    let turn = |face, direction, stops| Ask::Turn { face, direction, stops };
    std::vec![
        Ask::Place { missing: FaceSet::FULL },
        Ask::Place { missing: FaceSet::EMPTY.with(Face::MinusX) },
        Ask::Place { missing: FaceSet::EMPTY },
        Ask::Hold { face: Some(Face::PlusX), seconds: 2.44 },
        Ask::Hold { face: None, seconds: 2.0 },
        turn(Face::PlusX, Some(Direction::Ccw), TurnStops::ByHand),
        turn(Face::MinusY, Some(Direction::Cw), TurnStops::Fenced),
        turn(Face::PlusZ, None, TurnStops::Fenced),
        Ask::Still { why: Unrest::Bumped { face: Face::PlusX } },
        Ask::Still { why: Unrest::Moving { excess: 1.3 } },
        Ask::Still { why: Unrest::Oblique },
        Ask::Pose { done: 2, of: 6 },
        Ask::Word { choice: Choice::FullEnough },
        Ask::Word { choice: Choice::FullShort },
        Ask::Word { choice: Choice::Rejected(Some(Face::PlusY)) },
        Ask::Word { choice: Choice::Rejected(None) },
        Ask::Word { choice: Choice::NotStored },
    ]
}

pub(super) fn troubles() -> Vec<Trouble> {
    let wrong = |line: &str| match Command::parse(line) {
        Some(Err(error)) => Trouble::Word(error),
        other => panic!("{other:?}"),
    };
    std::vec![
        wrong("calibrte"),
        wrong("stream rw"),
        Trouble::NotNow { command: Command::Finish, why: "No session is running." },
        Trouble::NoCalibration,
        Trouble::SensorMissing { whoami: 0xff },
        Trouble::SensorForeign { whoami: 0xea },
        Trouble::DataReadyStuck { waited_ms: 100 },
        Trouble::Bus { doing: "reading a sample" },
        Trouble::Register { address: 0x1a, wrote: 3, read: 0 },
        Trouble::Flash { doing: "erasing a sector" },
        Trouble::Record(RecordError::Newer { version: 2 }),
        Trouble::Record(RecordError::Truncated { expected: 12, found: 3 }),
        Trouble::MemoryFull,
    ]
}

fn notes() -> Vec<Note> {
    std::vec![
        Note::Started(SETUP),
        Note::Restarted(Setup { scheme: Scheme::Single, ..Setup::default() }),
        Note::Forgotten { face: Face::PlusX },
        Note::Cancelled,
        Note::VerifyCancelled,
        Note::MinimumReached,
        Note::Waiting { minutes: 5 },
        Note::SuggestVerify,
        Note::VerifyStarted,
    ]
}

fn judged() -> Vec<Message> {
    let turn = |angle_rad, why| Message::Refused(Refused::Turn { face: Face::PlusX, angle_rad, why });
    let face = Face::PlusX;
    let mut all = std::vec![
        Message::Accepted(Accepted::Still { face, held_s: 3.1 }),
        Message::Accepted(Accepted::Turn { face, direction: Direction::Cw, angle_rad: -6.3 }),
        Message::Refused(Refused::Hold { face, held_s: 1.2, needed_s: 3.0 }),
        Message::Refused(Refused::Face { face }),
        Message::Refused(Refused::Finish { faces: FaceSet::EMPTY.with(face), axes: 0b110 }),
        Message::Refused(Refused::Finish { faces: FaceSet::EMPTY, axes: 1 }),
        Message::Refused(Refused::Pose),
        turn(Some(4.735), RefusedTurn::Open),
        turn(None, RefusedTurn::NoNet),
        turn(None, RefusedTurn::Lifted),
        turn(Some(-6.3), RefusedTurn::NoRest),
        turn(Some(6.3), RefusedTurn::Again),
        Message::Progress(Progress { coverage: Coverage::default(), scheme: Scheme::Double }),
    ];
    for verdict in [Verdict::Accepted, Verdict::AcceptedWithWarnings, Verdict::Rejected] {
        all.extend([0, 3].map(|reasons| Message::Result { verdict, reasons }));
    }
    all
}

fn checked() -> Vec<Message> {
    let pose = PoseCheck {
        number: 3,
        fresh: true,
        gravity_error_mps2: 0.0118,
        gravity_limit_mps2: 0.02,
        level_error_rad: Some(0.001_75),
        level_limit_rad: 0.002,
    };
    let verified = |pass, change| {
        let (poses, gravity_rms_mps2, level_max_rad) = (6, 0.008_83, 0.003_49);
        Message::Verified(Verification {
            pass,
            poses,
            gravity_rms_mps2,
            level_max_rad,
            temperature_change_degc: change,
        })
    };
    std::vec![
        Message::Pose(pose),
        Message::Pose(PoseCheck { level_error_rad: None, gravity_error_mps2: -0.5, ..pose }),
        verified(true, Some(0.2)),
        verified(false, None),
        verified(false, Some(-9.0)),
        Message::SelfTest { axis: "gyro_x", response: 1.02, ok: true },
        Message::SelfTest { axis: "accel_z", response: 0.2, ok: false },
    ]
}

fn told() -> Vec<Message> {
    use CalibrationState as State;
    let hellos = [State::None, State::Stored, State::Unreadable, State::OtherSensor].map(hello);
    let (rate_hz, ranges, sensor) = (200.04, Ranges::WIDEST, "MPU9250");
    let info = Info {
        hello: hellos[1],
        ranges,
        rate_hz,
        samples: 200_000,
        overruns: 0,
        sample_errors: 1,
        uptime_us: 1_000_123_456,
    };
    let parameter =
        |observable, sigma| Parameter { name: "accel_bias_x", value: 0.1, sigma, unit: "m/s^2", observable };
    let mut all: Vec<Message> = hellos.map(Message::Hello).into();
    all.extend([
        Message::Info(info),
        Message::Counter { name: "stack_free", value: 12_345 },
        Message::Ok(Command::Cal(CalAction::Show)),
        Message::Busy { task: Task::Estimate, percent: 40 },
        Message::Busy { task: Task::Store, percent: 0 },
        Message::Param(parameter(true, Some(1.5e-4))),
        Message::Param(parameter(false, Some(1.5e-4))),
        Message::Param(parameter(true, None)),
        Message::Stored { generation: 3, bytes: 260 },
        Message::Erased,
        Message::Recording(Recording { sensor, rate_hz, ranges, setup: SETUP }),
    ]);
    let kinds = [StreamKind::Raw, StreamKind::Cal, StreamKind::Off];
    all.extend(kinds.map(|kind| Message::Stream(Streaming { kind, rate_hz, ranges })));
    all.extend(WORDS.iter().map(Message::Help));
    all
}

pub(super) fn all() -> Vec<Message> {
    let mut all = told();
    all.extend(reasons().into_iter().map(Message::Reason));
    all.extend(asks().into_iter().map(Message::Ask));
    all.extend(troubles().into_iter().map(Message::Error));
    all.extend(notes().into_iter().map(Message::Note));
    all.extend(judged());
    all.extend(checked());
    all
}
