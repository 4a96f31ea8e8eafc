//! Sampled too slowly for what moves (`undersampling`).
//!
//! Statistic: the rotation over pieces of 4 s in which it turns from all samples against that from every other one, the mean of both
//! halves. Noise makes them differ by σ·dt·√N (alternate samples, weighted ±dt), known from rests; the sum of squares over M pieces is a mean
//! of 3·M squared normals, its tail Chernoff's. A trapezoid's own error is a third of the difference or less (Richardson). Beyond
//! noise there is always something: tremor, knocks, rounding. So the difference must also matter, and the recording be slow:
//! fewer than 40 samples a second, where a hand's tremor of 8 to 12 Hz has fewer than four a period, and rms above 0.15° in 4 s
//! (well filtered moves at 50 Hz have 0.06 to 0.09°, sim). Above 40 Hz it does not fire: that no clean recording there raises an alarm is
//! by construction.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use super::chance::{LN_ALARM, ln_mean_square_tail};
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const IMITATED: &[&str] = &["gyro_scale_cubic", "gyro_scale_quadratic", "gyro_scale_asymmetry", "gyro_accel_lag"];
const SLOW_HZ: f64 = 40.0;
const LEAST_DEG: f64 = 0.15;
/// Pieces that are compared, s, and what must be turned in one for it to count.
const CHUNK_S: f64 = 4.0;
const LEAST_TURNED_DEG: f64 = 30.0;

pub(super) const CARD: Card = Card {
    id: "undersampling",
    name: "sampled too slowly for its bandwidth",
    equation: "the rotation integral changes when every other sample is left out",
    typical: "41 Hz of bandwidth (MPU-9250, CONFIG = 3) asks for more than 82 Hz; tremor reaches 12 Hz",
    shows: "fast moves",
    confounded: IMITATED,
    separate_by: "record at 100 Hz or more, or narrow the sensor's filter to a quarter of the rate",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let rate_hz = 1.0 / view.dt_s;
    let length = view.count(CHUNK_S).max(16);
    let turned = |range: &Range<usize>| {
        range.clone().map(|i| (view.rate(i) - view.resting).norm()).sum::<f64>() * view.dt_s > LEAST_TURNED_DEG
    };
    let moves: Vec<Range<usize>> = (0..view.len().saturating_sub(length))
        .step_by(length)
        .map(|start| start..start + length + 1)
        .filter(turned)
        .collect();
    let sigma_rad = view.sigma[..3].iter().copied().filter(|s| s.is_finite()).fold(0.0, f64::max).to_radians();
    if moves.len() < 3 || sigma_rad == 0.0 {
        return Outcome { limit: untestable(&CARD, "Hz", "no motion"), ..Outcome::default() };
    }
    let (mut squares, mut whitened) = (0.0, 0.0);
    for range in &moves {
        let differs = differs(view, range).norm_squared();
        squares += differs;
        whitened += differs / (sigma_rad * sigma_rad * view.dt_s * view.dt_s * range.len() as f64);
    }
    let count = moves.len() as f64;
    let rms_deg = (squares / count).sqrt().to_degrees();
    let ln_p = ln_mean_square_tail(whitened / (3.0 * count), 3.0 * count);
    let why = "below this rate, with moves that it does not resolve";
    let mut outcome = Outcome { limit: limit(&CARD, SLOW_HZ, "Hz", why), ..Outcome::default() };
    if rate_hz < SLOW_HZ && rms_deg > LEAST_DEG && ln_p < LN_ALARM {
        let parameters = vec![
            value("rate", rate_hz, 1e-3 * rate_hz, "Hz"),
            value("rotation_error", rms_deg / 3.0, rms_deg / (3.0 * (2.0 * count).sqrt()), "deg"),
        ];
        outcome.found =
            Some(found(&CARD, -ln_p, parameters, view.place(7, moves[0].start..moves[moves.len() - 1].end)));
        outcome.imitated = IMITATED;
    }
    outcome
}

/// Rotation vector between the integral of all samples and the integral of every other one.
fn differs(view: &View, range: &Range<usize>) -> Vector3<f64> {
    let end = range.start + (range.len() - 1) / 2 * 2;
    let bias = view.resting;
    let integral = |every: usize| {
        (range.start..end).step_by(every).fold(UnitQuaternion::identity(), |attitude, i| {
            let dt_s = view.t_s[i + every] - view.t_s[i];
            let (a, b) =
                ((view.rate(i) - bias).map(f64::to_radians), (view.rate(i + every) - bias).map(f64::to_radians));
            attitude * UnitQuaternion::from_scaled_axis((a + b) * (0.5 * dt_s) + a.cross(&b) * (dt_s * dt_s / 12.0))
        })
    };
    (integral(1).inverse() * integral(2)).scaled_axis()
}

/// Resting rate before a sample, °/s.
pub fn nearest_rest(view: &View, index: usize) -> Vector3<f64> {
    let distance = |rest: &&super::view::Rest| rest.samples.start.abs_diff(index).min(rest.samples.end.abs_diff(index));
    view.rests.iter().min_by_key(distance).map_or_else(Vector3::zeros, |rest| rest.rate)
}
