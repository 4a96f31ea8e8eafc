//! Every message is written both ways, in ASCII, and says what the protocol and a person need.

extern crate std;
use std::string::{String, ToString};
use std::vec::Vec;

mod every;

use super::*;
use crate::command::StreamKind;
use crate::face::{Face, FaceSet};
use crate::procedure::{Coverage, Direction, Scheme, TurnStops};
use crate::sample::Ranges;
use every::{all, hello, reasons, troubles};

fn machine(message: &Message) -> String {
    let mut text = String::new();
    message.machine(&mut text).expect("a String takes all");
    text
}

fn human(message: &Message) -> String {
    let mut text = String::new();
    message.human(&mut text).expect("a String takes all");
    text
}

#[test]
fn every_message_is_a_line_for_a_program_and_a_sentence_for_a_person() {
    for message in all() {
        let mut text = String::new();
        message.write_to(&mut text).expect("a String takes all");
        let lines: Vec<&str> = text.split("\r\n").collect();
        assert!(lines.len() == 3 && lines[2].is_empty() && text.is_ascii(), "{text:?}");
        // A program may count on 512 bytes a line, a person on two lines of a terminal or three.
        assert!(lines[0].len() < 512 && lines[1].len() < 400, "{text}");
        let line = Line::parse(lines[0]).expect("a machine line");
        let spelt: String = line.pairs().map(|(key, value)| std::format!(" {key}={value}")).collect();
        assert_eq!(lines[0], std::format!("@{}{spelt}", line.word));
        assert!(line.pairs().all(|(_, value)| !value.is_empty()), "{text}");
        assert!(!lines[1].starts_with('@') && !lines[1].contains("  ") | lines[1].starts_with("  "), "{text}");
    }
}

#[test]
fn the_protocol_is_kept_to_the_letter() {
    let turn = Ask::Turn { face: Face::PlusX, direction: Some(Direction::Ccw), stops: TurnStops::ByHand };
    for (message, line) in [
        (
            Message::Hello(hello(CalibrationState::Stored)),
            "@hello firmware=0.1.0 board=Black_Pill_F411 sensor=MPU9250 whoami=0x71 reset=power calibration=stored",
        ),
        (Message::Ask(Ask::Place { missing: FaceSet::FULL }), "@ask want=place faces=+x,+y,-x,+z,-y,-z"),
        (Message::Ask(Ask::Hold { face: Some(Face::PlusX), seconds: 2.4 }), "@ask want=hold face=+x seconds=2.4"),
        (Message::Ask(turn), "@ask want=turn face=+x direction=ccw"),
        (Message::Ask(Ask::Pose { done: 2, of: 6 }), "@ask want=pose done=2 of=6"),
        (
            Message::Accepted(Accepted::Turn { face: Face::PlusX, direction: Direction::Cw, angle_rad: -6.280_04 }),
            "@accepted what=turn face=+x direction=cw angle_deg=359.82",
        ),
        (
            Message::Progress(Progress { coverage: Coverage::default(), scheme: Scheme::Single }),
            "@progress faces=- turns=- missing=12 minimum=no",
        ),
        (Message::Error(Trouble::MemoryFull), "@error code=6 thing=memory detail=session_memory_full"),
        (Message::Stored { generation: 3, bytes: 512 }, "@stored generation=3 bytes=512"),
        (Message::SelfTest { axis: "gyro_x", response: 1.02, ok: true }, "@selftest axis=gyro_x response=1.020 ok=yes"),
        (
            Message::Stream(Streaming { kind: StreamKind::Raw, rate_hz: 200.0, ranges: Ranges::WIDEST }),
            "@stream kind=raw rate_hz=200.00 gyro_lsb_dps=0.061035156 accel_lsb_g=0.00048828125",
        ),
    ] {
        assert_eq!(machine(&message), line);
    }
}

#[test]
fn parameters_come_back_exactly_and_what_is_not_observable_has_no_number() {
    let mut bits = 0x9e37_79b9_u32;
    for _ in 0..20_000 {
        bits ^= bits << 13;
        bits ^= bits >> 17;
        bits ^= bits << 5;
        let value = f32::from_bits(bits);
        if !value.is_finite() {
            continue;
        }
        let sigma = Some(value.abs());
        let parameter = Parameter { name: "gyro_bias_x", value, sigma, unit: "rad/s", observable: true };
        let text = machine(&Message::Param(parameter));
        let line = Line::parse(&text).expect("a machine line");
        assert_eq!((line.number("value"), line.number("sigma")), (Some(value), sigma), "{text}");
        let hidden = machine(&Message::Param(Parameter { observable: false, ..parameter }));
        assert_eq!(hidden, "@param name=gyro_bias_x value=- sigma=- unit=rad/s observable=no");
    }
}

#[test]
fn sentences_name_the_thing_the_place_and_the_remedy() {
    let turn = Ask::Turn { face: Face::MinusY, direction: Some(Direction::Cw), stops: TurnStops::Fenced };
    let refused = Refused::Turn { face: Face::PlusX, angle_rad: Some(4.735), why: RefusedTurn::Open };
    for (message, parts) in [
        (
            Message::Ask(Ask::Place { missing: FaceSet::FULL }),
            &["the x arrow pointing up", "face +x", "+y, -x, +z, -y or -z"][..],
        ),
        (Message::Ask(turn), &["Face -y", "the y arrow pointing down", "clockwise", "against its stop", "let go"]),
        (Message::Refused(refused), &["Face +x", "271 degrees counter-clockwise", "Turn it on"]),
        (Message::Error(Trouble::DataReadyStuck { waited_ms: 100 }), &["INT", "PB0", "100 ms"]),
        (Message::Error(Trouble::SensorMissing { whoami: 0xff }), &["No sensor", "0xff", "PA4"]),
        (
            Message::Reason(Reason::Clipped { channel: 2, samples: 12 }),
            &["gyroscope's z axis", "12 samples", "more slowly"],
        ),
    ] {
        let sentence = human(&message);
        assert!(parts.iter().all(|part| sentence.contains(part)), "{sentence}");
    }
}

#[test]
fn every_error_code_is_the_leds_and_every_reason_has_a_remedy() {
    assert!(troubles().iter().all(|trouble| trouble.code() <= 6));
    for reason in reasons() {
        assert!(reason.to_string().matches(". ").count() >= 1, "what, then what to do: {reason}");
    }
    let faces: Vec<Option<Face>> = reasons().iter().map(Reason::face_to_redo).collect();
    let (x, y, z) = (Some(Face::PlusX), Some(Face::PlusY), Some(Face::PlusZ));
    assert_eq!(faces, [x, x, z, y, z, None, None, y, z, None, None, None, None, None, None, None]);
}

#[test]
fn lines_are_read_and_anything_else_is_not() {
    let line = Line::parse("@ask want=place faces=+x,-y,? empty=-\r\n").expect("a machine line");
    assert_eq!((line.word, line.get("want"), line.get("empty"), line.get("none")), ("ask", Some("place"), None, None));
    assert_eq!(line.faces("faces").collect::<Vec<_>>(), [Face::PlusX, Face::MinusY]);
    assert_eq!((line.face("faces"), line.number::<f32>("want")), (None, None));
    for no in ["", "@", "@ x=1", "hello", "R,1,2*00"] {
        assert_eq!(Line::parse(no), None, "{no}");
    }
}
