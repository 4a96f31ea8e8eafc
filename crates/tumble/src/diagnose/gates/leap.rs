//! A gyroscope's bias that jumps by more than rests may differ (`gyro_bias_step`, in its gross form; the finer one is found by regression).
//!
//! The segmenter tells such a jump from a steady turn by gravity (`tumble_core::motion::standstill`) and marks the motion that holds it. Its
//! size is what the rests on either side differ by.

use std::ops::Range;

use nalgebra::Vector3;
use tumble_core::tape::Exclusion;

use super::tell::{Outcome, found, value};
use super::view::{Rest, View};
use crate::diagnose::catalogue::{Card, STRUCTURAL};

const ID: &str = "gyro_bias_step";
/// Of the rests on either side of the jump, how many tell its size.
const NEAREST: usize = 3;
/// What is known of a rest's mean besides its noise, °/s: what the sensor feels of force differs from face to face by as much.
const LEAST_SIGMA_DPS: f64 = 0.01;

/// A jump of the bias.
#[derive(Clone, Debug)]
pub struct Leap {
    /// The motion that holds it, samples.
    pub within: Range<usize>,
    /// Later less earlier, rad/s.
    pub by: Vector3<f64>,
    /// Of each component.
    sigma: f64,
}

/// The gate tells the largest; all are to be taken out of the samples.
pub fn examine(view: &View) -> (Outcome, Vec<Leap>) {
    let jumped = view.scene.segments.iter().filter(|segment| segment.exclusion == Exclusion::BiasJump);
    let leaps: Vec<Leap> = jumped.filter_map(|segment| leap(view, view.samples_of(segment))).collect();
    let largest = leaps.iter().max_by(|a, b| a.by.norm().total_cmp(&b.by.norm()));
    (largest.map_or_else(Outcome::default, |leap| tell(view, leap)), leaps)
}

fn leap(view: &View, within: Range<usize>) -> Option<Leap> {
    let middle = |rest: &Rest| (rest.samples.start + rest.samples.end) / 2;
    let (before, after) = view.rests.split_at(view.rests.partition_point(|rest| middle(rest) < within.start));
    let (before, after) = (&before[before.len().saturating_sub(NEAREST)..], &after[..after.len().min(NEAREST)]);
    if before.is_empty() || after.is_empty() {
        return None;
    }
    let by = mean_rate(after) - mean_rate(before);
    let sigma_dps = scatter(before).max(scatter(after)).max(LEAST_SIGMA_DPS);
    Some(Leap { within, by: by.map(f64::to_radians), sigma: sigma_dps.to_radians() })
}

fn tell(view: &View, leap: &Leap) -> Outcome {
    let Some(card) = STRUCTURAL.iter().map(|effect| effect.card).find(|card: &&Card| card.id == ID) else {
        return Outcome::default();
    };
    let at = |index: usize| view.t_s[index.min(view.len() - 1)];
    let (low_s, high_s) = (at(leap.within.start), at(leap.within.end));
    let sigma_dps = leap.sigma.to_degrees();
    let mut parameters: Vec<_> = ["x", "y", "z"]
        .iter()
        .zip(leap.by.iter())
        .map(|(axis, by)| value(axis, by.to_degrees(), sigma_dps, "dps"))
        .collect();
    let origin_s = view.scene.recording.origin_s();
    parameters.push(value("at", origin_s + 0.5 * (low_s + high_s), (high_s - low_s) / 12f64.sqrt(), "s"));
    let evidence = 0.5 * (leap.by.norm() / leap.sigma).powi(2);
    let told = found(card, evidence.min(1e4), parameters, view.place(0b111, leap.within.clone()));
    Outcome { found: Some(told), ..Outcome::default() }
}

fn mean_rate(rests: &[Rest]) -> Vector3<f64> {
    rests.iter().map(|rest| rest.rate).sum::<Vector3<f64>>() / rests.len().max(1) as f64
}

/// Of one component, °/s.
fn scatter(rests: &[Rest]) -> f64 {
    let mean = mean_rate(rests);
    let squares: f64 = rests.iter().map(|rest| (rest.rate - mean).norm_squared()).sum();
    (squares / (3.0 * rests.len().max(1) as f64)).sqrt()
}
