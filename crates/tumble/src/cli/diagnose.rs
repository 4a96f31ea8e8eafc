//! `tumble diagnose`.

use std::path::PathBuf;

use clap::Args;

use super::output::Progress;
use super::{Refusal, output};
use crate::diagnose::{self, Options};
use crate::recording::Recording;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Recordings to diagnose; what the first shows is tried on the others
    #[arg(value_name = "REC.csv", required = true)]
    recordings: Vec<PathBuf>,
    /// Print the contract's JSON object instead of a story
    #[arg(long)]
    json: bool,
    /// Effects that the search is not to know (for studies of what is unknown)
    #[arg(long, value_name = "ID")]
    without: Vec<String>,
    /// Of the draws that set thresholds
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let recordings = arguments.recordings.iter().map(|path| Recording::read(path)).collect::<Result<Vec<_>, _>>()?;
    let options = Options { without: arguments.without.clone(), seed: arguments.seed, conditions: None };
    let mut progress = Progress::new();
    let outcome = diagnose::diagnose(&recordings[0], &options, &mut |what, share| progress.share(what, share));
    drop(progress);
    if arguments.json {
        return Ok(output::print(&(serde_json::to_string(&outcome.diagnosis)? + "\n"))?);
    }
    Ok(output::print(&format!("{:#?}\n", outcome.diagnosis))?)
}
