//! Readings that stand at a level which the motion passed (`gyro_saturation`, `accel_saturation`).
//!
//! Statistic: at a channel's extreme M, (1) exact repeats: more in a row than noise makes alike, and 15 to 40 ms of them
//! (`least_run`). (2) Either *overshoot*: the parabolas through the 80 ms before the run and after it (backwards), drawn on by half the run or 20 ms,
//! are both past M by more than 8 sigmas of noise plus two steps. A parabola drawn on by a quarter of its length has 1.9 sigmas of its own and ends
//! in the peak of any motion slower than 5 Hz; beyond 4 sigmas on both sides is chance to 1e-9. Or *pile-up*: more readings at M than in
//! all of the next three steps below it by a margin that fair coins reach with e⁻¹¹·⁵ (Hoeffding): a density that falls
//! towards its extreme has fewer. It must be there twice: a channel that stands still once at its extreme is frozen (`frozen.rs`). Pile-up is only asked where noise is more than the half step by which
//! rounding alone scatters, so that a constant reading is not just rounding.
//! Or (3) *the rail*: two readings at the end (0.2 %) of a range that is stated or shown by its step.
//!
//! A filter behind the converter swings past the level where it enters and leaves it, and settles on it between: where the extreme itself
//! is no such level, the one below it, within [`SWING`], that most readings in long runs stand at is asked for pile-up, at the price of all
//! levels that there are.
//!
//! A level that all readings of a sensor at rest could reach by its own offset is a level like any other.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use super::chance::{LN_ALARM, ln_coin_tail};
use super::coarse;
use super::tell::{Outcome, found, limit, value};
use super::view::{CHANNELS, View};
use crate::diagnose::catalogue::Card;
use crate::recording::Basis;

const IMITATED: &[&str] = &["gyro_scale_cubic", "gyro_scale_quadratic", "gyro_scale_asymmetry", "gyro_dead_zone"];
const IMITATED_ACCEL: &[&str] = &["accel_cubic", "accel_quadratic"];
/// Shortest flat top, s, whatever the noise; and the longest that noise can make one ask for.
const LEAST_S: [f64; 2] = [0.015, 0.04];
/// −ln of how often noise alone may make as long a run of equal readings at a peak: 1e-3, beside the overshoot's own chance.
const LN_EQUAL: f64 = 7.0;
/// Most that a filter swings past a level, as a share of it: a second-order Butterworth does by 4 % of a step, and a rate enters by a
/// ramp.
const SWING: f64 = 0.04;
/// An accelerometer's faces rest near its largest readings, and there the step nearest to the mean has more readings than the next three below by
/// itself: a share of 0.38 against 0.31 at a noise of one step, 0.20 against 0.36 at two. Quieter ones show no pile-up.
const RESTING_RATIO: f64 = 2.0;
/// What the parabola is fitted to, s; it is drawn on for a quarter of that.
const FIT_S: f64 = 0.08;

pub(super) const GYRO: Card = Card {
    id: "gyro_saturation",
    name: "gyro clips",
    equation: "reading = clamp(rate, −L, L)",
    typical: "full scale 250 to 2000 dps (MPU-9250 sheet); hands turn a box at 70 to 400 dps",
    shows: "flat tops of the gyro",
    confounded: IMITATED,
    separate_by: "turn more slowly, or set a wider range: flat tops disappear",
};

pub(super) const ACCEL: Card = Card {
    id: "accel_saturation",
    name: "accelerometer clips",
    equation: "reading = clamp(force, −L, L)",
    typical: "full scale 2 to 16 g (MPU-9250 sheet); put-downs reach 2 to 10 g",
    shows: "flat tops of the accelerometer",
    confounded: IMITATED_ACCEL,
    separate_by: "put it down more softly, or set a wider range: flat tops disappear",
};

struct Flat {
    channel: usize,
    level: f64,
    samples: Vec<usize>,
    evidence: f64,
}

/// Both gates; `stale` samples repeat for another reason.
pub fn examine(view: &View, stale: &[usize]) -> (Outcome, Outcome) {
    let end = |card, channels, unit, imitated| triad(view, stale, card, channels, unit, imitated);
    (end(&GYRO, 0..3, "dps", IMITATED), end(&ACCEL, 3..6, "g", IMITATED_ACCEL))
}

fn triad(
    view: &View,
    stale: &[usize],
    card: &Card,
    channels: Range<usize>,
    unit: &str,
    imitated: &'static [&'static str],
) -> Outcome {
    let largest = channels.clone().flat_map(|c| view.channels[c].iter()).fold(0.0_f64, |max, v| max.max(v.abs()));
    let mut flats: Vec<Flat> = Vec::new();
    for channel in channels.clone() {
        flats.extend([1.0, -1.0].into_iter().filter_map(|sign| flat(view, stale, channel, sign)));
    }
    if let Some(level) = flats.iter().map(|flat| flat.level.abs()).reduce(f64::max) {
        let ends = channels.flat_map(|channel| [(channel, 1.0), (channel, -1.0)]);
        let known =
            |(channel, sign): &(usize, f64)| flats.iter().any(|f| f.channel == *channel && f.level * sign > 0.0);
        let more: Vec<Flat> = ends.filter(|end| !known(end)).filter_map(|end| once(view, stale, end, level)).collect();
        flats.extend(more);
    }
    let mut outcome =
        Outcome { limit: limit(card, largest, unit, "a level below the largest reading"), ..Outcome::default() };
    let ends = flats.iter().flat_map(|flat| &flat.samples);
    let (Some(&first), Some(&last)) = (ends.clone().min(), ends.max()) else { return outcome };
    let mask = flats.iter().fold(0, |mask, flat| mask | 1 << flat.channel);
    let level = |flat: &Flat| {
        let sigma = 0.3 * view.step[flat.channel].max(1e-6 * flat.level.abs());
        value(
            &format!("level_{}{}", CHANNELS[flat.channel], if flat.level < 0.0 { "_low" } else { "_high" }),
            flat.level,
            sigma,
            unit,
        )
    };
    let mut parameters: Vec<_> = flats.iter().map(level).collect();
    let samples: usize = flats.iter().map(|flat| flat.samples.len()).sum();
    parameters.push(value("samples", samples as f64, 0.0, ""));
    let evidence = flats.iter().map(|flat| flat.evidence).sum();
    let mut place = view.place(mask, first..last + 1);
    place.segments.retain(|number| {
        let range = view.samples_of(&view.scene.segments[*number]);
        flats.iter().any(|flat| flat.samples.iter().any(|i| range.contains(i)))
    });
    outcome.found = Some(found(card, evidence, parameters, place));
    outcome.imitated = imitated;
    outcome.clipped =
        flats.iter().flat_map(|flat| flat.samples.iter().map(|index| (*index, 1 << flat.channel))).collect();
    outcome
}

/// The channel's upper (`sign` 1) or lower end, if it is flat.
fn flat(view: &View, stale: &[usize], channel: usize, sign: f64) -> Option<Flat> {
    let values = &view.channels[channel];
    let top = values.iter().fold(f64::NEG_INFINITY, |max, v| max.max(sign * v));
    let step = view.step[channel];
    let noise = if view.sigma[channel].is_finite() { view.sigma[channel] } else { 10.0 * step };
    let samples: Vec<usize> = (0..values.len()).filter(|i| sign * values[*i] > top - blur(step)).collect();
    if top <= 0.0 && samples.len() < 100 || top.abs() < 20.0 * noise {
        return None;
    }
    let runs: Vec<Range<usize>> =
        samples.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect();
    let fresh = |run: &Range<usize>| run.clone().filter(|i| stale.binary_search(i).is_err()).count();
    let least = least_run(view, noise / step);
    let long: Vec<&Range<usize>> = runs.iter().filter(|run| fresh(run) >= least).collect();
    let margin = 8.0 * noise + 2.0 * step;
    let overshoots = long.iter().filter(|run| overshoots(view, values, run, sign, top + margin)).count();
    let least_ratio = if channel < 3 { coarse::LEAST_RATIO } else { RESTING_RATIO };
    let fine = noise > least_ratio * step && noise > 0.0;
    let ln_p = if fine && !long.is_empty() && runs.len() > 1 { ln_pile(values, sign, top, step) } else { 0.0 };
    let rail = if at_rail(view, channel, top) && samples.len() >= 2 { 15.0 } else { 0.0 };
    let evidence = 15.0 * overshoots as f64 - ln_p + rail;
    if overshoots > 0 || ln_p < LN_ALARM || rail > 0.0 {
        return Some(Flat { channel, level: sign * top, samples, evidence });
    }
    if !fine || top <= 0.0 {
        return None;
    }
    let level = filtered(values, stale, sign, top, step, least)?;
    let ln_p = ln_pile(values, sign, level, step) + (SWING * top / step).max(1.0).ln();
    let samples = || (0..values.len()).filter(|i| sign * values[*i] > level - blur(step)).collect();
    (ln_p < LN_ALARM).then(|| Flat { channel, level: sign * level, samples: samples(), evidence: -ln_p })
}

/// An end that stands once at the level where others of its triad clip does so too: one converter has one range.
fn once(view: &View, stale: &[usize], (channel, sign): (usize, f64), level: f64) -> Option<Flat> {
    let (values, step) = (&view.channels[channel], view.step[channel]);
    let top = values.iter().fold(f64::NEG_INFINITY, |max, v| max.max(sign * v));
    if (top - level).abs() > 1.5 * step {
        return None;
    }
    let samples: Vec<usize> = (0..values.len()).filter(|i| sign * values[*i] > top - blur(step)).collect();
    let fresh = |run: &[usize]| run.iter().filter(|i| stale.binary_search(i).is_err()).count();
    let stands =
        samples.chunk_by(|a, b| a + 1 == *b).any(|run| fresh(run) >= least_run(view, view.sigma[channel] / step));
    stands.then_some(Flat { channel, level: sign * top, samples, evidence: 0.0 })
}

/// Text decimals blur one level by less than a tenth of a step.
fn blur(step: f64) -> f64 {
    0.1 * step + 1e-9
}

/// Probability that so many more readings stand at a level than in all of the next three steps below it.
fn ln_pile(values: &[f64], sign: f64, level: f64, step: f64) -> f64 {
    let count = |range: Range<f64>| values.iter().filter(|v| range.contains(&(sign * **v))).count() as f64;
    let (pile, next) = (count(level - blur(step)..level + blur(step)), count(level - 3.5 * step..level - blur(step)));
    ln_coin_tail(pile, pile + next)
}

/// The level within a filter's swing below the extreme that most readings, in runs of at least so many alike, stand at.
fn filtered(values: &[f64], stale: &[usize], sign: f64, top: f64, step: f64, least: usize) -> Option<f64> {
    let near: Vec<usize> = (0..values.len()).filter(|i| sign * values[*i] > (1.0 - SWING) * top).collect();
    let alike = |a: &usize, b: &usize| a + 1 == *b && (values[*a] - values[*b]).abs() < blur(step);
    let mut levels: Vec<(f64, usize, usize)> = Vec::new();
    for run in near.chunk_by(alike) {
        let fresh = run.iter().filter(|i| stale.binary_search(i).is_err()).count();
        let level = sign * values[run[0]];
        match levels.iter_mut().find(|(known, ..)| (known - level).abs() < blur(step)) {
            _ if fresh < least => {}
            Some((_, count, runs)) => (*count, *runs) = (*count + fresh, *runs + 1),
            None => levels.push((level, fresh, 1)),
        }
    }
    let again = levels.into_iter().filter(|(_, _, runs)| *runs > 1);
    again.max_by_key(|(_, count, _)| *count).map(|(level, ..)| level)
}

/// Readings in a row that are no accident. Two of noise σ are equal with p = Δ/(2√π σ), so that n in a row have pⁿ⁻¹; a hand's
/// ring after a put-down passes both parabolas, and three equal readings at its peak came once in 280 clean sessions.
fn least_run(view: &View, noise_steps: f64) -> usize {
    let equal = (0.5 / (std::f64::consts::PI.sqrt() * noise_steps)).min(1.0);
    let [least, most] = LEAST_S.map(|seconds| view.count(seconds).max(3));
    let asked = 1.0 + LN_EQUAL / -equal.ln().min(-f64::MIN_POSITIVE);
    // Quieter than a step, readings are alike of themselves, and curvature alone makes a peak: the parabolas decide.
    if equal > 0.9 { least } else { (asked.ceil() as usize).clamp(least, most) }
}

/// Two readings at the end of a known range are clipped by definition.
fn at_rail(view: &View, channel: usize, top: f64) -> bool {
    let inference = view.scene.inference;
    let range = if channel < 3 { inference.gyro_range_dps } else { inference.accel_range_g };
    range.basis != Basis::Largest && top >= 0.998 * range.value
}

fn overshoots(view: &View, values: &[f64], run: &Range<usize>, sign: f64, limit: f64) -> bool {
    let length = view.count(FIT_S).max(4);
    let ahead = (0.5 * run.len() as f64).min(0.25 * length as f64).max(1.0);
    let before = (run.start >= length).then(|| values[run.start - length..run.start].to_vec());
    let after = (run.end + length <= values.len()).then(|| {
        let mut backwards = values[run.end..run.end + length].to_vec();
        backwards.reverse();
        backwards
    });
    let past = |values: Vec<f64>| continued(&values, ahead).is_some_and(|value| sign * value > limit);
    before.is_some_and(past) && after.is_some_and(past)
}

/// The least-squares parabola, `ahead` samples past the last.
fn continued(values: &[f64], ahead: f64) -> Option<f64> {
    let powers = |x: f64| Vector3::new(1.0, x, x * x);
    let (mut normal, mut moment) = (Matrix3::zeros(), Vector3::zeros());
    for (i, value) in values.iter().enumerate() {
        let row = powers((i as f64 + 1.0) / values.len() as f64 - 1.0);
        normal += row * row.transpose();
        moment += row * *value;
    }
    let fitted = normal.cholesky()?.solve(&moment);
    Some(powers(ahead / values.len() as f64).dot(&fitted))
}
