//! `tumble study blind`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use tumble_sim::Effect;

use super::Refusal;
use super::output::{self, Progress};
use crate::study::blind::{self, Options, table};

/// What the simulated person does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Schemes {
    /// Six faces, one turn on each
    Single,
    /// Six faces, a turn both ways on each
    Double,
    /// 24 oblique poses with hand rotations between them
    Multipose,
    /// Each in turn, where the effect can show
    Mixed,
}

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Everything is drawn from it
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Recordings of each effect
    #[arg(long, value_name = "N", default_value_t = 20)]
    seeds: usize,
    /// Recordings without an effect
    #[arg(long, value_name = "N", default_value_t = 500)]
    clean: usize,
    /// Only these effects of the catalogue; `none` for none
    #[arg(long, value_name = "ID,ID...", value_delimiter = ',', value_parser = known)]
    effects: Vec<String>,
    /// Also effects outside the catalogue, each as often
    #[arg(long)]
    foreign: bool,
    /// Each effect once more, hidden from the diagnosis (`--without ID`)
    #[arg(long)]
    removed: bool,
    /// Recordings of each pair of effects that occur together
    #[arg(long, value_name = "N", default_value_t = 0)]
    pairs: usize,
    /// What the person does
    #[arg(long, value_enum, default_value_t = Schemes::Mixed)]
    scheme: Schemes,
    /// Diagnoses at a time
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..))]
    jobs: u32,
    /// Folder that keeps recordings, seals and answers; what is answered there is not computed again
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Keep answers and seals in DIR, but not the recordings (3 MB each)
    #[arg(long, requires = "output")]
    answers_only: bool,
    /// Diagnose again what is answered in DIR: by another build. Sizes stay, as the clean twins stay
    #[arg(long, requires = "output")]
    again: bool,
    /// Score what is answered in DIR so far, by this or another process, and ask nothing more
    #[arg(long, requires = "output", conflicts_with = "again")]
    partial: bool,
    /// Size of an effect, in detection limits of its clean twin
    #[arg(long, value_name = "FACTOR", default_value_t = 2.0, value_parser = positive)]
    at: f64,
    /// Noise in motion over that at rest, from which the diagnosis takes it
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    noise: f64,
    /// A diagnosis that takes longer counts as broken, s
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = positive)]
    patience: f64,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

fn known(word: &str) -> Result<String, String> {
    let is = |id: &str| id == word || word == "none";
    Effect::ALL.iter().any(|kind| is(kind.id)).then(|| word.to_owned()).ok_or_else(|| {
        format!("there is no effect '{word}' in the catalogue; tumble simulate --list-effects shows what there is")
    })
}

pub(super) fn positive(word: &str) -> Result<f64, String> {
    word.parse().ok().filter(|value: &f64| *value > 0.0 && value.is_finite()).ok_or("a number above 0".to_owned())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let schemes = match arguments.scheme {
        Schemes::Single => vec!["single"],
        Schemes::Double => vec!["double"],
        Schemes::Multipose => vec!["multipose"],
        Schemes::Mixed => vec!["double", "single", "multipose"],
    };
    let options = Options {
        seed: arguments.seed,
        seeds: arguments.seeds,
        clean: arguments.clean,
        effects: arguments.effects.clone(),
        foreign: arguments.foreign,
        removed: arguments.removed,
        pairs: arguments.pairs,
        schemes,
        jobs: arguments.jobs as usize,
        folder: arguments.output.clone(),
        keep: !arguments.answers_only,
        again: arguments.again,
        partial: arguments.partial,
        at: arguments.at,
        noise: arguments.noise,
        patience_s: arguments.patience,
    };
    let program = std::env::current_exe()?;
    let mut progress = Progress::new();
    let mut shown = |what: &str, done: usize, total: usize| {
        progress.share(&format!("{what} {done}/{total}"), done as f32 / total.max(1) as f32);
    };
    let report = blind::run(&options, &program, &mut shown)?;
    drop(progress);
    let text = if arguments.json { serde_json::to_string(&report)? + "\n" } else { table::text(&report) };
    Ok(output::print(&text)?)
}
