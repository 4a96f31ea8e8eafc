//! `cargo xtask demo | test | size | bench | setup`: everything that takes more than one command, as one.

mod args;
mod bench;
mod emulator;
mod firmware;
mod process;
mod report;
mod size;
mod suite;
mod toolchain;

use std::process::ExitCode;

use args::{Arguments, Task};

/// What went wrong, in a sentence for the person, with the exit status to leave with.
pub struct Failure {
    /// Names the step and the remedy.
    pub message: String,
    /// 1, or what the program that failed left with; 2 for wrong usage.
    pub status: u8,
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self { message, status: 1 }
    }
}

fn main() -> ExitCode {
    let result = Arguments::parse(std::env::args().skip(1)).and_then(|arguments| run(&arguments));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {}", failure.message);
            ExitCode::from(failure.status)
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.task {
        Task::Help => {
            println!("{}", args::USAGE);
            Ok(())
        }
        Task::Setup => {
            let toolchain = toolchain::set_up(arguments.toolchain)?;
            println!("set-up: the firmware is built with {}", toolchain.name());
            Ok(())
        }
        Task::Demo => emulator::demo(arguments),
        Task::Test => suite::run_all(arguments),
        Task::Size => size::run(arguments),
        Task::Bench => bench::run(arguments),
    }
}
