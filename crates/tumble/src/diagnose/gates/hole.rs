//! Slow turns that read as one and the same value (`gyro_dead_zone`, in its hard form; the soft one is found by
//! regression).
//!
//! Statistic: the commonest value v of a channel with at least a twentieth of the readings, and h, the distance to
//! the next value on either side. A density that does not rise away from v has in (v, v + h) at least as many readings as in
//! (v + h, v + 2h), n; that none is seen has probability e⁻ⁿ for each side. h must be four steps, so that rounding is no hole.

use super::chance::{LN_ALARM, median};
use super::tell::{Outcome, found, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

pub(super) const CARD: Card = Card {
    id: "gyro_dead_zone",
    name: "gyro does not see slow turns",
    equation: "|rate| < d reads as zero, more reads as it is: a hole in the histogram",
    typical: "0.05 to 1 dps in drivers that zero small rates",
    shows: "readings that are exactly constant at rest",
    confounded: &["gyro_coarse_quantization"],
    separate_by: "log raw counts, before the driver zeroes them",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let mut outcome = Outcome::default();
    let holes: Vec<(usize, f64, f64)> = (0..3)
        .filter_map(|c| hole(&view.channels[c], view.step[c]).map(|(width, evidence)| (c, width, evidence)))
        .collect();
    if holes.is_empty() {
        return outcome;
    }
    let mask = holes.iter().fold(0, |mask, hole| mask | 1 << hole.0);
    let name = |channel: usize| format!("half_width_{}", ["x", "y", "z"][channel]);
    let parameters = holes.iter().map(|(c, width, _)| value(&name(*c), *width, 0.1 * width, "dps")).collect();
    let evidence = holes.iter().map(|hole| hole.2).sum();
    outcome.found = Some(found(&CARD, evidence, parameters, view.place(mask, 0..view.len())));
    outcome
}

fn hole(channel: &[f64], step: f64) -> Option<(f64, f64)> {
    let mut sorted = channel.to_vec();
    sorted.sort_by(f64::total_cmp);
    let commonest = sorted.chunk_by(|a, b| a == b).max_by_key(|group| group.len())?;
    let (at, count) = (commonest[0], commonest.len());
    if count * 20 < sorted.len() {
        return None;
    }
    let above = sorted.partition_point(|v| *v <= at);
    let below = sorted.partition_point(|v| *v < at);
    let width = (sorted.get(above)? - at).min(at - sorted.get(below.checked_sub(1)?)?);
    let between = |low: f64, high: f64| sorted.partition_point(|v| *v < high) - sorted.partition_point(|v| *v <= low);
    let n = between(at + width, at + 2.0 * width) + between(at - 2.0 * width, at - width);
    // Other values are spaced more densely than the hole.
    let beyond: Vec<f64> = sorted.iter().copied().filter(|v| (at + width..at + 3.0 * width).contains(v)).collect();
    let gaps = beyond.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0).collect();
    let usual = median(gaps).max(step);
    (width > 4.0 * usual && n as f64 > -LN_ALARM).then_some((width, n as f64))
}
