//! Is what wanders a random walk, or does it only change with time like one?
//!
//! A random walk of the bias has increments that are independent and have the same density at every instant, whatever the box
//! does. What follows the motion (a creep after a new face, a memory of the face before) jumps while the box moves and stays,
//! or relaxes, while it rests: let the density in motion be another than at rest, and the evidence rises. Under a true walk
//! the mean Bayes factor over a grid of other densities exceeds B by chance in at most 1/B of recordings (Markov's inequality).
//!
//! And its innovations at rest are white and normal. What swings leaves neighbours that are alike, what jumps to and fro leaves
//! a few large ones among many small.

use std::collections::BTreeMap;

use super::bench::Bench;
use super::ledger::log_mean;
use super::null::FALSE_ALARMS;
use crate::diagnose::held_out;
use crate::diagnose::twin::noise::Noise;
use crate::diagnose::twin::rows::Class;

/// Density at rest over the one that was found.
const AT_REST: [f64; 4] = [1.0 / 256.0, 1.0 / 16.0, 0.25, 1.0];
/// Density in motion over that at rest. Motion is a third of a session, so that the product with the above covers what the
/// found density can have averaged.
const IN_MOTION: [f64; 6] = [1.0 / 64.0, 1.0 / 8.0, 8.0, 64.0, 512.0, 4096.0];

/// ln of the mean Bayes factor of densities that depend on motion, against the walk that was accepted.
fn depends_on_motion(bench: &mut Bench, gyro: bool) -> f64 {
    let found = bench.twin.noise;
    let terms = bench.accepted_terms(None);
    let at = |rest: f64, motion: f64| {
        let mut noise = Noise { walk_in_motion: [1.0; 2], ..found };
        noise.walk_in_motion[usize::from(!gyro)] = motion;
        if gyro {
            noise.bias_walk *= rest;
        } else {
            noise.force_walk *= rest;
        }
        noise
    };
    // The walk at its own best of the same densities, so that both are free in the same way.
    let walk = AT_REST.iter().chain(&[4.0]).map(|rest| bench.fit_alone(at(*rest, 1.0), &terms).evidence);
    let walk = walk.fold(f64::NEG_INFINITY, f64::max);
    let grid = AT_REST.iter().flat_map(|rest| IN_MOTION.iter().map(move |motion| (*rest, *motion)));
    let others: Vec<f64> = grid.map(|(rest, motion)| bench.fit_alone(at(rest, motion), &terms).evidence).collect();
    bench.twin.noise = found;
    log_mean(&others) - walk
}

/// Largest excess of the fourth moment, in its sigmas √(24/N): the distribution has a long tail to this side, and at N = 500
/// one in ten thousand normal samples is beyond 5.
const TAILED: f64 = 5.0;

/// Why a walk that was accepted is none, and the ln of the odds; none if it stands.
pub fn refute(bench: &mut Bench, gyro: bool) -> Option<(&'static str, f64)> {
    let gain = depends_on_motion(bench, gyro);
    if gain > -FALSE_ALARMS.ln() {
        return Some(("a bias that changes with the motion, not with time alone", gain));
    }
    let (alike, tailed) = innovations(bench, gyro);
    // Two sides: ln of one over the probability, by erfc's leading term.
    let surprise = 0.5 * alike * alike;
    if libm::erfc(alike.abs() / std::f64::consts::SQRT_2) < FALSE_ALARMS {
        return Some(("a bias that swings: its increments are no accident", surprise));
    }
    (tailed > TAILED).then_some(("a bias that jumps: a few increments are far too large", tailed))
}

/// Of the innovations at rest with all that is accepted: correlation of neighbours, and excess of the fourth moment, both in
/// sigmas.
fn innovations(bench: &mut Bench, gyro: bool) -> (f64, f64) {
    let noise = bench.twin.noise;
    let rows = bench.rows(noise);
    let left = held_out::left(bench, &rows);
    let class = if gyro { Class::RestRate } else { Class::RestForce };
    let mut by_place: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
    for (at, value) in rows.at.iter().zip(&left).filter(|(at, _)| at.class == class) {
        by_place.entry((at.channel, at.stretch)).or_default().push(*value);
    }
    let all = || by_place.values().flatten();
    let count = all().count().max(1) as f64;
    let square = all().map(|v| v * v).sum::<f64>() / count;
    let fourth = all().map(|v| v.powi(4)).sum::<f64>() / count;
    let pairs = || by_place.values().flat_map(|values| values.windows(2));
    let product: f64 = pairs().map(|pair| pair[0] * pair[1]).sum();
    let alike = product / (square * (pairs().count().max(1) as f64).sqrt());
    (alike, (fourth / (square * square) - 3.0) * (count / 24.0).sqrt())
}
