//! Steps of the gyroscope that are larger than its noise (`gyro_coarse_quantization`).
//!
//! Statistic: s/q, the scatter of one reading at rest (median over half-second blocks) over the step q. Rounding of
//! noise σ leaves s² = σ² + q²/12 and is white while σ > 0.5 q (the next term is 2 exp(−2π²σ²/q²), 1.4 % of q² there, 18 %
//! at 0.35 q). A large step leaves s between 0 and 0.5 q, the latter where the offset lies between two steps: the gate is s < 0.52 q, σ <
//! 0.43 q. Sensors of the sheet have σ from 0.045 °/s (20 Hz) and 0.061 °/s a count at the widest usual range, s/q ≥ 0.79: with 100
//! blocks the median of s has 1.5 % of scatter, so chance is out by more than twenty sigmas. A driver that keeps fewer bits than the
//! range stated is told by q > 4 counts as well, where s < 1.5 q. Limit: q = s/0.43, with s of the readings as they are.

use super::chance::median;
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;
use crate::recording::Basis;

const IMITATED: &[&str] =
    &["gyro_dead_zone", "gyro_scale_cubic", "gyro_scale_asymmetry", "gyro_bias_step", "gyro_g_squared"];

/// A step alone scatters readings by up to half of it.
pub const LEAST_RATIO: f64 = 0.52;
/// √(0.52² − 1/12), less three sigmas of the median.
const UNROUNDED: f64 = 0.41;

pub(super) const CARD: Card = Card {
    id: "gyro_coarse_quantization",
    name: "gyro readings come in coarse steps",
    equation: "reading = q·round(rate/q), q larger than the noise",
    typical: "0.061 dps at 2000 dps full scale (MPU-9250 sheet); 12 bits of it have 0.98 dps",
    shows: "the gyro at rest",
    confounded: IMITATED,
    separate_by: "set the narrowest range that the motion allows, log whole counts, or let the noise in (a wider filter)",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    if view.rests.is_empty() {
        return Outcome { limit: untestable(&CARD, "dps", "no rest on something solid"), ..Outcome::default() };
    }
    let step = median(view.step[..3].to_vec());
    let ratio = median((0..3).map(|c| view.sigma[c] / view.step[c].max(1e-12)).collect());
    let usual = median((0..3).map(|c| view.sigma[c]).collect()) / UNROUNDED;
    let why = "a step of 2.3 times the scatter at rest";
    let mut outcome = Outcome { limit: limit(&CARD, usual.max(1e-3), "dps", why), ..Outcome::default() };
    let range = view.scene.inference.gyro_range_dps;
    let count = range.value / 32768.0;
    let fewer_bits = range.basis == Basis::Stated && step > 4.0 * count && ratio < 1.5;
    if step > 0.0 && (ratio < LEAST_RATIO || fewer_bits) {
        let parameters = vec![value("step", step, 1e-3 * step, "dps"), value("scatter_over_step", ratio, 0.02, "")];
        let blocks: usize = view.rests.iter().map(|rest| rest.samples.len()).sum();
        outcome.found = Some(found(&CARD, (blocks as f64).min(1000.0), parameters, view.place(7, 0..view.len())));
        outcome.imitated = IMITATED;
    }
    outcome
}
