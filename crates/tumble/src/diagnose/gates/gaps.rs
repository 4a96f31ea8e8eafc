//! Samples that never came (`dropped_samples`).
//!
//! Statistic: intervals within a quarter of k·T, k ≥ 2, T the median. Clean stamps have none: this is a count, not a test,
//! and its false alarms are those of a recorder that really stalls. One gap below a tenth of a second is let pass: it
//! shifts a turn by less than a trapezoid's error. Where stamps themselves scatter by a quarter of T, a gap is told from a late
//! stamp only by what stays: the stamps after it are later than those before by the whole gap, in the mean of eight.

use super::chance::{mean_seen, quantile};
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

/// Fewer lost than this share, without a gap of a tenth of a second, harms nothing.
const LEAST_SHARE: f64 = 5e-4;
const LONG_S: f64 = 0.1;

pub(super) const CARD: Card = Card {
    id: "dropped_samples",
    name: "samples are missing",
    equation: "t_k+1 − t_k = (1 + m)·T, m samples lost",
    typical: "0.1 to 5 % on serial lines that overrun and on radio links",
    shows: "intervals",
    confounded: &["timestamp_jitter"],
    separate_by: "number the samples in the sensor's driver: numbers that are missing were lost, numbers that are there were late",
};

/// The gate; `steps`: stamps come in coarse steps, whose multiples are no gaps.
pub fn examine(view: &View, steps: bool) -> Outcome {
    let dt: Vec<f64> = view.t_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sizes: Vec<f64> = dt.iter().map(|dt| (dt - view.dt_s).abs()).collect();
    if steps || dt.len() < 100 || quantile(&mut sizes, 0.68) > 0.25 * view.dt_s {
        let why = "the stamps are too uneven to tell a lost sample from a late one";
        return Outcome { limit: untestable(&CARD, "%", why), ..Outcome::default() };
    }
    let gaps: Vec<(usize, f64)> = dt.iter().enumerate().filter_map(|(i, dt)| missing(view, i, *dt)).collect();
    let lost: f64 = gaps.iter().map(|gap| gap.1).sum();
    let share = lost / (lost + view.len() as f64);
    let longest_s = gaps.iter().map(|gap| gap.1 * view.dt_s).fold(0.0, f64::max);
    let least = mean_seen((LEAST_SHARE * view.len() as f64).max(3.0)) / view.len() as f64;
    let mut outcome = Outcome { limit: limit(&CARD, 100.0 * least, "%", ""), ..Outcome::default() };
    if (gaps.len() >= 3 && share >= LEAST_SHARE) || longest_s >= LONG_S {
        let sigma = 100.0 * lost.sqrt() / view.len() as f64;
        let parameters = vec![
            value("share", 100.0 * share, sigma, "%"),
            value("gaps", gaps.len() as f64, 0.0, ""),
            value("longest", 1e3 * longest_s, 1e3 * view.dt_s, "ms"),
        ];
        let place = view.place(0x3f, gaps[0].0..gaps[gaps.len() - 1].0 + 2);
        outcome.found = Some(found(&CARD, 10.0 * gaps.len() as f64, parameters, place));
    }
    outcome
}

/// How many samples are missing after this one.
fn missing(view: &View, index: usize, dt: f64) -> Option<(usize, f64)> {
    let times = (dt / view.dt_s).round();
    let whole = times >= 2.0 && (dt / view.dt_s - times).abs() < 0.25_f64.max(0.02 * times);
    if !whole {
        return None;
    }
    let t = &view.t_s;
    let (before, after) = (index.saturating_sub(7)..index + 1, index + 1..(index + 9).min(t.len()));
    // Mean distance to where an even grid through the gap would have them.
    let mean = |range: std::ops::Range<usize>| {
        let count = range.len() as f64;
        range.map(|i| t[i] - (i as f64 - index as f64) * view.dt_s).sum::<f64>() / count
    };
    let shift = (mean(after) - mean(before)) / view.dt_s;
    (shift > 0.7).then_some((index, times - 1.0))
}
