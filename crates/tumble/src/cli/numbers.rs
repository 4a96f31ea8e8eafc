//! `tumble study numbers`.

use clap::{Args, ValueEnum};
use tumble_sim::Effect;

use super::Refusal;
use super::output::{self, Progress};
use crate::simulate::SchemeName;
use crate::study::numbers::{self, Nuisance, Options};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The effects that every recording has together, with their sizes as in `tumble simulate`
    #[arg(long, value_name = "ID[=SIZE],...", value_delimiter = ',', required = true)]
    effects: Vec<String>,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Recordings
    #[arg(long, value_name = "N", default_value_t = 20)]
    seeds: usize,
    /// What the person does
    #[arg(long, value_enum, default_value_t = SchemeName::Double)]
    scheme: SchemeName,
    /// Nothing that a machine would not do, but for what `--with` names
    #[arg(long)]
    bare: bool,
    /// Beside `--bare`: what is switched on
    #[arg(long, value_name = "WHAT,...", value_delimiter = ',', value_enum, requires = "bare")]
    with: Vec<Nuisance>,
    /// Threads
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let effects = arguments.effects.iter().map(|word| Effect::parse(word)).collect::<Result<Vec<_>, _>>();
    let options = Options {
        seed: arguments.seed,
        seeds: arguments.seeds,
        effects: effects.map_err(|error| Refusal::one(error.to_string()))?,
        scheme: arguments.scheme.scheme(),
        with: if arguments.bare { arguments.with.clone() } else { Nuisance::value_variants().to_vec() },
        threads: arguments.threads,
    };
    let mut progress = Progress::new();
    let total = options.seeds.max(1) as f32;
    let report = numbers::run(&options, &mut |done| progress.share("recordings", done as f32 / total))
        .map_err(|error| Refusal::one(error.to_string()))?;
    drop(progress);
    let text = if arguments.json { serde_json::to_string(&report)? + "\n" } else { numbers::table(&report) };
    Ok(output::print(&text)?)
}
