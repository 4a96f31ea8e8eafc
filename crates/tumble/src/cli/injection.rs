//! `tumble study injection`.

use std::path::PathBuf;

use clap::Args;

use super::Refusal;
use super::blind::positive;
use super::output::{self, Progress};
use crate::study::injection::{self, Options, table};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder of the real recordings
    #[arg(long, value_name = "DIR", default_value = "../shared/recordings")]
    recordings: PathBuf,
    /// Effects added to each recording, one at a time
    #[arg(long, value_name = "N", default_value_t = 5)]
    count: usize,
    /// Size of an effect, in detection limits of the recording as it is
    #[arg(long, value_name = "FACTOR", default_value_t = 3.0, value_parser = positive)]
    at: f64,
    /// Draws axes, directions, signs and times
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Recordings at a time
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..))]
    jobs: u32,
    /// Folder that keeps the answers; what is answered there is not computed again
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// A diagnosis that takes longer counts as broken, s
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = positive)]
    patience: f64,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    if !arguments.recordings.is_dir() {
        let folder = arguments.recordings.display();
        output::error(&format!("skipped: there is no folder {folder}; --recordings DIR names another"));
        return Ok(());
    }
    let aside = || std::env::temp_dir().join(format!("tumble-injection-{}", std::process::id()));
    let options = Options {
        recordings: arguments.recordings.clone(),
        folder: arguments.output.clone().unwrap_or_else(aside),
        count: arguments.count,
        at: arguments.at,
        seed: arguments.seed,
        jobs: arguments.jobs as usize,
        patience_s: arguments.patience,
    };
    let program = std::env::current_exe()?;
    let mut progress = Progress::new();
    let mut shown = |what: &str, done: usize, total: usize| {
        progress.share(&format!("{what} {done}/{total}"), done as f32 / total.max(1) as f32);
    };
    let report = injection::run(&options, &program, &mut shown);
    drop(progress);
    if arguments.output.is_none() {
        // In the system's folder for what may go; the report stands without it.
        let _ = std::fs::remove_dir_all(&options.folder);
    }
    let report = report?;
    let text = if arguments.json { serde_json::to_string(&report)? + "\n" } else { table::text(&report) };
    Ok(output::print(&text)?)
}
