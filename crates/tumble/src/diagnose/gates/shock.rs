//! A knock that the procedure does not bring about (`shock`).
//!
//! Statistic: the specific force less its median over ±60 ms. A knock is a burst of at most 35 ms (a single sample only if two
//! channels stand out by 12 sigmas) whose peak is above 12 times the rms of what surrounds it, from 1.2 s (where motion changes
//! sooner: 0.4 s) before to as much after, four times the largest of it, and above 0.05 g. A normal deviate
//! reaches 12 sigmas with 1e-33: chance has no part in it. What must be kept out is what people do: put-downs, pushes and
//! stops at a fence. They come where motion changes, so gravity's direction (3°) and the mean rate (3 °/s, or four tenths of the
//! rate) must be the same before and after; a hand's moves fail the rms, since they are as rough everywhere. Within 0.4 s of
//! the recording's ends, of a put-down or of a hand that takes hold nothing is told.
//!
//! Limit: what is asked of a peak, at places all over the recording where motion does not change, at its 95th percentile; a half sine
//! of two samples shows at least 0.71 of its peak, and the filter and the median take some more: over 0.6.

use super::chance::{median, quantile};
use super::tell::{Outcome, found, limit, value};
use super::view::View;
use crate::diagnose::catalogue::Card;
use nalgebra::Vector3;
use std::ops::Range;

const IMITATED: &[&str] =
    &["gyro_bias_step", "accel_bias_step", "accel_quadratic", "gyro_g_squared", "platform_tilt_change"];
const MEDIAN_S: f64 = 0.06;
const AROUND_S: [f64; 2] = [1.2, 0.4];
/// Share of its peak that a short half sine shows.
const SHOWN: f64 = 0.6;
/// Places at which the limit is looked for, s.
const PLACES_S: f64 = 0.25;
const LONGEST_S: f64 = 0.035;
const LEAST_G: f64 = 0.05;
const TIMES: f64 = 12.0;
const SAME_RAD: f64 = 0.052;
const SAME_DPS: f64 = 3.0;

pub(super) const CARD: Card = Card {
    id: "shock",
    name: "one knock",
    equation: "force += A·u·sin(πt/T) for T of 5 to 30 ms",
    typical: "a tap 0.2 to 2 g, 5 to 20 ms (half sine as in IEC 60068-2-27); a dropped tool 5 g",
    shows: "a few samples of all channels",
    confounded: &["byte_tearing"],
    separate_by: "leave the table alone while it records: what comes again comes from the sensor",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let rough = roughness(view);
    let noise = (3..6).map(|c| view.sigma[c]).filter(|s| s.is_finite()).fold(0.0, f64::max);
    let least = LEAST_G.max(TIMES * noise);
    let why = "half a second or more from where motion begins or ends";
    let mut outcome = Outcome { limit: limit(&CARD, least_g(view, &rough, least), "g", why), ..Outcome::default() };
    let mut knocks: Vec<(Range<usize>, f64, f64)> = Vec::new();
    let mut index = 0;
    while index < rough.len() {
        if rough[index] < least {
            index += 1;
            continue;
        }
        let burst = burst(view, &rough, index);
        let knock = knock(view, &rough, &burst);
        // What is rough for long may have a knock in it.
        index = if knock.is_some() { burst.end } else { index + 1 };
        knocks.extend(knock.map(|(peak, over)| (burst, peak, over)));
    }
    if let Some((strongest, peak, over)) = knocks.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        let start_s = view.scene.recording.origin_s() + view.t_s[strongest.start];
        let parameters = vec![
            value("peak", *peak, noise + 0.1 * peak, "g"),
            value("time", start_s, view.dt_s, "s"),
            value("knocks", knocks.len() as f64, 0.0, ""),
        ];
        outcome.found = Some(found(&CARD, 0.5 * over * over, parameters, view.place(0x3f, strongest.clone())));
        outcome.imitated = IMITATED;
        // One sample to either side: the filter's tails.
        outcome.repaired = knocks
            .iter()
            .flat_map(|knock| knock.0.start.saturating_sub(1)..(knock.0.end + 1).min(view.len()))
            .collect();
    }
    outcome
}

/// Length of the force less its running median, g.
fn roughness(view: &View) -> Vec<f64> {
    let half = view.count(MEDIAN_S).max(4);
    let count = view.len();
    let mut squares = vec![0.0; count];
    let mut window = Vec::new();
    for channel in &view.channels[3..] {
        for (i, square) in squares.iter_mut().enumerate() {
            window.clear();
            window.extend_from_slice(&channel[i.saturating_sub(half)..(i + half + 1).min(count)]);
            let middle = window.len() / 2;
            let median = *window.select_nth_unstable_by(middle, f64::total_cmp).1;
            *square += (channel[i] - median).powi(2);
        }
    }
    squares.into_iter().map(f64::sqrt).collect()
}

/// 30 ms.
fn calm(view: &View) -> usize {
    view.count(0.03).max(2)
}

/// The samples above a tenth of the peak, to the last before 30 ms of calm. A turn may be rougher all along than the limit: what comes first
/// above that is not where a knock begins.
fn burst(view: &View, rough: &[f64], start: usize) -> Range<usize> {
    let calm = calm(view);
    let ahead = &rough[start..(start + view.count(0.5)).min(rough.len())];
    let peak = ahead.iter().take(calm + view.count(LONGEST_S)).fold(0.0_f64, |max, v| max.max(*v));
    let start = start + ahead.iter().position(|value| *value > 0.1 * peak).unwrap_or(0);
    let ahead = &rough[start..(start + view.count(0.5)).min(rough.len())];
    let mut end = start + 1;
    for (i, value) in (start..).zip(ahead) {
        if *value > 0.1 * peak {
            end = i + 1;
        } else if i >= end + calm {
            break;
        }
    }
    start..end
}

/// Its peak and how many times the surrounding rms that is, if it is a knock.
fn knock(view: &View, rough: &[f64], burst: &Range<usize>) -> Option<(f64, f64)> {
    let length_s = burst.len() as f64 * view.dt_s;
    if length_s > LONGEST_S.max(3.5 * view.dt_s) || !is_shared(view, burst) {
        return None;
    }
    let peak = rough[burst.clone()].iter().fold(0.0_f64, |max, v| max.max(*v));
    let before = burst.start.saturating_sub(calm(view))..burst.start;
    if rough[before].iter().any(|value| *value > 0.1 * peak) {
        return None;
    }
    AROUND_S.into_iter().find_map(|around_s| {
        let calm = Calm::about(view, rough, burst, around_s)?;
        (peak > calm.asked()).then(|| (peak, peak / calm.rms.max(1e-9)))
    })
}

/// A single sample of one channel is a reading gone wrong; a knock that is as short as a sample moves several.
fn is_shared(view: &View, burst: &Range<usize>) -> bool {
    let between = burst.start > 0 && burst.end < view.len();
    let stands_out = |channel: &usize| view.bend(*channel, burst.start) > TIMES * view.sigma[*channel];
    burst.len() > 1 || (between && (0..6).filter(stands_out).count() > 1)
}

/// What surrounds a place where motion does not change.
struct Calm {
    rms: f64,
    largest: f64,
}

impl Calm {
    fn about(view: &View, rough: &[f64], burst: &Range<usize>, around_s: f64) -> Option<Self> {
        let (around, gap) = (view.count(around_s), view.count(0.04).max(2));
        if burst.start < around || burst.end + around > view.len() || around < 2 * gap {
            return None;
        }
        let sides = [burst.start - around..burst.start - gap, burst.end + gap..burst.end + around];
        let largest = |range: &Range<usize>| rough[range.clone()].iter().fold(0.0_f64, |max, v| max.max(*v));
        let square =
            |range: &Range<usize>| rough[range.clone()].iter().map(|v| v * v).sum::<f64>() / range.len() as f64;
        same_motion(view, &sides[0], &sides[1]).then(|| Self {
            rms: square(&sides[0]).max(square(&sides[1])).sqrt(),
            largest: largest(&sides[0]).max(largest(&sides[1])),
        })
    }

    /// Of a peak. Knocks beside it belong to a put-down, which bounces: it must be four times as large.
    fn asked(&self) -> f64 {
        (TIMES * self.rms).max(4.0 * self.largest)
    }
}

/// The smallest knock that is found in 95 of 100 places, g.
fn least_g(view: &View, rough: &[f64], least: f64) -> f64 {
    let asked = |place: usize| {
        let here = place..place + 2;
        let calm = |around_s| Calm::about(view, rough, &here, around_s).map(|calm| calm.asked().max(least));
        AROUND_S.into_iter().filter_map(calm).reduce(f64::min)
    };
    let mut all: Vec<f64> = (0..rough.len()).step_by(view.count(PLACES_S)).filter_map(asked).collect();
    quantile(&mut all, 0.95) / SHOWN
}

fn same_motion(view: &View, before: &Range<usize>, after: &Range<usize>) -> bool {
    let middle = |range: &Range<usize>, channel: usize| median(view.channels[channel][range.clone()].to_vec());
    let force = |range: &Range<usize>| Vector3::from_fn(|i, _| middle(range, 3 + i));
    let rate = |range: &Range<usize>| Vector3::from_fn(|i, _| middle(range, i));
    let up = view.rests.iter().map(|rest| rest.rate).next().unwrap_or_default();
    let (r0, r1) = (rate(before) - up, rate(after) - up);
    // A whole turn's axis is up; a re-orientation's is not, and gravity moves with it.
    force(before).angle(&force(after)) < SAME_RAD && (r1 - r0).norm() < SAME_DPS.max(0.4 * r0.norm().min(r1.norm()))
}
