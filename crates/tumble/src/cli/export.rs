//! `tumble export`.

use std::path::PathBuf;

use clap::Args;

use super::{Refusal, output};
use crate::export::{Format, Parameters, export};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The JSON of `tumble calibrate --json`, or the board's answer to `cal export`
    #[arg(value_name = "PARAMS")]
    parameters: PathBuf,
    /// For which program
    #[arg(long, value_enum)]
    format: Format,
    /// File to write, instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let file = arguments.parameters.display();
    let refuse = |what: &dyn std::fmt::Display| Refusal::one(format!("{file}: {what}"));
    let text = std::fs::read_to_string(&arguments.parameters).map_err(|error| refuse(&error))?;
    let parameters = Parameters::parse(&text).map_err(|error| refuse(&error))?;
    let exported = export(&parameters, arguments.format).map_err(|error| refuse(&error))?;
    match &arguments.output {
        None => Ok(output::print(&exported)?),
        Some(path) => {
            std::fs::write(path, exported).map_err(|error| Refusal::one(format!("{}: {error}", path.display())))
        }
    }
}
