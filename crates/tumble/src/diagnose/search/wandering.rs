//! Is what wanders a random walk, or does it only change with time like one?
//!
//! A random walk of the bias has increments that are independent and have the same density at every instant, whatever the box
//! does. What follows the motion (a creep after a new face, a memory of the face before) jumps while the box moves and stays,
//! or relaxes, while it rests: let the density in motion be another than at rest, and the evidence rises. Under a true walk
//! the mean Bayes factor over a grid of other densities exceeds B by chance in at most 1/B of recordings (Markov's inequality).
//!
//! And its innovations at rest are white and normal. What swings leaves a line in their spectrum, what lags leaves neighbours
//! that are alike, what jumps to and fro leaves a few large ones among many small.

use std::collections::BTreeMap;

use super::bench::Bench;
use super::ledger::log_mean;
use super::null::FALSE_ALARMS;
use super::shares;
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
    let terms = bench.accepted_terms(&[]);
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
    let left = innovations(bench, gyro);
    let line = line(&left);
    if line > -FALSE_ALARMS.ln() {
        return Some(("a bias that swings: its innovations have a line in their spectrum", line));
    }
    let alike = alike(&left);
    // Two sides: ln of one over the probability, by erfc's leading term.
    let surprise = 0.5 * alike * alike;
    if libm::erfc(alike.abs() / std::f64::consts::SQRT_2) < FALSE_ALARMS {
        return Some(("a bias whose increments are no accident", surprise));
    }
    let tailed = tailed(&left);
    (tailed > TAILED).then_some(("a bias that jumps: a few increments are far too large", tailed))
}

/// Innovations at rest by channel and stretch: when, s, and over their sigmas.
type Left = BTreeMap<(usize, usize), Vec<(f64, f64)>>;

/// With all that is accepted.
fn innovations(bench: &mut Bench, gyro: bool) -> Left {
    let rows = bench.rows(bench.twin.noise);
    let left = shares::left(bench, &rows);
    let class = if gyro { Class::RestRate } else { Class::RestForce };
    let mut by_place = Left::new();
    for (at, value) in rows.at.iter().zip(&left).filter(|(at, _)| at.class == class) {
        by_place.entry((at.channel, at.stretch)).or_default().push((at.t_s, *value));
    }
    by_place
}

fn mean_power(left: &Left, power: i32) -> f64 {
    let count = left.values().map(Vec::len).sum::<usize>().max(1) as f64;
    left.values().flatten().map(|(_, value)| value.powi(power)).sum::<f64>() / count
}

/// Correlation of neighbours, sigmas.
fn alike(left: &Left) -> f64 {
    let pairs = || left.values().flat_map(|values| values.windows(2));
    let product: f64 = pairs().map(|pair| pair[0].1 * pair[1].1).sum();
    product / (mean_power(left, 2) * (pairs().count().max(1) as f64).sqrt())
}

/// Excess of the fourth moment, sigmas.
fn tailed(left: &Left) -> f64 {
    let count = left.values().map(Vec::len).sum::<usize>() as f64;
    (mean_power(left, 4) / mean_power(left, 2).powi(2) - 3.0) * (count / 24.0).sqrt()
}

/// Shortest period that is looked at, s: ten rows.
const SHORTEST_S: f64 = 5.0;

/// ln of one over the probability that white noise has a line as strong as the strongest one here. At each of the frequencies
/// k/2T a sine and a cosine are fitted to each channel: what that takes from the sum of squares is χ²₂, over three channels
/// χ²₆; Bonferroni over frequencies and the four ways of looking.
fn line(left: &Left) -> f64 {
    let mut channels: BTreeMap<usize, Vec<(f64, f64)>> = BTreeMap::new();
    for ((channel, _), values) in left {
        channels.entry(*channel).or_default().extend(values);
    }
    let times = || left.values().flatten().map(|(t_s, _)| *t_s);
    let length_s = times().fold(0.0, f64::max) - times().fold(f64::INFINITY, f64::min);
    let square = mean_power(left, 2);
    if !(length_s > 2.0 * SHORTEST_S && square > 0.0) {
        return 0.0;
    }
    let frequencies = (2.0 * length_s / SHORTEST_S) as usize;
    let surprise = (2..=frequencies).map(|k| {
        let w = std::f64::consts::PI * k as f64 / length_s;
        let gains: Vec<f64> = channels.values().map(|values| sinusoid(values, w) / square).collect();
        let half = 0.5 * gains.iter().sum::<f64>();
        let all = half - (1.0 + half + 0.5 * half * half).ln();
        gains.iter().map(|gain| 0.5 * gain).fold(all, f64::max)
    });
    surprise.fold(0.0, f64::max) - (4.0 * frequencies as f64).ln()
}

/// What a sine and a cosine of angular frequency `w` take from the sum of squares.
fn sinusoid(values: &[(f64, f64)], w: f64) -> f64 {
    let (mut gram, mut with) = (nalgebra::Matrix2::zeros(), nalgebra::Vector2::zeros());
    for (t_s, value) in values {
        let column = nalgebra::Vector2::new((w * t_s).sin(), (w * t_s).cos());
        gram += column * column.transpose();
        with += column * *value;
    }
    gram.cholesky().map_or(0.0, |factor| with.dot(&factor.solve(&with)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rests of 4 s every 16 s, eight rows each; a uniform generator's sums of twelve for normal values.
    fn rests(swing: f64) -> Left {
        let mut state = 12345u64;
        let mut uniform = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut left = Left::new();
        for channel in 0..3 {
            for stretch in 0..18 {
                let rows = (0..8).map(|row| {
                    let t_s = 16.0 * stretch as f64 + 0.5 * f64::from(row);
                    let noise = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
                    (t_s, noise + swing * (std::f64::consts::TAU * t_s / 37.0).sin())
                });
                left.insert((channel, stretch), rows.collect());
            }
        }
        left
    }

    #[test]
    fn a_line_shows_and_white_noise_has_none() {
        assert!(line(&rests(0.0)) < -FALSE_ALARMS.ln(), "{}", line(&rests(0.0)));
        assert!(line(&rests(0.5)) > -FALSE_ALARMS.ln(), "{}", line(&rests(0.5)));
    }
}
