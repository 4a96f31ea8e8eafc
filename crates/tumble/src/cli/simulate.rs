//! `tumble simulate`.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use serde::Serialize;
use tumble_sim::Effect;
use tumble_sim::sensor::EffectTruth;

use super::{Refusal, effects, output};
use crate::conceal::Seal;
use crate::recording::Recording;
use crate::simulate::{Plan, PlanError, SchemeName};
use crate::{conceal, inject};

/// What is simulated. Unless said otherwise: a table tilted by 1.5°, a square box with the sensor (3, 2, 1) cm off its
/// centre, turns against a fence, and an MPU-9250 within its data sheet at 200 Hz.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Recording to write
    #[arg(short, long, value_name = "REC.csv", required_unless_present = "list_effects")]
    output: Option<PathBuf>,
    /// Where to write the true parameters; they are told to nobody else
    #[arg(long, value_name = "TRUTH.json")]
    truth: Option<PathBuf>,
    /// What the person does; double, or single with --paper
    #[arg(long, value_enum)]
    scheme: Option<SchemeName>,
    /// Draws the sensor's errors and all chance; 1, or one that nobody knows with --conceal
    #[arg(long)]
    seed: Option<u64>,
    /// Sensor and table of the paper's simulation (its Table 1)
    #[arg(long)]
    paper: bool,
    /// Tilt of the table, degrees
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    tilt_deg: Option<f64>,
    /// Sensor's place in the box, cm from the axis of the turns
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', num_args = 3, allow_hyphen_values = true)]
    lever_cm: Option<Vec<f64>>,
    /// TurnStops end by eye, to 2°
    #[arg(long, conflicts_with = "fenced")]
    by_hand: bool,
    /// TurnStops end against a stop, to 0.1°
    #[arg(long)]
    fenced: bool,
    /// Amplitude by which the axis of a turn wobbles, degrees
    #[arg(long, value_name = "DEG")]
    wobble_deg: Option<f64>,
    #[arg(long = "imperfection", value_name = "NAME[=SIZE]", help = format!(
        "Further imperfection with its size, or all of them: {}, all", tumble_sim::scheme::Imperfection::WORDS
    ))]
    imperfections: Vec<String>,
    /// Round to the sensor's counts and clip at the ends of its ranges
    #[arg(long)]
    counts: bool,
    /// Full scale of the gyroscope with --counts, °/s
    #[arg(long, value_name = "DPS", default_value_t = 2000.0, requires = "counts")]
    gyro_range_dps: f64,
    /// Full scale of the accelerometer with --counts, g
    #[arg(long, value_name = "G", default_value_t = 16.0, requires = "counts")]
    accel_range_g: f64,
    /// Samples a second
    #[arg(long, value_name = "HZ", default_value_t = 200.0)]
    rate_hz: f64,
    /// No noise at all
    #[arg(long)]
    noiseless: bool,
    /// What every real recording has besides: 1/f noise, counts, a slight warm-up, some wobble, another tilt
    #[arg(long)]
    nuisance: bool,
    /// Physics that the nominal world leaves out; see --list-effects. Several go together
    #[arg(long = "effect", value_name = "ID[=MAGNITUDE]", value_parser = effects::parse)]
    effects: Vec<Effect>,
    /// Add the effects to this recording of a real sensor instead of simulating one
    #[arg(long, value_name = "REAL.csv", requires = "effects", conflicts_with_all = [
        "scheme", "paper", "tilt_deg", "lever_cm", "by_hand", "fenced", "wobble_deg", "imperfections", "counts", "rate_hz",
        "noiseless", "nuisance",
    ])]
    inject: Option<PathBuf>,
    /// Hide one effect, or none, and seal what it was in REC.csv.seal: `tumble reveal REC.csv` tells
    #[arg(long, conflicts_with_all = [
        "effects", "truth", "inject", "paper", "imperfections", "noiseless", "nuisance", "counts", "rate_hz",
    ])]
    conceal: bool,
    /// List all effects with the meaning of their magnitudes, and leave
    #[arg(long, exclusive = true)]
    list_effects: bool,
}

/// What is written with --truth beside a real recording that effects were added to.
#[derive(Serialize)]
struct Added {
    format: &'static str,
    version: u32,
    seed: u64,
    effects: Vec<EffectTruth>,
}

impl Arguments {
    fn scheme(&self) -> SchemeName {
        self.scheme.unwrap_or(if self.paper { SchemeName::Single } else { SchemeName::Double })
    }

    fn seed(&self) -> u64 {
        self.seed.unwrap_or_else(|| if self.conceal { conceal::any_seed() } else { 1 })
    }

    fn plan(&self, seed: u64) -> Plan {
        let lever_cm = self.lever_cm.as_deref().and_then(|v| <[f64; 3]>::try_from(v).ok());
        Plan {
            scheme: self.scheme(),
            seed,
            paper: self.paper,
            tilt_deg: self.tilt_deg,
            lever_cm,
            by_hand: if self.by_hand { Some(true) } else { self.fenced.then_some(false) },
            wobble_deg: self.wobble_deg,
            imperfections: self.imperfections.clone(),
            ranges: self.counts.then_some((self.gyro_range_dps, self.accel_range_g)),
            rate_hz: self.rate_hz,
            noiseless: self.noiseless,
            nuisance: self.nuisance,
            effects: self.effects.clone(),
        }
    }

    fn write_truth(&self, truth: &impl Serialize) -> Result<(), Refusal> {
        let Some(path) = &self.truth else { return Ok(()) };
        let text = serde_json::to_string_pretty(truth)? + "\n";
        std::fs::write(path, text).map_err(|error| Refusal::one(format!("{}: {error}", path.display())))
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let Some(path) = &arguments.output else { return Ok(output::print(&effects::list())?) };
    if arguments.conceal {
        return run_conceal(arguments, path);
    }
    if let Some(real) = &arguments.inject {
        return run_inject(arguments, real, path);
    }
    let seed = arguments.seed();
    // A plan comes from the command line alone, so that what is wrong with it is wrong usage.
    let made = arguments.plan(seed).make().map_err(wrong_usage)?;
    made.recording.write_file(path)?;
    arguments.write_truth(&made.truth)?;
    tell(path, &made.recording, &format!(", scheme {}, seed {seed}", name(arguments.scheme())))
}

/// Says nothing that depends on what is hidden: not the seed, and of the samples not how many.
fn run_conceal(arguments: &Arguments, path: &Path) -> Result<(), Refusal> {
    let made = conceal::conceal(&arguments.plan(arguments.seed())).map_err(wrong_usage)?;
    let mut bytes = Vec::new();
    made.recording.write(&mut bytes)?;
    std::fs::write(path, &bytes).map_err(|error| Refusal::one(format!("{}: {error}", path.display())))?;
    let seal = Seal::new(&bytes, &made.secret)?.write(path)?;
    output::print(&format!(
        "{0}: scheme {1}; it hides one effect, or nothing. What it is lies in {2}: tumble reveal {0}\n",
        path.display(),
        name(arguments.scheme()),
        seal.display()
    ))?;
    Ok(())
}

fn run_inject(arguments: &Arguments, real: &Path, path: &Path) -> Result<(), Refusal> {
    let seed = arguments.seed();
    let mut recording = Recording::read(real)?;
    let effects = inject::add(&mut recording, &arguments.effects, seed)
        .map_err(|error| Refusal::one(format!("{}: {error}", real.display())))?;
    recording.write_file(path)?;
    arguments.write_truth(&Added { format: "tumble-added", version: 1, seed, effects })?;
    tell(path, &recording, &format!(", made of {}, seed {seed}", real.display()))
}

fn tell(path: &Path, recording: &Recording, more: &str) -> Result<(), Refusal> {
    let rows = &recording.rows;
    let length_s = rows.last().map_or(0.0, |row| row.t_s - recording.origin_s());
    output::print(&format!("{}: {} samples, {length_s:.1} s{more}\n", path.display(), rows.len()))?;
    Ok(())
}

fn wrong_usage(error: PlanError) -> Refusal {
    Refusal { status: 2, ..Refusal::from(error) }
}

fn name(scheme: SchemeName) -> String {
    scheme.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned())
}
