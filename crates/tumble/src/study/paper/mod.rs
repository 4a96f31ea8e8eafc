//! `tumble study paper`: the paper's simulation with its two-step method as printed and corrected, its comparison method and
//! the device's estimator, beside what it published; and which slip would explain what it published.
//!
//! Errors are the paper's: scale relative to its truth, K as estimate less truth, with `V = SF·(A·ω + Δ)` and A's rows of
//! unit length.

pub mod filter;
pub mod plots;
pub mod published;
pub mod step_one;
pub mod story;

use nalgebra::Matrix3;
use tumble_core::estimate::Conditions;
use tumble_core::estimate::two_step::Variant;
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_sim::{Recording, SchemeConfig};

use super::limits::Effort;
use super::navigation::{Compensation, Correction, level_errors, tumbling};
use super::parallel;
use super::trial::{Trial, TrialError, readings};
use super::truth::matrix;
use crate::calibrate::{self, Session};
use filter::Instant;
use step_one::{Reading, step_one};

/// Errors of k11 to k33 by rows; scales on the diagonal.
pub type Errors = [f64; 9];

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The paper's equations as printed.
    Literal,
    /// Without cos β.
    Corrected,
    /// Scale and an antisymmetric matrix together in the filter, by the device's own code.
    Traditional,
    /// As corrected, with an accelerometer that the table's tilt leaks into.
    TiltLeak,
    /// As corrected, by the device's own code.
    Device,
    /// The device's estimator.
    Ours,
}

impl Method {
    /// All.
    pub const ALL: [Self; 6] =
        [Self::Literal, Self::Corrected, Self::Traditional, Self::TiltLeak, Self::Device, Self::Ours];

    /// For tables and legends.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Literal => "two-step, literal",
            Self::Corrected => "two-step, corrected",
            Self::Traditional => "traditional",
            Self::TiltLeak => "two-step, tilt leaks",
            Self::Device => "two-step, on device",
            Self::Ours => "ours",
        }
    }
}

/// One method in one run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Of the gyroscope.
    pub errors: Errors,
    /// Errors of the accelerometer's correction, row by row.
    pub accel_errors: Errors,
    /// κ over time; of the `f64` filter alone.
    pub history: Vec<Instant>,
    /// Level error over the tumbling: (s, degrees), ten a second; of the run that is drawn alone.
    pub level: Vec<(f64, f64)>,
    /// The largest, degrees.
    pub level_max_deg: f64,
}

/// One session of the paper's simulation, by every method.
#[derive(Clone, Debug)]
pub struct Run {
    /// Of the table, degrees.
    pub tilt_deg: f64,
    /// In the order of [`Method::ALL`].
    pub outcomes: Vec<Outcome>,
}

/// The paper's runs: tilt from 0 to 3° (its 1.5° in the middle), seeds one after the other.
///
/// # Errors
/// If a run cannot be simulated or estimated.
pub fn run(effort: &Effort, done: &mut (impl FnMut(usize) + Send)) -> Result<Vec<Run>, TrialError> {
    let work = |index: usize| one(&config(index, effort), index == shown(effort.runs));
    parallel::map(effort.runs, effort.threads, work, done).into_iter().collect()
}

/// The run whose course over time is kept and drawn: of the paper's own tilt, in the middle.
fn shown(runs: usize) -> usize {
    runs / 2
}

fn config(index: usize, effort: &Effort) -> SchemeConfig {
    let mut config = SchemeConfig::paper(effort.seed + index as u64);
    config.world.motion.table.tilt_deg = 3.0 * index as f64 / (effort.runs.max(2) - 1) as f64;
    config
}

fn one(config: &SchemeConfig, shown: bool) -> Result<Run, TrialError> {
    let recording = config.record()?;
    let tumbled = tumbling(config)?;
    let trial = Trial::run(config, BoxFaces::Square)?;
    let missing = || TrialError::NoEstimate { seed: config.world.seed, reason: "a face or a turn is missing".into() };
    let mut outcomes = Vec::with_capacity(Method::ALL.len());
    for method in Method::ALL {
        let (compensation, history) = match method {
            Method::Ours => (Compensation::estimated(&trial), Vec::new()),
            Method::Device => {
                let found = trial.two_step.as_ref().ok_or_else(missing)?;
                (Compensation::of(found, trial.rotation_f_from_b), Vec::new())
            }
            Method::Traditional => (traditional(&recording).ok_or_else(missing)?, Vec::new()),
            _ => two_step(config, &recording, method).ok_or_else(missing)?,
        };
        let levels = level_errors(&tumbled, &compensation);
        outcomes.push(Outcome {
            errors: gyro_errors(&recording, &compensation.gyro.matrix),
            accel_errors: accel_errors(&recording, &compensation.accel.matrix),
            history,
            level_max_deg: levels.iter().fold(0.0, |most, level| most.max(level.1)),
            level: if shown { levels.into_iter().step_by(20).collect() } else { Vec::new() },
        });
    }
    Ok(Run { tilt_deg: config.world.motion.table.tilt_deg, outcomes })
}

fn two_step(config: &SchemeConfig, recording: &Recording, method: Method) -> Option<(Compensation, Vec<Instant>)> {
    let reading = Reading { cos_beta: method == Method::Literal, tilt_leaks: method == Method::TiltLeak };
    let first = step_one(config, recording, reading)?;
    let filtered = filter::run(config, recording, &first);
    let distortion = Matrix3::from_diagonal(&first.scale) * (Matrix3::identity() + filtered.matrix);
    let compensation = Compensation {
        gyro: Correction { bias: first.gyro_bias, matrix: distortion.try_inverse()? },
        accel: first.accel,
        rotation_f_from_b: Matrix3::identity(),
    };
    Some((compensation, filtered.history))
}

/// The comparison method by the device's own code.
fn traditional(recording: &Recording) -> Option<Compensation> {
    let readings = readings(&recording.samples);
    let conditions = Conditions { stops: TurnStops::Fenced, faces: BoxFaces::Square, ..Conditions::CAUTIOUS };
    let session = Session { readings: &readings, origin_s: 0.0, lost: 0, conditions };
    let found = session.run(calibrate::Method::TwoStep(Variant::Traditional), &mut |_| {}).calibration?;
    Some(Compensation::of(&found, Matrix3::identity()))
}

/// `V = SF·A·ω`: rows of the distortion over their length, and these lengths.
fn gyro_errors(recording: &Recording, correction: &Matrix3<f64>) -> Errors {
    let distortion = |correction: &Matrix3<f64>| correction.try_inverse().unwrap_or_else(Matrix3::zeros);
    let found = distortion(correction);
    let truth = distortion(&matrix(&recording.truth.in_box.gyroscope.correction));
    std::array::from_fn(|k| {
        let (i, j) = (k / 3, k % 3);
        let (found, truth) = (found.row(i), truth.row(i));
        if i == j { found.norm() / truth.norm() - 1.0 } else { found[j] / found.norm() - truth[j] / truth.norm() }
    })
}

fn accel_errors(recording: &Recording, correction: &Matrix3<f64>) -> Errors {
    let difference = correction - matrix(&recording.truth.in_box.accelerometer.correction);
    std::array::from_fn(|k| difference[(k / 3, k % 3)])
}
