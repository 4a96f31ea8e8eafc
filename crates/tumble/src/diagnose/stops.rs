//! How well turns end, given what was found: numbers and sigmas that rest on whole turns need to know.
//!
//! The search takes stops for what their owner says or for what the board's estimator took them for, whichever has more evidence
//! (`Noise::trusting`): the one is a guess, and in the other an effect passes for sloppy stops. A sigma that rests on 12
//! closures is wrong by as much. The truth of a fence of ±0.1° is 0.058°; taken for 0.05°, an asymmetry of the scale was off by
//! 1.17 sigmas, 1.0 wanted. Here the variance of a stop has its own posterior beside the accepted effects, over a grid in the
//! logarithm, uniform there. All variances are linear in it, so its mean stands for it, as in the device's `closures.rs`.

use tumble_core::setup::TurnStops;

use super::search::bench::Bench;
use super::search::ledger::{Ledger, Term};
use super::search::shares::freed;
use super::twin::noise::Noise;
use super::twin::rows::Class;

/// Steps of √2 from the least sigma, deg: to 0.4° against a fence, to 9° by hand.
const STEPS: i32 = 11;
const LEAST_FENCED_DEG: f64 = 0.0125;
const LEAST_BY_HAND_DEG: f64 = 0.28;

/// The noise in force with stops as the accepted effects leave them.
pub fn settled(bench: &mut Bench) -> Noise {
    let noise = bench.twin.noise;
    let terms = freed(bench.accepted_terms(None));
    let columns: Vec<usize> = terms.iter().map(|term| term.column).collect();
    let local: Vec<Term> = terms.iter().enumerate().map(|(column, term)| Term { column, ..*term }).collect();
    let least = if bench.twin.stops == TurnStops::Fenced { LEAST_FENCED_DEG } else { LEAST_BY_HAND_DEG };
    let sigma = |step: i32| least.to_radians() * 2f64.powf(0.5 * f64::from(step));
    let mut weighed: Vec<(f64, f64)> = Vec::new();
    for step in 0..STEPS {
        bench.twin.noise = Noise { stop_sigma_rad: sigma(step), ..noise };
        let rows = bench.rows_of(&columns);
        if !rows.at.iter().any(|at| at.class == Class::Closure) {
            break;
        }
        weighed.push((sigma(step).powi(2), Ledger::new(&rows, |_| true).believing(Class::Closure).fit(&local).evidence));
    }
    bench.twin.noise = noise;
    mean(&weighed).map_or(noise, |variance| Noise { stop_sigma_rad: variance.sqrt(), ..noise })
}

/// Mean of values by their evidence; none of none.
fn mean(weighed: &[(f64, f64)]) -> Option<f64> {
    let most = weighed.iter().map(|one| one.1).fold(f64::NEG_INFINITY, f64::max);
    let share = |evidence: f64| (evidence - most).exp();
    let sum: f64 = weighed.iter().map(|one| share(one.1)).sum();
    (sum > 0.0 && most.is_finite()).then(|| weighed.iter().map(|one| one.0 * share(one.1)).sum::<f64>() / sum)
}
