//! What follows from a diagnosis: an effect that a calibration can carry is fitted, taken out of the readings, and the rest is
//! calibrated as ever.
//!
//! `ideal = correction · (raw − bias − effect)`: the effect's numbers stand beside the calibration's, in raw units.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use tumble_core::estimate::Conditions;

use super::catalogue::Parameter;
use super::diagnosis::Value;
use super::intake::intake;
use super::numbers;
use super::options::Options;
use super::posterior;
use super::search::bench::{Accepted, Bench};
use super::search::ledger::Ledger;
use super::search::shares::parameters;
use super::twin::influence::Push;
use super::twin::trajectory::mean_temperature;
use crate::recording::{Reading, Recording};

/// Effects that depend on nothing but what a reading comes with: force, temperature, rate.
pub const CARRIED: [&str; 7] = [
    "gyro_g_sensitivity",
    "gyro_bias_temperature",
    "gyro_scale_temperature",
    "accel_bias_temperature",
    "accel_scale_temperature",
    "gyro_accel_lag",
    "accel_lever_arm",
];

/// An effect with its numbers, as the calibration's JSON has it under `with`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Carried {
    /// As in the contract.
    pub id: String,
    /// As a formula.
    pub equation: String,
    /// Of the formula.
    pub parameters: Vec<Value>,
    /// Mean temperature that slopes are about, °C; null where the recording has none.
    pub about_degc: Option<f64>,
}

/// What is taken out of a recording's readings.
pub struct Carry {
    /// The effects with their numbers.
    pub effects: Vec<Carried>,
    /// What may be wrong with it, one sigma each, independent of each other: the sizes' covariance by its principal axes, and what each is
    /// of every reading.
    doubts: Vec<Vec<Push>>,
}

impl Carry {
    /// The same readings, had the effects been larger by one sigma along each of the principal axes.
    pub fn doubtful<'a>(&'a self, readings: &'a [Reading]) -> impl ExactSizeIterator<Item = Vec<Reading>> + 'a {
        self.doubts.iter().map(|pushes| {
            let mut readings = readings.to_vec();
            take_off(&mut readings, pushes.iter().copied());
            readings
        })
    }
}

/// Fits the effects to the recording, what ails its samples put right or masked, and takes them out of `readings`, which are the
/// recording's, mended or rounded. Those of `beside` are fitted with them, so that they are not blamed on them, and stay where they are.
///
/// Sizes are those of the posterior: where a recording hardly tells them, the prior (what is typical) keeps them near nothing.
///
/// # Errors
/// An effect that cannot be carried, or cannot show in this recording: in words.
pub fn carry(
    recording: &Recording,
    conditions: Conditions,
    ids: &[String],
    beside: &[String],
    readings: &mut [Reading],
) -> Result<Carry, String> {
    if let Some(id) = ids.iter().find(|id| !CARRIED.contains(&id.as_str())) {
        return Err(format!("--with {id}: a calibration can carry {}", CARRIED.join(", ")));
    }
    let taken = intake(recording, &Options { without: Vec::new(), seed: 1, conditions: Some(conditions) });
    if taken.gated.remap.is_some() {
        let why = "axes or ranges of the two triads do not belong together; put them right in the recording first";
        return Err(format!("--with: {why} (`tumble diagnose` says which)"));
    }
    let prepared = taken.prepared.map_err(|why| format!("--with: {why}"))?;
    let mut bench = Bench::new(prepared.twin, &[]);
    let noise = bench.twin.noise;
    let rows = bench.rows(noise);
    let ledger = Ledger::new(&rows, |_| true);
    for id in ids {
        let accepted = accept(&bench, &ledger, id)?;
        bench.accepted.push(accepted);
    }
    // A walk is noise and has no size to be fitted.
    let sized = |accepted: &Accepted| bench.placed(accepted).is_some();
    let beside = beside.iter().filter(|id| !ids.contains(id)).filter_map(|id| accept(&bench, &ledger, id).ok());
    let beside: Vec<Accepted> = beside.filter(sized).collect();
    bench.accepted.extend(beside);
    bench.refit();
    let settled = posterior::noise(&mut bench);
    let (sizes, covariance) = numbers::joint(&mut bench, settled);
    // Theirs come first.
    let count = (0..ids.len()).map(|k| parameters(&bench, k)).sum();
    let (sizes, covariance) = (sizes.rows(0, count).into_owned(), covariance.view((0, 0), (count, count)).into_owned());
    take_off(readings, bench.pushes(sizes.as_slice()));
    Ok(Carry { effects: effects(&bench, ids, &sizes, &covariance), doubts: doubts(&bench, covariance) })
}

fn effects(bench: &Bench, ids: &[String], sizes: &DVector<f64>, covariance: &DMatrix<f64>) -> Vec<Carried> {
    let temperature = mean_temperature(&bench.original);
    let mut next = 0;
    let carried = ids.iter().zip(&bench.accepted).map(|(id, accepted)| {
        let parameters = bench.placed(accepted).map_or(&[][..], |placed| &placed.parameters);
        let first = next;
        next += parameters.len();
        let value = |(parameter, k): (&Parameter, usize)| Value {
            name: parameter.name.clone(),
            value: sizes[k],
            sigma: covariance[(k, k)].sqrt(),
            unit: parameter.unit.into(),
        };
        Carried {
            id: id.clone(),
            equation: bench.candidate(accepted).effect.card.equation.into(),
            parameters: parameters.iter().zip(first..).map(value).collect(),
            about_degc: temperature.is_finite().then_some(temperature),
        }
    });
    carried.collect()
}

/// By principal axes.
fn doubts(bench: &Bench, covariance: DMatrix<f64>) -> Vec<Vec<Push>> {
    let principal = covariance.symmetric_eigen();
    let axes = principal.eigenvectors.column_iter().zip(principal.eigenvalues.iter());
    let sigmas = axes.map(|(axis, variance)| axis * variance.max(0.0).sqrt());
    sigmas.map(|sigma| bench.pushes(sigma.as_slice()).collect()).collect()
}

fn take_off(readings: &mut [Reading], pushes: impl Iterator<Item = Push>) {
    for (reading, push) in readings.iter_mut().zip(pushes) {
        reading.sample.angular_rate_rad_s -= push.rate.cast::<f32>();
        reading.sample.specific_force_mps2 -= push.force.cast::<f32>();
    }
}

fn accept(bench: &Bench, ledger: &Ledger, id: &str) -> Result<Accepted, String> {
    let candidate = bench
        .candidates
        .iter()
        .position(|candidate| candidate.effect.card.id == id)
        .ok_or_else(|| format!("--with {id}: no such effect"))?;
    if let Some(why) = bench.candidates[candidate].absent {
        return Err(format!("--with {id}: it cannot show in this recording: {why}"));
    }
    let (_, variant, widening) = bench.weigh(ledger, &[], candidate);
    let parameters = bench.candidates[candidate].variants.get(variant).map_or(0, |v| v.parameters.len());
    Ok(Accepted { candidate, variant, widening, taken: vec![0.0; parameters] })
}

/// g-sensitivity as the calibration's own fields have it, with its sigma: rad/s per m/s², row the gyroscope's axis.
pub fn g_sensitivity(carried: &[Carried]) -> Option<[[[f32; 3]; 3]; 2]> {
    let effect = carried.iter().find(|carried| carried.id == "gyro_g_sensitivity")?;
    let unit = super::catalogue::DPS / super::catalogue::G;
    let of = |what: fn(&Value) -> f64| {
        let element = |k: usize| effect.parameters.get(k).map_or(0.0, |value| (what(value) * unit) as f32);
        std::array::from_fn(|i| std::array::from_fn(|j| element(3 * i + j)))
    };
    Some([of(|value| value.value), of(|value| value.sigma)])
}
