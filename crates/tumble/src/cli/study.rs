//! `tumble study`: published figures, each from one command.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use serde::Serialize;
use tumble_sim::scheme::Imperfection;

use super::Refusal;
use super::output::{self, Progress};
use crate::output::{paper as paper_tables, study as tables};
use crate::study::limits::{Effort, Scenario, ScenarioSummary};
use crate::study::{paper as paper_study, recordings as real};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
enum Study {
    /// The device's estimator over many simulated sessions, against the Cramér–Rao bound
    Limits(LimitsArguments),
    /// The paper's simulation by its method, its comparison method and ours, and the story of its mismatch
    Paper(PaperArguments),
    /// Does the diagnosis find effects that it is not told of? Drawn and sealed, diagnosed from the CSV alone, unsealed, scored
    Blind(super::blind::Arguments),
    /// Are known effects recovered that were added to real recordings?
    Injection(super::injection::Arguments),
    /// Are the numbers stated for an effect true within their sigmas? Nuisances can be switched on one at a time
    Numbers(super::numbers::Arguments),
    /// Real recordings by several estimators, beside what their authors published
    Recordings(RecordingsArguments),
}

#[derive(Debug, Args)]
struct PaperArguments {
    /// Runs; the table's tilt goes from 0 to 3° over them
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(2..))]
    runs: u32,
    /// Threads
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..))]
    threads: u32,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Folder for the figures, as SVG
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct RecordingsArguments {
    /// Folder of the recordings
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct LimitsArguments {
    /// Sessions of each kind
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(2..))]
    runs: u32,
    /// Threads
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..))]
    threads: u32,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Leave out the table of imperfections
    #[arg(long)]
    nominal_only: bool,
    /// Instead of all tables: both schemes and references with this imperfection (may be given several times), say `fence=0.1`,
    /// `crooked_box=0.02`, `by_hand=2`, `wobble=1`; `tumble simulate --help` has the words
    #[arg(long, value_name = "WORD[=SIZE]", value_parser = imperfection)]
    imperfection: Vec<Imperfection>,
    /// Run the references (batch, gravity) on the same sessions as well
    #[arg(long)]
    references: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    match &arguments.study {
        Study::Blind(arguments) => super::blind::run(arguments),
        Study::Injection(arguments) => super::injection::run(arguments),
        Study::Limits(arguments) => limits(arguments),
        Study::Numbers(arguments) => super::numbers::run(arguments),
        Study::Paper(arguments) => paper(arguments),
        Study::Recordings(arguments) => recordings(arguments),
    }
}

#[derive(Serialize)]
struct LimitsReport {
    format: &'static str,
    version: u32,
    runs: u32,
    seed: u64,
    nominal: Vec<ScenarioSummary>,
    imperfect: Vec<ScenarioSummary>,
}

fn imperfection(text: &str) -> Result<Imperfection, String> {
    let (word, size) = text.split_once('=').map_or((text, None), |(word, size)| (word, Some(size)));
    let size =
        size.map(|size| size.parse::<f64>().map_err(|error| format!("`{size}` is no size: {error}"))).transpose()?;
    Imperfection::parse(word, size)
        .ok_or_else(|| format!("`{word}` is no imperfection that a study knows: {}", Imperfection::WORDS))
}

fn limits(arguments: &LimitsArguments) -> Result<(), Refusal> {
    let asked = !arguments.imperfection.is_empty();
    let nominal = if asked { Vec::new() } else { run_all(arguments, &Scenario::nominal(), true) };
    let imperfect = match (asked, arguments.nominal_only) {
        (true, _) => run_all(arguments, &Scenario::with(&arguments.imperfection), false),
        (false, true) => Vec::new(),
        (false, false) => run_all(arguments, &Scenario::imperfect(), false),
    };
    let report = LimitsReport {
        format: "tumble-study-limits",
        version: 1,
        runs: arguments.runs,
        seed: arguments.seed,
        nominal,
        imperfect,
    };
    let text = match arguments.json {
        true => serde_json::to_string(&report)? + "\n",
        false => tables::limits(&report.nominal, &report.imperfect),
    };
    Ok(output::print(&text)?)
}

fn run_all(arguments: &LimitsArguments, scenarios: &[Scenario], navigate: bool) -> Vec<ScenarioSummary> {
    let effort = Effort {
        runs: arguments.runs as usize,
        threads: arguments.threads as usize,
        seed: arguments.seed,
        references: arguments.references,
    };
    let total = (scenarios.len() * effort.runs) as f32;
    let mut progress = Progress::new();
    let mut summaries = Vec::with_capacity(scenarios.len());
    for (before, scenario) in scenarios.iter().enumerate() {
        let mut done = |runs: usize| {
            progress.share(scenario.name, (before * effort.runs + runs) as f32 / total);
        };
        summaries.push(scenario.run(&effort, navigate, &mut done));
    }
    summaries
}

fn recordings(arguments: &RecordingsArguments) -> Result<(), Refusal> {
    let mut progress = Progress::new();
    let report = real::run(&arguments.folder, &mut |share| progress.share("recordings", share));
    drop(progress);
    if report.rows.is_empty() {
        return Err(Refusal { reasons: report.missing, status: 1 });
    }
    let text = if arguments.json { serde_json::to_string(&report)? + "\n" } else { tables::recordings(&report) };
    Ok(output::print(&text)?)
}

fn paper(arguments: &PaperArguments) -> Result<(), Refusal> {
    let effort = Effort {
        runs: arguments.runs as usize,
        threads: arguments.threads as usize,
        seed: arguments.seed,
        references: false,
    };
    let mut progress = Progress::new();
    let runs = paper_study::run(&effort, &mut |done| progress.share("runs", done as f32 / arguments.runs as f32))?;
    drop(progress);
    let story = paper_study::story::story(&runs);
    if let Some(folder) = &arguments.out {
        let files = paper_study::plots::draw(&runs, folder)
            .map_err(|error| Refusal::one(format!("{}: {error}", folder.display())))?;
        files.iter().for_each(|file| output::error(&format!("drawn: {}", file.display())));
    }
    let text = if arguments.json { serde_json::to_string(&story)? + "\n" } else { paper_tables::paper(&story) };
    Ok(output::print(&text)?)
}
