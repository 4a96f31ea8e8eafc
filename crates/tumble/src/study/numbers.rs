//! `tumble study numbers`: are the numbers that a diagnosis states for an effect true within their sigmas, and if not, which
//! circumstance makes them wrong? Recordings carry one known effect (or several); nuisances of real recordings are
//! switched on one at a time.

use std::fmt::Write;

use serde::Serialize;
use tumble_sim::motion::Stops;
use tumble_sim::{Effect, Scheme, SchemeConfig, SimError};

use super::blind::answer::{Named, Value};
use super::blind::mapping::{self, True};
use super::parallel;
use crate::diagnose::{Options as Diagnosis, promise};
use crate::simulate;

/// What a real recording has and a machine's has not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Nuisance {
    /// The hands tremble at 8 to 12 Hz.
    Tremor,
    /// The axis of a turn wobbles.
    Wobble,
    /// The box is put down with a knock.
    Knock,
    /// Turns end within 0.1° of the fence, not at it.
    Stops,
    /// Both biases have 1/f noise.
    Flicker,
    /// Readings are rounded to counts of ±2000 °/s and ±16 g.
    Counts,
    /// The gyroscope, its axes and biases have the sheet's errors; without it only the accelerometer's.
    Sensor,
}

/// What to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// First seed.
    pub seed: u64,
    /// Recordings an effect.
    pub seeds: usize,
    /// What is made together.
    pub effects: Vec<Effect>,
    /// What the person does.
    pub scheme: Scheme,
    /// What is switched on.
    pub with: Vec<Nuisance>,
    /// Threads.
    pub threads: usize,
}

/// A number of one recording against the truth.
#[derive(Clone, Debug, Serialize)]
pub struct Number {
    /// Of the recording.
    pub seed: u64,
    /// Of the effect.
    pub id: String,
    /// As the diagnosis calls it.
    pub name: String,
    /// In the diagnosis' unit.
    pub truth: f64,
    /// What was found.
    pub value: f64,
    /// Its sigma.
    pub sigma: f64,
}

impl Number {
    /// By how many sigmas it is off.
    pub fn sigmas(&self) -> f64 {
        (self.value - self.truth) / self.sigma
    }
}

/// What came of it.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Recordings.
    pub recordings: usize,
    /// Of them, those in which every effect was found.
    pub found: usize,
    /// All numbers.
    pub numbers: Vec<Number>,
}

/// Makes, searches, compares.
pub fn run(options: &Options, done: &mut (impl FnMut(usize) + Send)) -> Result<Report, SimError> {
    let one = |k: usize| numbers(options, options.seed + k as u64);
    let all: Vec<Vec<Number>> =
        parallel::map(options.seeds, options.threads, one, done).into_iter().collect::<Result<_, _>>()?;
    let whole = |numbers: &&Vec<Number>| {
        options.effects.iter().all(|effect| numbers.iter().any(|number| number.id == effect.kind().id))
    };
    Ok(Report { recordings: all.len(), found: all.iter().filter(whole).count(), numbers: all.concat() })
}

fn numbers(options: &Options, seed: u64) -> Result<Vec<Number>, SimError> {
    let made = simulate::make(&config(options, seed))?;
    let ids: Vec<&str> = options.effects.iter().map(|effect| effect.kind().id).collect();
    let found = promise::numbers(&made.recording, &Diagnosis::default(), &ids).unwrap_or_default();
    let truth = serde_json::to_value(&made.truth).unwrap_or_default();
    let mut numbers = Vec::new();
    for (id, values) in found {
        let value = |value: crate::diagnose::diagnosis::Value| Value {
            name: value.name,
            value: Some(value.value),
            sigma: Some(value.sigma),
            unit: value.unit,
        };
        let named = Named { id: id.into(), parameters: values.into_iter().map(value).collect(), ..Named::default() };
        let own = truth["effects"].as_array().into_iter().flatten().find(|effect| effect["id"] == id);
        let own: Option<Vec<True>> = own.and_then(|own| serde_json::from_value(own["parameters"].clone()).ok());
        numbers.extend(mapping::pair(id, &own.unwrap_or_default(), &named).into_iter().map(|pair| Number {
            seed,
            id: id.into(),
            name: pair.name,
            truth: pair.truth,
            value: pair.value,
            sigma: pair.sigma,
        }));
    }
    Ok(numbers)
}

/// The world of [`SchemeConfig::blind`], less what is not switched on.
fn config(options: &Options, seed: u64) -> SchemeConfig {
    let mut config = SchemeConfig::blind(options.scheme, seed, None);
    let on = |nuisance: Nuisance| options.with.contains(&nuisance);
    let (hands, sensor) = (&mut config.world.motion.hands, &mut config.world.sensor);
    if !on(Nuisance::Tremor) {
        (hands.tremor_angle_deg, hands.tremor_position_m) = (0.0, 0.0);
    }
    if !on(Nuisance::Wobble) {
        hands.wobble_deg = 0.0;
    }
    if !on(Nuisance::Knock) {
        hands.knock_mps2 = 0.0;
    }
    if !on(Nuisance::Stops) {
        hands.stops = Stops::Exact;
    }
    if !on(Nuisance::Flicker) {
        (sensor.drift.gyro.instability, sensor.drift.accel.instability) = (0.0, 0.0);
    }
    if !on(Nuisance::Counts) {
        sensor.quantisation = None;
    }
    if !on(Nuisance::Sensor) {
        sensor.truth.gyro = tumble_sim::sensor::Triad::ideal();
    }
    config.effects.clone_from(&options.effects);
    config
}

/// One line a number, and one for all.
pub fn table(report: &Report) -> String {
    let mut text = format!("{} recordings, all effects found in {}\n", report.recordings, report.found);
    let _ = writeln!(
        text,
        "{:<26} {:<12} {:>5} {:>8} {:>8} {:>8} {:>10}",
        "effect", "number", "count", "mean z", "rms z", "within 2", "sigma"
    );
    let mut keys: Vec<(String, String)> = Vec::new();
    for number in &report.numbers {
        let key = (number.id.clone(), number.name.clone());
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let mut line = |id: &str, name: &str, chosen: &[&Number]| {
        let count = chosen.len() as f64;
        let mean = chosen.iter().map(|number| number.sigmas()).sum::<f64>() / count;
        let rms = (chosen.iter().map(|number| number.sigmas().powi(2)).sum::<f64>() / count).sqrt();
        let within = chosen.iter().filter(|number| number.sigmas().abs() <= 2.0).count();
        let mut sigmas: Vec<f64> = chosen.iter().map(|number| number.sigma).collect();
        sigmas.sort_by(f64::total_cmp);
        let middle = sigmas.get(sigmas.len() / 2).copied().unwrap_or(f64::NAN);
        let share = 100.0 * within as f64 / count;
        let _ = writeln!(
            text,
            "{id:<26} {name:<12} {:>5} {mean:>8.2} {rms:>8.2} {share:>7.0}% {middle:>10.3e}",
            chosen.len()
        );
    };
    for (id, name) in &keys {
        let chosen: Vec<&Number> = report.numbers.iter().filter(|one| one.id == *id && one.name == *name).collect();
        line(id, name, &chosen);
    }
    line("all", "", &report.numbers.iter().collect::<Vec<_>>());
    text
}
