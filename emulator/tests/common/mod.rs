//! Builds the probe firmware through cargo, once a test run, and talks to it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use emulator::{AtRest, Board, BoardOptions, SensorWorld};

fn built() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = root.join("target/probe");
    let status = Command::new(env!("CARGO"))
        .args(["build", "--release", "--locked", "--target-dir"])
        .arg(&target)
        // In its own folder, for its own .cargo/config.toml; without this build's flags for the host.
        .current_dir(root.join("probe-firmware"))
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .status()
        .expect("cargo starts");
    assert!(status.success(), "the probe firmware does not build; is thumbv7em-none-eabihf installed?");
    target.join("thumbv7em-none-eabihf/release/probe-firmware")
}

pub fn probe_elf() -> &'static [u8] {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    ELF.get_or_init(|| std::fs::read(built()).expect("the firmware was just built"))
}

pub fn board_in(options: BoardOptions, world: impl SensorWorld + 'static) -> Board {
    Board::new(probe_elf(), options, Box::new(world)).expect("the board powers up")
}

pub fn board() -> Board {
    board_in(BoardOptions::default(), AtRest)
}

/// Runs until the board has sent a whole line, at most `seconds`, and answers it without its end.
pub fn line(board: &mut Board, seconds: f64) -> String {
    let mut text = Vec::new();
    let end = board.now_s() + seconds;
    while board.now_s() < end {
        board.run_for(0.001).expect("it runs");
        text.extend(board.serial_read());
        if text.ends_with(b"\r\n") {
            break;
        }
    }
    String::from_utf8(text).expect("text").trim_end().to_owned()
}

/// Sends one letter and answers the line that comes back.
pub fn ask(board: &mut Board, letter: u8, seconds: f64) -> String {
    board.serial_write(&[letter]);
    line(board, seconds)
}

/// The number after `key=` in a line.
pub fn value(line: &str, key: &str) -> u64 {
    let text = line.split(' ').find_map(|word| word.strip_prefix(key)?.strip_prefix('='));
    text.and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("no {key} in {line:?}"))
}
