//! `tumble diagnose`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::output::Progress;
use super::{Refusal, output};
use crate::diagnose::report::{self, Source};
use crate::diagnose::{self, Options, transfer};
use crate::recording::Recording;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Recordings to diagnose; what the first shows is tried on the others
    #[arg(value_name = "REC.csv", required = true)]
    recordings: Vec<PathBuf>,
    /// Print the contract's JSON object instead of a story
    #[arg(long)]
    json: bool,
    /// Write report.html, one page with all pictures, and diagnosis.json into this folder
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Effects that the search is not to know (for studies of what is unknown)
    #[arg(long, value_name = "ID")]
    without: Vec<String>,
    /// Of the draws that set thresholds
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let read = |path: &PathBuf| Recording::read_with_its_stamps(path);
    let recordings = arguments.recordings.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let options = Options { without: arguments.without.clone(), seed: arguments.seed, conditions: None };
    let mut progress = Progress::new();
    let mut outcome = diagnose::diagnose(&recordings[0], &options, &mut |what, share| progress.share(what, share));
    for (path, recording) in arguments.recordings.iter().zip(&recordings).skip(1) {
        progress.share("the other recordings", 0.97);
        transfer::try_on(&mut outcome.diagnosis, recording, &path.display().to_string(), &options);
    }
    drop(progress);
    let (diagnosis, exhibits) = (&outcome.diagnosis, outcome.exhibits.as_ref());
    let page = match &arguments.report {
        Some(folder) => Some(
            report::write(folder, &source(&arguments.recordings[0], &recordings[0]), diagnosis, exhibits)
                .map_err(|error| Refusal::one(format!("{}: cannot be written: {error}", folder.display())))?,
        ),
        None => None,
    };
    if arguments.json {
        return Ok(output::print(&(serde_json::to_string(diagnosis)? + "\n"))?);
    }
    if let Some(page) = page {
        output::error(&format!("page: {}", page.display()));
    }
    Ok(output::print(&report::story(diagnosis, exhibits))?)
}

fn source(path: &Path, recording: &Recording) -> Source {
    Source {
        file: path.display().to_string(),
        sensor: recording.metadata.sensor.clone(),
        samples: recording.rows.len(),
        length_s: recording.rows.last().map_or(0.0, |last| last.t_s - recording.origin_s()),
    }
}
