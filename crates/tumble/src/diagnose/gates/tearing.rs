//! High and low byte of a reading from two samples (`byte_tearing`).
//!
//! Statistic: single-sample spikes on one channel of 256 counts against one of the neighbours or their mean, within a
//! tolerance of four sigmas of noise (at least six counts), where the neighbours straddle a multiple of 256 counts, and five
//! samples to either side are smooth. What makes spikes of any size is counted beside it: spikes of 100 to 600 counts
//! that fail the size or the straddling. If C such occur, a spike of another cause falls on the right size (share
//! 2·tolerance/500 for either sign) astride a boundary (share (|step| + 2·tolerance)/256) by chance: expected
//! E = (C + 0.03)·ρ with ρ that product; one recording in thirty has such a spike of one channel alone. Poisson's tail of the
//! count against E. A channel whose own noise would pass for a torn reading once in a thousand recordings is left out.
//!
//! Once tearing is certain, readings are put right that were not counted: where one in fifty is torn, one in six has another torn
//! one among the ten that must be smooth.

use super::chance::{LN_ALARM, ln_poisson_tail};
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;
use crate::recording::{Basis, Known};

const BYTE: f64 = 256.0;
/// Spikes that are looked at, counts.
const SPIKES: std::ops::Range<f64> = 100.0..600.0;
/// Neighbours that tell what a reading between them should be differ by less than this part of 256 counts.
const TOGETHER: f64 = 0.25;

pub(super) const CARD: Card = Card {
    id: "byte_tearing",
    name: "bytes of two samples in one reading",
    equation: "c_out = 256·floor(c_k−1/256) + c_k mod 256, or the other way round",
    typical: "a few per cent of high-byte changes where registers are read one by one (MPU-9250 register map: burst reads are safe)",
    shows: "single samples of one channel",
    confounded: &["shock"],
    separate_by: "read all data registers in one burst: torn readings disappear, knocks do not",
};

struct Spike {
    index: usize,
    torn: bool,
    share: f64,
}

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let tested = tested(view);
    if tested.is_empty() {
        let why = "readings are not whole counts of a known range, or noise alone jumps by 256 counts";
        return Outcome { limit: untestable(&CARD, "readings", why), ..Outcome::default() };
    }
    let (mut torn, mut others, mut share, mut channels) = (Vec::new(), 0.03, 0.0_f64, 0u8);
    for &(channel, count) in &tested {
        for spike in spikes(view, channel, count) {
            share = share.max(spike.share);
            if spike.torn {
                channels |= 1 << channel;
                torn.push(spike.index);
            } else {
                others += 1.0;
            }
        }
    }
    let why = "where a channel passes a multiple of 256 counts";
    let mut outcome = Outcome { limit: limit(&CARD, 1.0, "readings", why), ..Outcome::default() };
    let ln_p = ln_poisson_tail(torn.len() as f64, others * share);
    torn.sort_unstable();
    torn.dedup();
    if let (true, Some(&first), Some(&last)) = (ln_p < 0.8 * LN_ALARM, torn.first(), torn.last()) {
        let number = torn.len() as f64;
        let parameters = vec![value("readings", number, number.sqrt(), "")];
        outcome.found = Some(found(&CARD, -ln_p, parameters, view.place(channels, first..last + 1)));
        outcome.repaired =
            tested.iter().flat_map(|(channel, count)| crowded(view, *channel, *count)).chain(torn).collect();
        outcome.repaired.sort_unstable();
        outcome.repaired.dedup();
    }
    outcome
}

/// Channels of whole counts, °/s or g each, in which noise does not pass for a torn reading.
fn tested(view: &View) -> Vec<(usize, f64)> {
    let inference = view.scene.inference;
    let count = |channel: usize| {
        let range = if channel < 3 { inference.gyro_range_dps } else { inference.accel_range_g };
        let count = count_of(range, view.step[channel])?;
        (by_noise(view.sigma[channel] / count, view.len()) <= 1e-3).then_some((channel, count))
    };
    (0..6).filter_map(count).collect()
}

/// One count of a range, by the step where it shows: makers' counts differ from range/2^15 by up to 15 %.
fn count_of(range: Known, step: f64) -> Option<f64> {
    let sheet = range.value / 32768.0;
    let near = (0.95..1.2).contains(&(step / sheet));
    (range.basis != Basis::Largest && near).then_some(step)
}

/// How far a spike may lie from 256 counts, counts.
fn tolerance(noise: f64) -> f64 {
    if noise.is_finite() { (4.0 * noise).max(6.0) } else { 6.0 }
}

/// Samples that noise alone, counts, brings within the tolerance of 256: three differences of two readings, either sign, and
/// Q(z) ≤ ½ exp(−z²/2).
fn by_noise(noise: f64, samples: usize) -> f64 {
    let z = (BYTE - tolerance(noise)).max(0.0) / (std::f64::consts::SQRT_2 * noise);
    if noise > 0.0 { 3.0 * samples as f64 * (-0.5 * z * z).exp() } else { 0.0 }
}

fn spikes(view: &View, channel: usize, count: f64) -> Vec<Spike> {
    let values = &view.channels[channel];
    let tolerance = tolerance(view.sigma[channel] / count);
    let c = |i: usize| values[i] / count;
    let bend = |i: usize| c(i) - 0.5 * (c(i - 1) + c(i + 1));
    let mut spikes = Vec::new();
    for index in 5..values.len().saturating_sub(5) {
        let size = bend(index);
        let (before, now, after) = (c(index - 1), c(index), c(index + 1));
        let step = (after - before).abs();
        if !SPIKES.contains(&size.abs()) || step > 0.3 * size.abs() || !alone(view, channel, index) {
            continue;
        }
        let smooth =
            (2..=4).all(|k| bend(index - k).abs() < size.abs() / 6.0 && bend(index + k).abs() < size.abs() / 6.0);
        if !smooth {
            continue;
        }
        let reach = tolerance + 1.5e-3 * now.abs(); // a count is known to 0.1 %
        let sized = [size, now - before, now - after].iter().any(|d| (d.abs() - BYTE).abs() < tolerance);
        let (low, high) = (before.min(after) - reach, before.max(after) + reach);
        let torn = sized && (low / BYTE).floor() != (high / BYTE).floor();
        let share = 2.0 * tolerance / 500.0 * ((step + 2.0 * reach) / BYTE).min(1.0);
        spikes.push(Spike { index, torn, share });
    }
    spikes
}

/// Readings 256 counts off what the four about them say, again and again with those put right that were found.
fn crowded(view: &View, channel: usize, count: f64) -> Vec<usize> {
    let tolerance = tolerance(view.sigma[channel] / count);
    let mut counts: Vec<f64> = view.channels[channel].iter().map(|value| value / count).collect();
    let mut torn = Vec::new();
    let mut known = vec![false; counts.len()];
    loop {
        let before = torn.len();
        for index in 2..counts.len().saturating_sub(2) {
            if known[index] {
                continue;
            }
            let off = |predicted: &f64| ((counts[index] - predicted).abs() - BYTE).abs() < tolerance;
            if let Some(predicted) = predictions(&counts, index).into_iter().flatten().find(off) {
                counts[index] = predicted;
                known[index] = true;
                torn.push(index);
            }
        }
        if torn.len() == before {
            return torn;
        }
    }
}

/// What a reading should be, counts: the middle of the four about it where these lie together, of which one may be torn as well; the
/// cubic through them where it is nearly straight, for what moves.
fn predictions(counts: &[f64], index: usize) -> [Option<f64>; 2] {
    let about = [index - 2, index - 1, index + 1, index + 2].map(|i| counts[i]);
    let mean = 0.5 * (about[1] + about[2]);
    let cubic = (4.0 * (about[1] + about[2]) - about[0] - about[3]) / 6.0;
    let mut sorted = about;
    sorted.sort_by(f64::total_cmp);
    let together = sorted[2] - sorted[1] < TOGETHER * BYTE;
    let straight = (cubic - mean).abs() < TOGETHER * BYTE;
    [together.then_some(0.5 * (sorted[1] + sorted[2])), straight.then_some(cubic)]
}

/// No other channel of the sample jumps by more than a quarter of what this one does, in counts.
fn alone(view: &View, channel: usize, index: usize) -> bool {
    let counts = |c: usize| view.bend(c, index) / view.step[c].max(1e-9);
    let own = counts(channel);
    let others = (0..6).filter(|c| *c != channel && view.step[*c] > 0.0).map(counts);
    others.filter(|other| *other > 0.25 * own).count() <= 1
}
