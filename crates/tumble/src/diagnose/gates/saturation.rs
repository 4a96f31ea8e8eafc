//! Readings that stand at a level which the motion passed (`gyro_saturation`, `accel_saturation`).
//!
//! Statistic: at a channel's extreme M, (1) exact repeats: three or more in a run. (2) Either *overshoot*: the straight line
//! through the 50 ms before the run (or after it, backwards) would be past M by more than 5 sigmas of noise plus 1.5
//! steps within the run or 50 ms; natural peaks bend before they are flat (hands move below 12 Hz), and five sigmas happen by
//! chance to 3e-7. Or *pile-up*: more readings at M than in all of the next three steps below it by a margin that fair coins
//! reach with e⁻¹¹·⁵ (Hoeffding): a density that falls towards its extreme has fewer. Pile-up is only asked where noise
//! is at least half a step, so that a constant reading is not just rounding.
//!
//! A level that all readings of a sensor at rest could reach by its own offset is a level like any other.

use std::ops::Range;

use super::chance::{LN_ALARM, ln_coin_tail};
use super::tell::{Outcome, found, limit, value};
use super::view::{CHANNELS, View};
use crate::diagnose::catalogue::Card;

const IMITATED: &[&str] = &["gyro_scale_cubic", "gyro_scale_quadratic", "gyro_scale_asymmetry", "gyro_dead_zone"];
const IMITATED_ACCEL: &[&str] = &["accel_cubic", "accel_quadratic"];
/// The line's length and how far it is drawn on, s.
const LINE_S: f64 = 0.05;

const GYRO: Card = Card {
    id: "gyro_saturation",
    name: "gyro clips",
    equation: "reading = clamp(rate, −L, L)",
    typical: "full scale 250 to 2000 dps (MPU-9250 sheet); hands turn a box at 70 to 400 dps",
    shows: "flat tops of the gyro",
    confounded: IMITATED,
    separate_by: "turn more slowly, or set a wider range: flat tops disappear",
};

const ACCEL: Card = Card {
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

/// Both gates.
pub fn examine(view: &View) -> (Outcome, Outcome) {
    (triad(view, &GYRO, 0..3, "dps", IMITATED), triad(view, &ACCEL, 3..6, "g", IMITATED_ACCEL))
}

fn triad(view: &View, card: &Card, channels: Range<usize>, unit: &str, imitated: &'static [&'static str]) -> Outcome {
    let largest = channels.clone().flat_map(|c| view.channels[c].iter()).fold(0.0_f64, |max, v| max.max(v.abs()));
    let mut flats: Vec<Flat> = Vec::new();
    for channel in channels {
        flats.extend([1.0, -1.0].into_iter().filter_map(|sign| flat(view, channel, sign)));
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
    outcome
}

/// The channel's upper (`sign` 1) or lower end, if it is flat.
fn flat(view: &View, channel: usize, sign: f64) -> Option<Flat> {
    let values = &view.channels[channel];
    let top = values.iter().fold(f64::NEG_INFINITY, |max, v| max.max(sign * v));
    let step = view.step[channel];
    let noise = if view.sigma[channel].is_finite() { view.sigma[channel] } else { 0.0 };
    // Text decimals blur one level by less than a tenth of a step.
    let at = |i: usize| sign * values[i] > top - 0.1 * step - 1e-9;
    let samples: Vec<usize> = (0..values.len()).filter(|i| at(*i)).collect();
    if top <= 0.0 && samples.len() < 100 || top.abs() < 20.0 * noise {
        return None;
    }
    let runs: Vec<Range<usize>> =
        samples.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect();
    let long: Vec<&Range<usize>> = runs.iter().filter(|run| run.len() >= 3).collect();
    let overshoots =
        long.iter().filter(|run| overshoots(view, values, run, sign, top, 5.0 * noise + 1.5 * step)).count();
    let next = values.iter().filter(|v| (top - 3.5 * step..top - 0.1 * step - 1e-9).contains(&(sign * **v))).count();
    let pile = samples.len() as f64;
    let fine = noise > 0.5 * step && noise > 0.0;
    let ln_p = if fine && !long.is_empty() { ln_coin_tail(pile, pile + next as f64) } else { 0.0 };
    let evidence = 15.0 * overshoots as f64 - ln_p;
    (overshoots > 0 || ln_p < LN_ALARM).then_some(Flat { channel, level: sign * top, samples, evidence })
}

fn overshoots(view: &View, values: &[f64], run: &Range<usize>, sign: f64, top: f64, margin: f64) -> bool {
    let length = view.count(LINE_S).max(3);
    let ahead = (0.5 * run.len() as f64).min(length as f64);
    let before = (run.start >= length).then(|| line(&values[run.start - length..run.start], sign));
    let after = (run.end + length <= values.len()).then(|| {
        let mut backwards = values[run.end..run.end + length].to_vec();
        backwards.reverse();
        line(&backwards, sign)
    });
    let past = |(last, slope): (f64, f64)| last + slope * (1.0 + ahead) > top + margin;
    before.is_some_and(past) && after.is_some_and(past)
}

/// Value at the last sample and slope a sample, by least squares.
fn line(values: &[f64], sign: f64) -> (f64, f64) {
    let count = values.len() as f64;
    let centre = 0.5 * (count - 1.0);
    let mean = values.iter().sum::<f64>() / count;
    let moment: f64 = values.iter().enumerate().map(|(i, v)| (i as f64 - centre) * (v - mean)).sum();
    let slope = moment / (count * (count * count - 1.0) / 12.0);
    (sign * (mean + slope * centre), sign * slope)
}
