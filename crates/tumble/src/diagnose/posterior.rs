//! Noise given what was found: numbers and their sigmas rest on it.
//!
//! The search takes the noise that has most evidence, of a few: stops for what their owner says or for what the board's
//! estimator took them for (`Noise::trusting`; the one is a guess, in the other an effect passes for sloppy stops), biases that
//! wander by one of three healthy levels. That is good enough to compare models, which all have it. A sigma that rests on 12
//! closures is wrong by as much: the truth of a fence of ±0.1° is 0.058°, and taken for 0.05° an asymmetry of the scale was off
//! by 1.11 sigmas (root mean square) where nothing but stops disturbed it, by 0.65 where they were exact. So each variance has a posterior of its own
//! beside the accepted effects, over a grid uniform in its logarithm. All covariances are linear in it, so that its mean stands for it,
//! as in the device's `closures.rs`.

use tumble_core::setup::TurnStops;

use super::search::bench::{Bench, HEALTHY};
use super::search::ledger::posterior;
use super::search::shares::freed;
use super::twin::noise::{Noise, PIVOT_SIGMA_M, walk_floor};
use super::twin::rows::Class;

/// Steps of √2 from the least sigma of a stop, deg: to 0.4° against a fence, to 9° by hand.
const STOP_STEPS: i32 = 11;
const LEAST_FENCED_DEG: f64 = 0.0125;
const LEAST_BY_HAND_DEG: f64 = 0.28;
/// Steps by 10^(1/3) in variance over what a healthy bias wanders.
const WALK_STEPS: i32 = 7;
/// Halves of twice what a turn's axis is taken to move: 10 mm to 0.3 mm. Only a lever arm's numbers rest on it.
const PIVOT_STEPS: i32 = 6;

/// The noise in force, with stops and healthy wander as the accepted effects leave them.
pub fn noise(bench: &mut Bench) -> Noise {
    let in_force = bench.twin.noise;
    let least_deg = if bench.twin.stops == TurnStops::Fenced { LEAST_FENCED_DEG } else { LEAST_BY_HAND_DEG };
    let stop = |step: i32| (least_deg.to_radians() * 2f64.powf(0.5 * f64::from(step))).powi(2);
    let mut noise = in_force;
    noise.stop_sigma_rad =
        mean(bench, (0..STOP_STEPS).map(stop), |variance| Noise { stop_sigma_rad: variance.sqrt(), ..noise })
            .map_or(noise.stop_sigma_rad, f64::sqrt);
    let levels = |floor: f64| {
        let whole = (HEALTHY[2] / HEALTHY[0]).ln() / f64::from(WALK_STEPS - 1);
        (0..WALK_STEPS).map(move |step| floor * (whole * f64::from(step)).exp())
    };
    for gyro in [true, false] {
        if !bench.wanders(gyro) {
            let found = mean(bench, levels(walk_floor(gyro)), |walk| noise.with_walk(gyro, walk));
            noise = noise.with_walk(gyro, found.unwrap_or(noise.walk(gyro)));
        }
    }
    let levers = ["accel_lever_arm", "accel_internal_lever_arms"];
    if bench.accepted.iter().any(|accepted| levers.contains(&bench.candidate(accepted).effect.card.id)) {
        let pivot = |step: i32| (PIVOT_SIGMA_M * 2f64.powi(1 - step)).powi(2);
        let found =
            mean(bench, (0..PIVOT_STEPS).map(pivot), |variance| Noise { pivot_sigma_m: variance.sqrt(), ..noise });
        noise.pivot_sigma_m = found.map_or(noise.pivot_sigma_m, f64::sqrt);
    }
    bench.twin.noise = in_force;
    noise
}

/// Mean of a variance by the evidence of the noise that it makes; none where the rows break down.
fn mean(bench: &mut Bench, variances: impl Iterator<Item = f64>, noise: impl Fn(f64) -> Noise) -> Option<f64> {
    let terms = freed(bench.accepted_terms(&[]));
    let variances: Vec<f64> = variances.collect();
    let evidence = variances.iter().map(|variance| {
        bench.twin.noise = noise(*variance);
        let (ledger, terms) = bench.ledger_of(&terms);
        ledger.believing(Class::Closure).fit(&terms).evidence
    });
    let shares = posterior(evidence)?;
    Some(variances.iter().zip(shares).map(|(variance, share)| variance * share).sum())
}
