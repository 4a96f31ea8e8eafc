//! `tumble`: see `tumble --help`.
#![forbid(unsafe_code)]

use std::process::ExitCode;

use clap::Parser;
use tumble::cli::{Cli, run};

fn main() -> ExitCode {
    // clap leaves with 2 on wrong usage, as the contract has it.
    run(&Cli::parse())
}
