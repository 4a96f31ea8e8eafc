//! `tumble study`: published figures, each from one command.

use clap::{Args, Subcommand};
use serde::Serialize;

use super::Refusal;
use super::output::{self, Progress};
use crate::output::study as tables;
use crate::study::limits::{Effort, Scenario, ScenarioSummary};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
enum Study {
    /// The device's estimator over many simulated sessions, against the Cramér–Rao bound
    Limits(LimitsArguments),
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
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    match &arguments.study {
        Study::Limits(arguments) => limits(arguments),
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

fn limits(arguments: &LimitsArguments) -> Result<(), Refusal> {
    let nominal = run_all(arguments, &Scenario::nominal(), true);
    let imperfect = if arguments.nominal_only { Vec::new() } else { run_all(arguments, &Scenario::imperfect(), false) };
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
    let effort = Effort { runs: arguments.runs as usize, threads: arguments.threads as usize, seed: arguments.seed };
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
