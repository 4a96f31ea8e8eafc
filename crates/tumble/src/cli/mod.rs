//! The command line: what can be asked for, and the exit status of each answer.
//!
//! 0 done, 1 the input was refused (with reasons on standard error), 2 wrong usage (clap's).

mod blind;
mod calibrate;
mod diagnose;
mod effects;
mod export;
mod injection;
mod numbers;
mod output;
mod reveal;
mod serial;
mod simulate;
mod study;

use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};

use crate::recording::{BoxFaces, TurnStops};

/// Calibrate and study IMU recordings with the arithmetic of the Tumble firmware.
#[derive(Debug, Parser)]
#[command(name = "tumble", version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Estimate a sensor's errors from a recording, as the board would
    Calibrate(calibrate::Arguments),
    /// Make a recording of a simulated sensor whose errors are known
    Simulate(simulate::Arguments),
    /// Tell what a concealed recording hides
    Reveal(reveal::Arguments),
    /// Find which physics a recording contains that the nominal model leaves out
    Diagnose(diagnose::Arguments),
    /// Record the board's raw samples
    Record(serial::RecordArguments),
    /// Talk to the board
    Console(serial::ConsoleArguments),
    /// Have the board check its calibration on fresh poses
    Verify(serial::VerifyArguments),
    /// Write a calibration for another program
    Export(export::Arguments),
    /// Run a study whose figures are published
    Study(study::Arguments),
}

/// How a turn ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TurnsWord {
    /// Against a stop, to 0.1°
    Fenced,
    /// By eye, to 2°
    ByHand,
}

impl From<TurnsWord> for TurnStops {
    fn from(word: TurnsWord) -> Self {
        if word == TurnsWord::Fenced { Self::Fenced } else { Self::ByHand }
    }
}

/// What the box is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BoxWord {
    /// Its faces are square to each other
    Square,
    /// Nobody knows
    Unknown,
}

impl From<BoxWord> for BoxFaces {
    fn from(word: BoxWord) -> Self {
        if word == BoxWord::Square { Self::Square } else { Self::Unknown }
    }
}

/// A refusal: what to tell, one reason a line, and the exit status.
#[derive(Debug)]
struct Refusal {
    reasons: Vec<String>,
    status: u8,
}

impl Refusal {
    /// The input was refused for one reason.
    fn one(reason: String) -> Self {
        Self { reasons: vec![reason], status: 1 }
    }
}

impl<E: std::error::Error> From<E> for Refusal {
    fn from(error: E) -> Self {
        Self::one(error.to_string())
    }
}

/// Does what was asked for.
pub fn run(cli: &Cli) -> ExitCode {
    let result = match &cli.command {
        Command::Calibrate(arguments) => calibrate::run(arguments),
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Reveal(arguments) => reveal::run(arguments),
        Command::Record(arguments) => serial::record(arguments),
        Command::Console(arguments) => serial::console(arguments),
        Command::Verify(arguments) => serial::verify(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Study(arguments) => study::run(arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(refusal) => {
            for reason in refusal.reasons {
                output::error(&format!("tumble: {reason}"));
            }
            ExitCode::from(refusal.status)
        }
    }
}
