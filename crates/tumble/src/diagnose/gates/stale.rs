//! Old values under new stamps (`duplicated_samples`).
//!
//! Statistic: neighbours equal in all six channels. By chance that happens too, where rounding is coarse: over windows
//! of two seconds the expected count is n·Πq_c, q_c the share of pairs with channel c equal *among pairs that are not equal
//! in all* (so that stale pairs do not vouch for themselves). Channels' noises are independent, so the product holds; it
//! is doubled, and half a pair added, for motion within a window. The count is then below a Poisson variable of that
//! mean, whose tail is bounded by Chernoff.

use super::chance::{LN_ALARM, ln_poisson_tail, mean_seen};
use super::tell::{Outcome, found, limit, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const WINDOW_S: f64 = 2.0;
/// Share of pairs below which nothing is told.
const LEAST_SHARE: f64 = 1e-3;

pub(super) const CARD: Card = Card {
    id: "duplicated_samples",
    name: "old values under new stamps",
    equation: "all channels of sample k equal those of sample k − 1",
    typical: "0.5 to 2 % where the reader polls (oscillator ±1 %, MPU-9250 sheet), half where it reads twice as fast",
    shows: "all channels",
    confounded: &["gyro_coarse_quantization", "dropped_samples"],
    separate_by: "read on the sensor's data-ready interrupt, or log its status bit with every sample",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let count = view.len();
    let window = view.count(WINDOW_S).max(20);
    let (mut expected, mut stale) = (0.5, Vec::new());
    for start in (1..count).step_by(window) {
        let end = (start + window).min(count);
        let (mut equal, mut fresh) = ([0.0; 6], 0.0_f64);
        for index in start..end {
            let same: [bool; 6] = std::array::from_fn(|c| view.channels[c][index] == view.channels[c][index - 1]);
            if same.iter().all(|same| *same) {
                stale.push(index);
            } else {
                fresh += 1.0;
                (0..6).for_each(|c| equal[c] += f64::from(u8::from(same[c])));
            }
        }
        // A window in which nothing ever changes says nothing: all of it is expected.
        let chance: f64 = equal.iter().map(|n| (n + 0.5) / (fresh + 0.5)).product();
        expected += 2.0 * (end - start) as f64 * chance;
    }
    let excess = stale.len() as f64 - expected;
    let share = excess / count as f64;
    // Repeats that must be seen: the share, or (Chernoff, nearly) five sigmas and twelve beyond what chance has.
    let needed = (LEAST_SHARE * count as f64).max(5.0 * expected.sqrt() + 12.0);
    let least = 100.0 * mean_seen(needed) / count as f64;
    let mut outcome = Outcome { limit: limit(&CARD, least, "%", ""), ..Outcome::default() };
    let ln_p = ln_poisson_tail(stale.len() as f64, expected);
    if share > LEAST_SHARE && ln_p < LN_ALARM {
        let sigma = 100.0 * (stale.len() as f64).sqrt() / count as f64;
        let place = view.place(0x3f, stale[0]..stale[stale.len() - 1] + 1);
        outcome.found = Some(found(&CARD, -ln_p, vec![value("share", 100.0 * share, sigma, "%")], place));
        outcome.repaired = stale;
    }
    outcome
}
