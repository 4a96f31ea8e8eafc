//! `tumble record | console | verify`.

use std::fs::File;
use std::io::{self, BufRead};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::Args;

use super::output::Progress;
use super::{BoxWord, Refusal, TurnsWord, output};
use crate::serial;

#[derive(Debug, Args)]
pub(super) struct RecordArguments {
    /// Serial port, as /dev/ttyUSB0
    port: String,
    /// Recording to write
    #[arg(short, long, value_name = "REC.csv")]
    output: PathBuf,
    /// How long; without it until Enter is pressed
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// How turns end, instead of what the board states
    #[arg(long, value_enum)]
    turns: Option<TurnsWord>,
    /// What the box is, instead of what the board states
    #[arg(long = "box", value_enum)]
    box_faces: Option<BoxWord>,
}

#[derive(Debug, Args)]
pub(super) struct ConsoleArguments {
    /// Serial port, as /dev/ttyUSB0
    port: String,
    /// Show the lines for programs (@…) too
    #[arg(long)]
    all: bool,
}

#[derive(Debug, Args)]
pub(super) struct VerifyArguments {
    /// Serial port, as /dev/ttyUSB0
    port: String,
}

pub(super) fn record(arguments: &RecordArguments) -> Result<(), Refusal> {
    let port = serial::open(&arguments.port)?;
    let name = arguments.output.display();
    let file = File::create(&arguments.output).map_err(|error| Refusal::one(format!("{name}: {error}")))?;
    let mut ended = until(arguments.seconds);
    let mut progress = Progress::new();
    let amend = |metadata: &mut crate::recording::Metadata| {
        metadata.turns = arguments.turns.map(Into::into).or(metadata.turns);
        metadata.box_faces = arguments.box_faces.map(Into::into).or(metadata.box_faces);
    };
    let capture = serial::record(port, file, amend, |capture| {
        progress.count("samples", capture.samples);
        ended()
    })?;
    drop(progress);
    output::print(&format!(
        "{name}: {} samples, {} lost, {} damaged lines\n",
        capture.samples, capture.lost, capture.damaged
    ))?;
    if capture.samples == 0 { Err(Refusal::one(format!("{name}: no sample came"))) } else { Ok(()) }
}

/// True once the time is over, or, without one, once Enter was pressed or standard input ended.
fn until(seconds: Option<f64>) -> Box<dyn FnMut() -> bool> {
    if let Some(seconds) = seconds {
        let end = Instant::now() + Duration::from_secs_f64(seconds.clamp(0.0, 1e6));
        return Box::new(move || Instant::now() >= end);
    }
    output::error("recording; press Enter to end");
    let pressed = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&pressed);
    std::thread::spawn(move || {
        // Whatever comes, a line, an end or an error, is a reason to end.
        let _ = io::stdin().lock().read_line(&mut String::new());
        pressed.store(true, Ordering::Relaxed);
    });
    Box::new(move || seen.load(Ordering::Relaxed))
}

pub(super) fn console(arguments: &ConsoleArguments) -> Result<(), Refusal> {
    let port = serial::open(&arguments.port)?;
    output::error("type words for the board, \"help\" first; end with Ctrl-D");
    Ok(serial::console(port, arguments.all, tell)?)
}

pub(super) fn verify(arguments: &VerifyArguments) -> Result<(), Refusal> {
    let port = serial::open(&arguments.port)?;
    let verified = serial::verify(port, tell)?;
    output::print(&format!("{}\n", verified.line))?;
    if verified.passed {
        Ok(())
    } else {
        Err(Refusal::one("the calibration in force did not hold: calibrate again".into()))
    }
}

fn tell(line: &str) {
    // A reader that went away is noticed at the end, where the error is passed on.
    let _ = output::print(&format!("{line}\n"));
}
