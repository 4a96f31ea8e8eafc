//! The table rocks all the time (`table_rocking`).
//!
//! Statistic: at frequencies from 0.3 to 4 Hz, a sine fitted to every rest of at least one period; the gyroscope's power across gravity
//! (a table leans about level axes), mean over R rests, against white noise p, the median over all frequencies up to 8 Hz, and 1/f
//! noise with a corner of 0.6 Hz: p·(1 + 0.6/f), ten times what healthy biases have (10 °/h). That is χ² of 4R over its mean,
//! its tail Chernoff's over all frequencies, at e⁻¹¹·⁵. Then it must be a table's: at 0.6 Hz off (or what rests resolve) it has
//! fallen to a third, and either
//!
//! - the accelerometer confirms it: a lean θ = ω/(2πif) about a level axis h, h metres up, shows as (g + h(2πf)²)·θ across it. Direction,
//!   phase and frequency are the gyroscope's, so one number c is left, fitted to all rests, 1 for a pivot at the sensor: it
//!   must be above 4 sigmas and at most 1.5 times that of a pivot 2 m below; or
//! - the rate keeps level on rests whose gravity points along three axes, which a line of the electronics does not: its power along
//!   gravity is then a third of all; the gate wants less than a sixth, and c not below 1 by more than 3 sigmas.
//!
//! Limit: at 0.3 Hz, or where rests are shorter at the lowest that they hold, the hardest: λ seen in 95 of 100 (non-central χ²),
//! A = √(2·p·λ/N)/(2πf); at least so large that the accelerometer's c stands out by 4 + 1.645 sigmas where rests do not show three axes.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::chance::{LN_ALARM, SURE, ln_mean_square_tail, mean_square_quantile, median, shift_seen};
use super::spectrum::Taper;
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::{Rest, View};
use crate::diagnose::catalogue::Card;
use crate::recording::STANDARD_GRAVITY_MPS2 as G;

const LEAST_HZ: f64 = 0.3;
const MOST_HZ: f64 = 4.0;
const STEP_HZ: f64 = 0.1;
/// What samples are averaged over, s.
const BLOCK_S: f64 = 0.05;
/// For the floor.
const FLOOR_HZ: f64 = 8.0;
/// Highest pivot below the sensor, m.
const PIVOT_M: f64 = 2.0;
/// Where 1/f noise of the worst bias that is healthy equals the white.
const CORNER_HZ: f64 = 0.6;
/// Quarters at either end of a rest count less: what a hand leaves behind as it goes is no rocking.
const TAPER: f64 = 0.25;
/// Sigmas by which the accelerometer confirms.
const CONFIRMED: f64 = 4.0;

pub(super) const CARD: Card = Card {
    id: "table_rocking",
    name: "table rocks",
    equation: "R_table = R(h, A·sin(2πft + φ)): rate and gravity's direction swing together",
    typical: "0.001 to 0.1 degrees at 0.3 to 2 Hz of tables on soft floors",
    shows: "gyro and accelerometer at rest",
    confounded: &["vibration_line", "gyro_bias_random_walk", "accel_bias_random_walk"],
    separate_by: "put the box on a stone floor",
};

/// Sines fitted to all rests at one frequency.
struct Swing {
    hz: f64,
    rests: f64,
    /// Samples in them, (Σw)²/Σw².
    samples: f64,
    /// Gyroscope's power across gravity and along it, the accelerometer's across, (°/s)² and g², amplitudes squared.
    across: f64,
    along: f64,
    force: f64,
    /// Of the force on the one that a lean predicts, and the prediction's own square, summed over samples, g² and rad²·g².
    product: f64,
    square: f64,
}

/// One rest, a mean every 50 ms.
struct Quiet {
    dt_s: f64,
    up: Vector3<f64>,
    means: Vec<[f64; 6]>,
    taper: Taper,
}

/// The gate; hands that hold the box (`trembling`) sway it as a table does.
pub fn examine(view: &View, trembling: bool) -> Outcome {
    if trembling {
        return Outcome { limit: untestable(&CARD, "deg", "hands hold the box at rest"), ..Outcome::default() };
    }
    let rests: Vec<Quiet> = view.rests.iter().map(|rest| decimated(view, rest)).collect();
    let swings: Vec<Swing> = (0..)
        .map(|k| LEAST_HZ + STEP_HZ * f64::from(k))
        .take_while(|hz| *hz < FLOOR_HZ.min(0.4 / view.dt_s))
        .filter_map(|hz| swing(&rests, hz))
        .collect();
    if swings.len() < 10 {
        return Outcome { limit: untestable(&CARD, "deg", "no rests that are long enough"), ..Outcome::default() };
    }
    let white = Noise::of(&swings);
    let ln_alarm = LN_ALARM - (swings.len() as f64).ln();
    let ratio = |swing: &Swing| swing.across / white.across(swing.hz);
    let ln_p = |swing: &Swing| ln_mean_square_tail(ratio(swing), 4.0 * swing.rests);
    let (level, least_deg) = (axes(&rests) >= 3, least_deg(&swings[0], &white, ln_alarm));
    let confirmed_deg = (CONFIRMED + SURE) * (white.force / swings[0].samples).sqrt().to_degrees();
    let least_deg = if level { least_deg } else { least_deg.max(confirmed_deg) };
    let why = format!("at {:.1} Hz; less at more", swings[0].hz);
    let mut outcome = Outcome { limit: limit(&CARD, least_deg, "deg", &why), ..Outcome::default() };
    let slow = swings.iter().filter(|swing| swing.hz <= MOST_HZ && ln_p(swing) < ln_alarm);
    let best = slow.filter(|swing| narrow(&swings, swing)).min_by(|a, b| ln_p(a).total_cmp(&ln_p(b)));
    let Some(best) = best else { return outcome };
    if leans(best, &white, level) {
        let excess = (best.across - white.across(best.hz)).max(0.0);
        let amplitude_deg = excess.sqrt() / (TAU * best.hz);
        let share = (white.across(best.hz) / excess.max(1e-30) / best.rests).sqrt();
        let parameters = vec![
            value("amplitude", amplitude_deg, amplitude_deg * (0.5 * share + 0.05), "deg"),
            value("frequency", best.hz, 0.5 * STEP_HZ, "Hz"),
        ];
        outcome.found = Some(found(&CARD, -ln_p(best), parameters, view.everywhere()));
    }
    outcome
}

/// Power of white noise in a fitted sine: means over rests, by median over frequencies.
struct Noise {
    white: f64,
    along: f64,
    /// Of one sample of one axis, g²: a fitted amplitude has 4/N of it.
    force: f64,
}

impl Noise {
    fn of(swings: &[Swing]) -> Self {
        let usual = |of: fn(&Swing) -> f64| median(swings.iter().map(of).collect()).max(1e-30);
        let force = usual(|swing| swing.force * swing.samples / swing.rests) / 4.0;
        Self { white: usual(|swing| swing.across), along: usual(|swing| swing.along), force }
    }

    fn across(&self, hz: f64) -> f64 {
        self.white * (1.0 + CORNER_HZ / hz)
    }
}

/// Whether it is a table that leans.
fn leans(best: &Swing, white: &Noise, level: bool) -> bool {
    let gain = best.product / best.square.max(1e-30);
    // A fitted amplitude of one axis has 2/N of a sample's variance, and products are weighted by N.
    let sigma = (2.0 * white.force / best.square.max(1e-30)).sqrt();
    let most = 1.5 * (1.0 + PIVOT_M * (TAU * best.hz).powi(2) / G);
    let confirmed = gain > CONFIRMED * sigma && (0.6..most).contains(&gain);
    let excess = |power: f64, noise: f64| (power - noise * (1.0 + CORNER_HZ / best.hz)).max(0.0);
    let (across, along) = (excess(best.across, white.white), excess(best.along, white.along));
    let keeps_level = level && along < (across + along) / 6.0 && gain + 3.0 * sigma > 1.0 && gain - 3.0 * sigma < most;
    confirmed || keeps_level
}

/// Axes of the sensor along which gravity points at rest.
fn axes(rests: &[Quiet]) -> usize {
    let along = |axis: usize| rests.iter().any(|rest| rest.up[axis].abs() > 0.8);
    (0..3).filter(|axis| along(*axis)).count()
}

/// The smallest lean at this frequency that the rates show in 95 of 100, °.
fn least_deg(swing: &Swing, white: &Noise, ln_alarm: f64) -> f64 {
    let freedom = 4.0 * swing.rests;
    let needed = shift_seen(freedom * mean_square_quantile(ln_alarm, freedom), freedom);
    (white.across(swing.hz) * needed / freedom).sqrt() / (TAU * swing.hz)
}

/// A table swings at one frequency; a hand sways at all: 0.6 Hz off, or 1.3 times what the rests resolve, it has fallen to a
/// third.
fn narrow(swings: &[Swing], best: &Swing) -> bool {
    let resolved_hz = best.rests / (best.samples * BLOCK_S);
    let far_hz = (1.3 * resolved_hz).max(0.6);
    let off = |by: f64| swings.iter().find(|swing| (swing.hz - best.hz - by).abs() <= 0.5 * STEP_HZ);
    [-far_hz, far_hz].into_iter().filter_map(off).all(|swing| swing.across < 0.35 * best.across)
}

/// Means over 50 ms, less the rest's mean, with their spacing.
fn decimated(view: &View, rest: &Rest) -> Quiet {
    let every = view.count(BLOCK_S);
    let count = rest.samples.len() / every;
    let mut means = vec![[0.0; 6]; count];
    for (c, channel) in view.channels.iter().enumerate() {
        let values = &channel[rest.samples.clone()];
        let mean = values[..count * every].iter().sum::<f64>() / (count * every).max(1) as f64;
        for (out, block) in means.iter_mut().zip(values.chunks_exact(every)) {
            out[c] = block.iter().sum::<f64>() / every as f64 - mean;
        }
    }
    let taper = Taper::new(count, TAPER);
    Quiet { dt_s: every as f64 * view.dt_s, up: rest.force.normalize(), means, taper }
}

/// Over rests of at least one period, weighted by length.
fn swing(rests: &[Quiet], hz: f64) -> Option<Swing> {
    let mut all =
        Swing { hz, rests: 0.0, samples: 0.0, across: 0.0, along: 0.0, force: 0.0, product: 0.0, square: 0.0 };
    for rest in rests.iter().filter(|rest| rest.dt_s * rest.means.len() as f64 * hz >= 1.0) {
        let count = rest.taper.gain();
        let mut sums = [[Vector3::zeros(); 2]; 2];
        for (k, values) in rest.means.iter().enumerate() {
            let (sin, cos) = (TAU * hz * rest.dt_s * k as f64).sin_cos();
            let weight = 2.0 * rest.taper.weights[k] / rest.taper.sum;
            let (sin, cos) = (sin * weight, cos * weight);
            for (triad, sums) in sums.iter_mut().enumerate() {
                let value = Vector3::new(values[3 * triad], values[3 * triad + 1], values[3 * triad + 2]);
                sums[0] += value * cos;
                sums[1] += value * sin;
            }
        }
        let across = |v: &Vector3<f64>| v - rest.up * rest.up.dot(v);
        let rate = sums[0].map(|v| across(&v));
        let force = sums[1].map(|v| across(&v));
        // x = a·cos + b·sin has the integral (−b·cos + a·sin)/ω; up turns to up − θ×up in the sensor's axes.
        let lean = [-rate[1], rate[0]].map(|v| v * (1f64.to_radians() / (TAU * hz)));
        let predicted = lean.map(|lean| rest.up.cross(&lean));
        all.across += count * rate.iter().map(Vector3::norm_squared).sum::<f64>();
        all.along += count * sums[0].iter().map(|v| rest.up.dot(v).powi(2)).sum::<f64>();
        all.force += count * force.iter().map(Vector3::norm_squared).sum::<f64>();
        all.product += count * (0..2).map(|k| predicted[k].dot(&force[k])).sum::<f64>();
        all.square += count * predicted.iter().map(Vector3::norm_squared).sum::<f64>();
        all.rests += 1.0;
        all.samples += count;
    }
    let share = 1.0 / all.samples;
    (all.rests >= 2.0).then_some(Swing {
        across: all.across * share,
        along: all.along * share,
        force: all.force * share,
        ..all
    })
}
