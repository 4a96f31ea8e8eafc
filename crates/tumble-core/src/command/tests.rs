//! Every word, every way to get one wrong, and bytes of any kind.

extern crate std;
use std::string::{String, ToString};
use std::vec::Vec;

use super::*;

fn read(bytes: &[u8]) -> Vec<Result<Command, CommandError>> {
    let mut editor = LineEditor::<32>::new();
    bytes.iter().filter_map(|byte| editor.push(*byte)).collect()
}

fn said(line: &str) -> String {
    Command::parse(line).expect("not empty").expect_err("wrong").to_string()
}

#[test]
fn every_word_is_understood() {
    let by_hand = Setup::default();
    let fenced = Setup { stops: TurnStops::Fenced, box_faces: BoxFaces::Square, ..by_hand };
    let table = [
        ("help", Command::Help),
        ("INFO", Command::Info),
        ("calibrate", Command::Calibrate(by_hand)),
        ("calibrate fenced square", Command::Calibrate(fenced)),
        ("Calibrate SQUARE\tfenced", Command::Calibrate(fenced)),
        ("calibrate single", Command::Calibrate(Setup { scheme: Scheme::Single, ..by_hand })),
        ("redo", Command::Redo(None)),
        ("redo -Z", Command::Redo(Some(Face::MinusZ))),
        ("redo x", Command::Redo(Some(Face::PlusX))),
        ("  finish  ", Command::Finish),
        ("cancel", Command::Cancel),
        ("verify", Command::Verify),
        ("cal show", Command::Cal(CalAction::Show)),
        ("cal export", Command::Cal(CalAction::Export)),
        ("cal reset", Command::Cal(CalAction::Reset)),
        ("stream raw", Command::Stream(StreamKind::Raw)),
        ("stream cal", Command::Stream(StreamKind::Cal)),
        ("stream off", Command::Stream(StreamKind::Off)),
        ("record", Command::Record),
        ("selftest", Command::SelfTest),
    ];
    for (line, command) in table {
        assert_eq!(Command::parse(line), Some(Ok(command)), "{line}");
        assert!(WORDS.iter().any(|word| word.name == command.name()), "{line}");
    }
    for word in &WORDS {
        assert!(table.iter().any(|(_, command)| command.name() == word.name), "{} is untested", word.name);
    }
}

#[test]
fn a_wrong_word_is_named_with_the_right_one() {
    for (line, must_say) in [
        ("calibrte", "\"calibrte\". Did you mean \"calibrate\"?"),
        ("cali", "Did you mean \"calibrate\"?"),
        ("xyzzy", "I know: help, info, calibrate, redo, finish, cancel, verify, cal, stream, record, selftest."),
        ("stream rw", "After \"stream\" I do not understand \"rw\". Did you mean \"raw\"? It can be: raw, cal, off."),
        ("stream", "Type it as: stream raw|cal|off."),
        ("redo +w", "It can be: +x, -x, +y, -y, +z, -z."),
        ("redo +x -x", "\"-x\" is too much"),
        ("info please", "\"info\" stands alone: leave out \"please\"."),
        ("calibrate fenced by-hand", "\"by-hand\" is too much, or contradicts"),
        ("calibrate fencd", "Did you mean \"fenced\"?"),
        ("aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", "I do not know the word \"aaaaaaaaaaaaaaaa\""),
    ] {
        assert!(said(line).contains(must_say), "{line}: {}", said(line));
    }
}

#[test]
fn lines_end_in_three_ways_and_are_edited() {
    assert_eq!(read(b"help\rinfo\ncancel\r\n\r\n\nverify\r\n").len(), 4);
    assert_eq!(read(b"hepl\x08\x7flp\r"), [Ok(Command::Help)]);
    assert_eq!(read(b"\x08\x08help\r"), [Ok(Command::Help)]);
    assert_eq!(read(b"nonsense\x15help\r"), [Ok(Command::Help)]);
    assert_eq!(read(b"nonsense\x03help\r"), [Ok(Command::Help)]);
    assert_eq!(read(b"\0he\0lp\r"), [Ok(Command::Help)]);
    assert_eq!(read(b"   \r\t\n"), []);
}

#[test]
fn too_long_and_garbled_lines_are_reported_once_and_the_next_is_fine() {
    let mut line = std::vec![b'a'; 100];
    line.extend_from_slice(b"\r\nhelp\r\n");
    assert_eq!(read(&line), [Err(CommandError::TooLong { limit: 32 }), Ok(Command::Help)]);
    assert_eq!(read(b"he\xfflp\x80\rhelp\r"), [Err(CommandError::Garbled { bytes: 2 }), Ok(Command::Help)]);
    let mut corrected = std::vec![b' '; 40];
    corrected.extend(std::vec![8; 39]);
    corrected.extend_from_slice(b"help\r");
    assert_eq!(read(&corrected), [Ok(Command::Help)]);
}

#[test]
fn any_bytes_leave_it_working() {
    let mut state = 0x2545_f491_u32;
    let mut editor = LineEditor::<16>::new();
    for _ in 0..200_000 {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        if let Some(Err(error)) = editor.push(state as u8) {
            assert!(error.to_string().is_ascii());
        }
    }
    editor.push(b'\r');
    let answers: Vec<_> = b"verify\r".iter().filter_map(|byte| editor.push(*byte)).collect();
    assert_eq!(answers, [Ok(Command::Verify)]);
}

#[test]
fn distance_counts_slips() {
    for (a, b, slips) in [("", "", 0), ("", "abc", 3), ("abc", "", 3), ("raw", "rw", 1), ("kitten", "sitting", 3)] {
        assert_eq!(error::distance(a.as_bytes(), b.as_bytes()), slips, "{a} {b}");
    }
}
