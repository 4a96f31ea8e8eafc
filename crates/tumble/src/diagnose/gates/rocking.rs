//! The table rocks all the time (`table_rocking`).
//!
//! Statistic: at frequencies from 0.3 to 4 Hz, a sine fitted to every rest of at least one period, gyroscope and accelerometer
//! apart; the mean of its power over rests and axes against its median over all frequencies up to 8 Hz. Under white noise either
//! is a mean of 2·3·R squared normals over R rests. 1/f noise of a healthy bias (10 °/h, 40 µg) adds less than a half
//! below 0.5 Hz, so the quantile at e⁻¹¹·⁵ is taken three times. Both must be beyond it at the same frequency, and fit
//! each other: a table that leans by θ = ω/(2πf) about an axis h below shows g·θ + h(2πf)²θ, with h from 0 to 2 m. Noise
//! of gyroscope and accelerometer is independent: the false-alarm rate is the product of both, e⁻²³.

use std::f64::consts::TAU;

use super::chance::{LN_ALARM, ln_mean_square_tail, mean_square_quantile, median};
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::{Rest, View};
use crate::diagnose::catalogue::Card;
use crate::recording::STANDARD_GRAVITY_MPS2 as G;

const LEAST_HZ: f64 = 0.3;
const MOST_HZ: f64 = 4.0;
const STEP_HZ: f64 = 0.1;
/// For the floor.
const FLOOR_HZ: f64 = 8.0;
/// Highest pivot below the sensor, m.
const PIVOT_M: f64 = 2.0;
const ONE_OVER_F: f64 = 3.0;

pub(super) const CARD: Card = Card {
    id: "table_rocking",
    name: "table rocks",
    equation: "R_table = R(h, A·sin(2πft + φ)): rate and gravity's direction swing together",
    typical: "0.001 to 0.1 degrees at 0.3 to 2 Hz of tables on soft floors",
    shows: "gyro and accelerometer at rest",
    confounded: &["vibration_line", "gyro_bias_random_walk", "accel_bias_random_walk"],
    separate_by: "put the box on a stone floor",
};

/// Power of fitted sines at one frequency.
struct Swing {
    hz: f64,
    rests: f64,
    gyro: f64,
    accel: f64,
}

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let rests: Vec<(f64, Vec<[f64; 6]>)> = view.rests.iter().map(|rest| decimated(view, rest)).collect();
    let swings: Vec<Swing> = (0..)
        .map(|k| LEAST_HZ + STEP_HZ * f64::from(k))
        .take_while(|hz| *hz < FLOOR_HZ.min(0.4 / view.dt_s))
        .filter_map(|hz| swing(&rests, hz))
        .collect();
    if swings.len() < 10 {
        return Outcome { limit: untestable(&CARD, "deg", "no rests that are long enough"), ..Outcome::default() };
    }
    let gyro_floor = median(swings.iter().map(|swing| swing.gyro).collect());
    let accel_floor = median(swings.iter().map(|swing| swing.accel).collect());
    let ratio = |swing: &Swing| (swing.gyro / gyro_floor.max(1e-30), swing.accel / accel_floor.max(1e-30));
    let best = swings
        .iter()
        .filter(|swing| swing.hz <= MOST_HZ)
        .max_by(|a, b| (ratio(a).0 * ratio(a).1).total_cmp(&(ratio(b).0 * ratio(b).1)));
    let Some(best) = best else { return Outcome::default() };
    let (gyro, accel) = ratio(best);
    let freedom = 6.0 * best.rests;
    let threshold = ONE_OVER_F * mean_square_quantile(LN_ALARM, freedom);
    let amplitude_rad = |power: f64| (power - gyro_floor).max(0.0).sqrt().to_radians() / (TAU * best.hz);
    let least_deg = (threshold * gyro_floor).sqrt() / TAU;
    let mut outcome = Outcome { limit: limit(&CARD, least_deg, "deg", "at 1 Hz"), ..Outcome::default() };
    let lean_rad = amplitude_rad(best.gyro);
    let force = (best.accel - accel_floor).max(0.0).sqrt() * G;
    let lever = lean_rad * (G + PIVOT_M * (TAU * best.hz).powi(2));
    let fits = (0.6 * lean_rad * G..1.5 * lever).contains(&force);
    if gyro > threshold && accel > threshold && fits && narrow(&swings, best) {
        let evidence = -ln_mean_square_tail(gyro, freedom) - ln_mean_square_tail(accel, freedom);
        let sigma = lean_rad.to_degrees() * (0.5 / gyro.sqrt() / best.rests.sqrt() + 0.05);
        let parameters = vec![
            value("amplitude", lean_rad.to_degrees(), sigma, "deg"),
            value("frequency", best.hz, 0.5 * STEP_HZ, "Hz"),
        ];
        outcome.found = Some(found(&CARD, evidence, parameters, view.everywhere()));
    }
    outcome
}

/// A table swings at one frequency; a hand sways at all: 0.6 Hz off (rests of 2.4 s resolve 0.4) it has fallen to a third.
fn narrow(swings: &[Swing], best: &Swing) -> bool {
    let off = |by: f64| swings.iter().find(|swing| (swing.hz - best.hz - by).abs() < 0.5 * STEP_HZ);
    [-0.6, 0.6].into_iter().filter_map(off).all(|swing| swing.gyro < 0.35 * best.gyro)
}

/// Means over 50 ms, less the rest's mean, with their spacing.
fn decimated(view: &View, rest: &Rest) -> (f64, Vec<[f64; 6]>) {
    let every = view.count(0.05);
    let count = rest.samples.len() / every;
    let mut means = vec![[0.0; 6]; count];
    for (c, channel) in view.channels.iter().enumerate() {
        let values = &channel[rest.samples.clone()];
        let mean = values[..count * every].iter().sum::<f64>() / (count * every).max(1) as f64;
        for (out, block) in means.iter_mut().zip(values.chunks_exact(every)) {
            out[c] = block.iter().sum::<f64>() / every as f64 - mean;
        }
    }
    (every as f64 * view.dt_s, means)
}

/// Squared amplitude by triad: sum over axes, mean over rests (weighted by length) of at least one period.
fn swing(rests: &[(f64, Vec<[f64; 6]>)], hz: f64) -> Option<Swing> {
    let mut swing = Swing { hz, rests: 0.0, gyro: 0.0, accel: 0.0 };
    let mut weight = 0.0;
    for (dt_s, means) in rests.iter().filter(|(dt_s, means)| dt_s * means.len() as f64 * hz >= 1.0) {
        let count = means.len() as f64;
        let mut sums = [[0.0; 2]; 6];
        for (k, values) in means.iter().enumerate() {
            let (sin, cos) = (TAU * hz * dt_s * k as f64).sin_cos();
            for (sum, value) in sums.iter_mut().zip(values) {
                sum[0] += value * cos;
                sum[1] += value * sin;
            }
        }
        // The amplitude is 2/N times the sums: exact over whole periods, near enough over more than one.
        let power = |sum: &[f64; 2]| 4.0 * (sum[0] * sum[0] + sum[1] * sum[1]) / (count * count);
        swing.gyro += count * sums[..3].iter().map(power).sum::<f64>();
        swing.accel += count * sums[3..].iter().map(power).sum::<f64>();
        swing.rests += 1.0;
        weight += count;
    }
    (swing.rests >= 2.0).then(|| Swing { gyro: swing.gyro / weight, accel: swing.accel / weight, ..swing })
}
