//! An accepted effect's numbers with their sigmas.

use nalgebra::{DMatrix, DVector};

use super::catalogue::Parameter;
use super::diagnosis::Value;
use super::search::bench::Bench;
use super::search::ledger::{Fit, Ledger};
use super::search::shares::{freed, parameters};
use super::settings;
use super::twin::noise::Noise;
use super::twin::rows::{Class, Rows};

/// θ of an accepted effect: what is in the fit and what was taken out.
pub fn total(bench: &Bench, fit: &Fit, k: usize) -> DVector<f64> {
    let before: usize = (0..k).map(|j| parameters(bench, j)).sum();
    let taken = &bench.accepted[k].taken;
    DVector::from_fn(parameters(bench, k), |i, _| fit.theta[before + i] + taken[i])
}

/// θ of all accepted effects together and its covariance, under `noise` and the prior.
pub fn joint(bench: &mut Bench, noise: Noise) -> (DVector<f64>, DMatrix<f64>) {
    let ids: Vec<&str> = bench.accepted.iter().map(|accepted| bench.candidate(accepted).effect.card.id).collect();
    let terms = bench.accepted_terms(&[]);
    let in_force = std::mem::replace(&mut bench.twin.noise, noise);
    ids.iter().for_each(|id| bench.twin.leave_to_effect(id, true));
    let (ledger, terms) = bench.ledger_of(&terms);
    ids.iter().for_each(|id| bench.twin.leave_to_effect(id, false));
    bench.twin.noise = in_force;
    let fit = ledger.believing(Class::Closure).fit(&terms);
    let theta = (0..ids.len()).flat_map(|k| total(bench, &fit, k).iter().copied().collect::<Vec<f64>>());
    (DVector::from_iterator(fit.theta.len(), theta), fit.covariance)
}

/// An accepted effect's numbers, freed of the prior, under `noise` (see [`posterior::noise`](super::posterior::noise)), and its
/// share in every row.
pub fn shift_values(bench: &mut Bench, rows: &Rows, ledger: &Ledger, noise: Noise, k: usize) -> (Vec<Value>, Vec<f64>) {
    let in_force = std::mem::replace(&mut bench.twin.noise, noise);
    let settled = settings::settle(bench, ledger, k);
    let fit = own_fit(bench, k);
    bench.twin.noise = in_force;
    let total = total(bench, &fit, k);
    let before: usize = (0..k).map(|j| parameters(bench, j)).sum();
    let accepted = &bench.accepted[k];
    let placed = &bench.candidate(accepted).variants[accepted.variant];
    let count = placed.parameters.len();
    let covariance = fit.covariance.view((before, before), (count, count)).into_owned();
    let (own, covariance) = match (&placed.own, &settled) {
        (Some(own), _) => (own * &total, own * covariance * own.transpose()),
        (None, Some(settled)) => (settled.theta.clone(), settled.covariance.clone()),
        (None, None) => (total.clone(), covariance),
    };
    let value = |(i, parameter): (usize, &Parameter)| Value {
        name: parameter.name.clone(),
        value: own[i],
        sigma: covariance[(i, i)].sqrt(),
        unit: parameter.unit.into(),
    };
    let mut values: Vec<Value> = placed.parameters.iter().enumerate().map(value).collect();
    if let Some((name, value, unit)) = placed.setting {
        let (value, sigma) = settled
            .map_or_else(|| (value, settings::sigma(bench, ledger, k)), |settled| (settled.setting, settled.sigma));
        values.push(Value { name: name.into(), value, sigma, unit: unit.into() });
    }
    let signal = (0..rows.at.len())
        .map(|i| placed.columns.clone().enumerate().map(|(j, column)| rows.responses[(i, column)] * total[j]).sum())
        .collect();
    (values, signal)
}

/// The fit whose numbers are stated, freed of the prior. A lever arm and the Earth's rate are states of the calibration as well:
/// what is stated is the whole of them, and its sigma that of the whole, not of how the two share it (1.2 cm, 8.7 deg/h).
fn own_fit(bench: &mut Bench, k: usize) -> Fit {
    let id = bench.candidate(&bench.accepted[k]).effect.card.id;
    let terms = freed(bench.accepted_terms(&[]));
    bench.twin.leave_to_effect(id, true);
    let (ledger, terms) = bench.ledger_of(&terms);
    bench.twin.leave_to_effect(id, false);
    ledger.believing(Class::Closure).fit(&terms)
}

/// A random walk's density: variance it gains in a second.
pub struct WalkDensity {
    /// (rad/s)²/s or (m/s²)²/s.
    pub density: f64,
    /// Sigma of its logarithm.
    pub sigma_log: f64,
}

/// A walk's size by its own likelihood: the maximum, and the curvature in its logarithm. Classes of rows scatter beyond it only
/// where that is certain: noise that is maximised, and may only be larger than believed, took a seventh off a walk's size.
pub fn walk_density(bench: &mut Bench, noise: Noise, gyro: bool) -> WalkDensity {
    let free = freed(bench.accepted_terms(&[]));
    let in_force = bench.twin.noise;
    bench.twin.noise = noise;
    let (ledger, terms) = bench.ledger_of(&free);
    let ledger = ledger.believing(Class::Closure);
    let scales = ledger.certain(&ledger.fit(&terms));
    let mut evidence = |log: f64| {
        bench.twin.noise = noise.with_walk(gyro, noise.walk(gyro) * log.exp());
        bench.ledger_of(&free).0.at(&scales).fit(&terms).evidence
    };
    // Newton's method on a parabola through three points.
    let (mut at, mut sigma_log) = (0.0, 1.0);
    for step in [0.7, 0.4, 0.4] {
        let [low, middle, high] = [at - step, at, at + step].map(&mut evidence);
        let curvature = (2.0 * middle - low - high) / (step * step);
        if curvature <= 0.0 {
            break;
        }
        at += ((high - low) / (2.0 * step) / curvature).clamp(-1.5, 1.5);
        sigma_log = curvature.sqrt().recip();
    }
    bench.twin.noise = in_force;
    WalkDensity { density: at.exp() * noise.walk(gyro), sigma_log }
}

/// The walk's size, `√q`, in its unit.
pub fn walk_value(found: &WalkDensity, unit_si: f64, unit: &str) -> Value {
    let value = found.density.sqrt() / unit_si;
    Value { name: "q".into(), value, sigma: 0.5 * found.sigma_log * value, unit: unit.into() }
}
