//! The serial commands against a board that is a thread at the other end of a pseudo-terminal.
#![cfg(unix)]

use std::io::{Read, Write};
use std::thread::JoinHandle;
use std::time::Duration;

use serialport::{SerialPort, TTYPort};
use tumble::recording::{BoxFaces, Recording, TurnStops};
use tumble::serial::{Capture, SerialError, record, verify};
use tumble_core::frame::RawFrame;
use tumble_core::sample::Counts;

const METADATA: &str = "@recording sensor=MPU-9250 rate_hz=200.00 gyro_range_dps=2000 accel_range_g=16 gravity_mps2=9.80665 turns=by-hand box=unknown\r\n";

fn frame(seq: u32) -> String {
    let counts = Counts { gyro: [100, -200, 300], accel: [0, 1, 2048], temperature: 1000 };
    RawFrame { seq, t_us: 7_000_000 + u64::from(seq) * 5000, counts }.line().to_string()
}

/// Both ends of a line; the board's answers what it is told once it has heard a line.
fn board(answer: String) -> (TTYPort, JoinHandle<String>) {
    let (mut board, host) = TTYPort::pair().expect("the system has pseudo-terminals");
    board.set_timeout(Duration::from_secs(5)).expect("it takes a time-out");
    let thread = std::thread::spawn(move || {
        let mut heard = Vec::new();
        let mut byte = [0];
        while !heard.ends_with(b"\n") && board.read_exact(&mut byte).is_ok() {
            heard.push(byte[0]);
        }
        board.write_all(answer.as_bytes()).expect("the host reads");
        // Keeps the line open until the host is through, which says "stream off" or hangs up.
        let mut rest = [0; 64];
        let _ = board.read(&mut rest);
        String::from_utf8_lossy(&heard).trim_end().to_owned()
    });
    (host, thread)
}

fn host_end(mut host: TTYPort) -> TTYPort {
    host.set_timeout(Duration::from_millis(50)).expect("it takes a time-out");
    host
}

#[test]
fn a_recording_is_written_that_the_reader_takes() {
    let damaged = frame(3).replace("300", "301");
    let answer =
        ["@ok command=record\r\n", METADATA, "Recording: it goes on.\r\n", &frame(1), &frame(2), &damaged, &frame(6)]
            .concat();
    let (host, board) = board(answer);
    let mut csv = Vec::new();
    let amend = |metadata: &mut tumble::recording::Metadata| metadata.turns = Some(TurnStops::Fenced);
    let capture = record(host_end(host), &mut csv, amend, |capture| capture.samples == 3).expect("it works");
    assert_eq!(board.join().expect("no panic"), "record");
    assert_eq!((capture.samples, capture.lost, capture.damaged), (3, 3, 1));
    let recording = Recording::from_bytes(&csv, "rec.csv").expect("the contract's format");
    assert_eq!(recording.metadata.turns, Some(TurnStops::Fenced));
    assert_eq!(recording.metadata.box_faces, Some(BoxFaces::Unknown));
    let row = recording.rows[2];
    assert_eq!((row.t_s, row.accel_g[2], row.gyro_dps[0]), (0.025, 1.0, 100.0 * 2000.0 / 32768.0));
    assert!((row.temp_c.expect("the board has one") - 23.995).abs() < 1e-3);
}

#[test]
fn a_silent_or_refusing_or_restarting_board_is_an_error() {
    let mut csv = Vec::new();
    let (host, _board) = board("@error code=3 thing=sensor detail=stuck\r\n".into());
    let refused = record(host_end(host), &mut csv, |_| {}, |_| false).expect_err("it was refused");
    assert!(matches!(&refused, SerialError::Refused(line) if line.contains("stuck")), "{refused}");
    let (host, _board) = board("hello?\r\n".into());
    let silent = record(host_end(host), &mut csv, |_| {}, |_| false).expect_err("nothing came");
    assert!(silent.to_string().contains("Remedy"), "{silent}");
    assert!(csv.is_empty());

    let mut capture = Capture::default();
    for line in [METADATA, &frame(10)] {
        capture.take(line).expect("fine so far");
    }
    assert!(matches!(capture.take(&frame(2)), Err(SerialError::Restarted)));
}

#[test]
fn frames_before_the_ranges_are_known_are_not_samples() {
    let mut capture = Capture::default();
    assert!(capture.take(&frame(1)).expect("no error").is_none());
    assert_eq!(capture.samples, 0);
}

#[test]
fn verify_passes_sentences_on_and_ends_with_the_verdict() {
    for (verdict, passed) in [("pass", true), ("fail", false)] {
        let answer =
            format!("@ask want=pose done=0 of=6\r\nPut it down somehow.\r\n@verified verdict={verdict} poses=6\r\n");
        let (host, board) = board(answer);
        let mut told = Vec::new();
        let verified = verify(host_end(host), |line| told.push(line.to_owned())).expect("it works");
        assert_eq!((verified.passed, told), (passed, vec!["Put it down somehow.".to_owned()]));
        assert_eq!(board.join().expect("no panic"), "verify");
    }
}
