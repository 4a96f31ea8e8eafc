//! A gyroscope's bias that jumps by more than rests may differ (`gyro_bias_step`, in its gross form; the finer one is found by regression). To the
//! board's segmenter all that follows is one steady turn, which no rest ends.
//!
//! Statistic: stretches of 1.5 s or more, of half seconds as quiet as rests are in every channel (three times the noise), over which neither mean rate nor
//! gravity moves. Let d be such a stretch's rate less that of the nearest rest. If it were rotation, gravity would turn with its part across
//! gravity, by d⊥ T; where it turned by less than half of that, with d⊥ above 0.4 °/s, the box rests and the bias is another. Crooked axes
//! (3 % and 3° askew: 8 %) lend a steady turn about gravity such a part as well, so d⊥ must be a third of d. Two such stretches that agree, before
//! or after all rests, are a jump. Every rest of a clean recording passes the segmenter's own test, so that none is left to be counted here.

use std::ops::Range;

use nalgebra::Vector3;

use super::tell::{Outcome, found, value};
use super::view::{View, scatter};
use crate::diagnose::catalogue::{Card, STRUCTURAL};

const ID: &str = "gyro_bias_step";
const BLOCK_S: f64 = 0.5;
const LEAST_BLOCKS: usize = 3;
/// As quiet as rests, in units of their noise.
const QUIET: f64 = 3.0;
/// A mean rate that moves by more from the stretch's first, °/s, is motion.
const STEADY_DPS: f64 = 0.2;
/// Gravity's direction, from the stretch's first, beyond its noise, rad.
const LEVEL_RAD: f64 = 2e-3;
/// Part of d across gravity: least, °/s, and as a share of d.
const LEAST_DPS: f64 = 0.4;
const LEAST_SHARE: f64 = 1.0 / 3.0;
/// Rates of stretches on one side of the jump agree to this, °/s: what a sensor feels of force.
const AGREE_DPS: f64 = 0.3;
/// Of the rests on either side of the jump, how many tell its size.
const NEAREST: usize = 3;

/// A jump: after which sample at the earliest, before which at the latest, and by how much, rad/s.
#[derive(Clone, Debug)]
pub struct Leap {
    /// Between the last rest before and the first after.
    pub within: Range<usize>,
    /// Later less earlier.
    pub by: Vector3<f64>,
}

/// A quiet stretch: samples and mean rate, °/s.
#[derive(Clone)]
struct Quiet {
    samples: Range<usize>,
    rate: Vector3<f64>,
}

/// The gate; the jump is to be taken out of the samples.
pub fn examine(view: &View) -> (Outcome, Option<Leap>) {
    let nothing = (Outcome::default(), None);
    let rests: Vec<Quiet> =
        view.rests.iter().map(|rest| Quiet { samples: rest.samples.clone(), rate: rest.rate }).collect();
    let (Some(first), Some(last)) = (rests.first(), rests.last()) else { return nothing };
    let resting = resting_otherwise(view, &rests);
    let later = resting.iter().all(|quiet| quiet.samples.start >= last.samples.end);
    let earlier = resting.iter().all(|quiet| quiet.samples.end <= first.samples.start);
    let mean = mean_rate(&resting);
    if resting.len() < 2 || !(later || earlier) || resting.iter().any(|quiet| (quiet.rate - mean).amax() > AGREE_DPS) {
        return nothing;
    }
    let (before, after) = if later { (&rests, &resting) } else { (&resting, &rests) };
    let (Some(until), Some(from)) = (before.last(), after.first()) else { return nothing };
    let (before_rate, after_rate) =
        (mean_rate(&before[before.len().saturating_sub(NEAREST)..]), mean_rate(&after[..after.len().min(NEAREST)]));
    let by = after_rate - before_rate;
    let within = until.samples.end..from.samples.start.max(until.samples.end + 1);
    let Some(card) = card() else { return nothing };
    // Rests beside each other differ by what the sensor feels of force.
    let sigma =
        resting.iter().map(|quiet| (quiet.rate - mean).norm_squared()).sum::<f64>() / (3.0 * resting.len() as f64);
    let sigma = sigma.sqrt().max(0.01);
    let at = |index: usize| view.t_s[index.min(view.len() - 1)];
    let (low_s, high_s) = (at(within.start), at(within.end));
    let mut parameters: Vec<_> =
        ["x", "y", "z"].iter().zip(by.iter()).map(|(axis, by)| value(axis, *by, sigma, "dps")).collect();
    let origin_s = view.scene.recording.origin_s();
    parameters.push(value("at", origin_s + 0.5 * (low_s + high_s), (high_s - low_s) / 12f64.sqrt(), "s"));
    let evidence = 0.5 * (by.norm() / sigma).powi(2);
    let place = view.place(0b111, within.clone());
    let told = found(card, evidence.min(1e4), parameters, place);
    (Outcome { found: Some(told), ..Outcome::default() }, Some(Leap { within, by: by.map(f64::to_radians) }))
}

fn card() -> Option<&'static Card> {
    STRUCTURAL.iter().map(|effect| effect.card).find(|card| card.id == ID)
}

fn mean_rate(all: &[Quiet]) -> Vector3<f64> {
    all.iter().map(|quiet| quiet.rate).sum::<Vector3<f64>>() / all.len().max(1) as f64
}

/// Stretches that rest although their rate is not that of the rests.
fn resting_otherwise(view: &View, rests: &[Quiet]) -> Vec<Quiet> {
    let length = view.count(BLOCK_S).max(4);
    let apart = |rest: &Quiet, at: usize| rest.samples.start.abs_diff(at).min(rest.samples.end.abs_diff(at));
    let mut found = Vec::new();
    let mut start = 0;
    while start + LEAST_BLOCKS * length <= view.len() {
        let Some(quiet) = stretch(view, start, length) else {
            start += length;
            continue;
        };
        start = quiet.samples.end;
        let Some(nearest) = rests.iter().min_by_key(|rest| apart(rest, quiet.samples.start)) else { continue };
        let d = quiet.rate - nearest.rate;
        let up = mean_of(&quiet.samples, |i| view.force(i)).normalize();
        let across_dps = (d - up * d.dot(&up)).norm();
        let time_s = view.t_s[quiet.samples.end - 1] - view.t_s[quiet.samples.start] - BLOCK_S;
        let still = level_rad(view, length) < 0.5 * across_dps.to_radians() * time_s;
        if across_dps > LEAST_DPS && across_dps > LEAST_SHARE * d.norm() && still {
            found.push(quiet);
        }
    }
    found
}

/// The longest quiet stretch from this sample on, if it is long enough.
fn stretch(view: &View, start: usize, length: usize) -> Option<Quiet> {
    let block = |first: usize| {
        let range = first..first + length;
        let quiet =
            (0..6).all(|c| scatter(&view.channels[c][range.clone()]) <= QUIET * view.sigma[c] + 0.5 * view.step[c]);
        quiet.then(|| (mean_of(&range, |i| view.rate(i)), mean_of(&range, |i| view.force(i))))
    };
    let (rate, force) = block(start)?;
    let mut end = start + length;
    while end + length <= view.len() {
        let Some((next_rate, next_force)) = block(end) else { break };
        if (next_rate - rate).amax() > STEADY_DPS || next_force.angle(&force) > level_rad(view, length) {
            break;
        }
        end += length;
    }
    let samples = start..end;
    (end - start >= LEAST_BLOCKS * length).then(|| Quiet { rate: mean_of(&samples, |i| view.rate(i)), samples })
}

/// How far apart two blocks' directions of gravity may be.
fn level_rad(view: &View, length: usize) -> f64 {
    let noise = view.sigma[3..].iter().fold(0.0, |most: f64, sigma| most.max(*sigma));
    LEVEL_RAD + 4.0 * noise / (length as f64).sqrt()
}

fn mean_of(range: &Range<usize>, value: impl Fn(usize) -> Vector3<f64>) -> Vector3<f64> {
    range.clone().map(value).sum::<Vector3<f64>>() / range.len() as f64
}
