//! The segments of a tape with the samples that they were made from.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use tumble_core::estimate::stand::standing;
use tumble_core::face::Face;
use tumble_core::tape::{Exclusion, Kind, Record, Segment};

use crate::integrate;
use crate::recording::Reading;
use crate::settle::HostTape;

/// Window of the angular acceleration's slope to either side, s: a twelfth, as long as the device's records.
const SLOPE_S: f64 = 1.0 / 12.0;

/// Between two samples.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    /// s.
    pub dt_s: f64,
    /// Raw rates at both ends, rad/s.
    pub rates: [Vector3<f64>; 2],
    /// Raw, what the rate between them adds to their mean, rad.
    pub bend: Vector3<f64>,
    /// Raw specific force, the mean of both ends, m/s².
    pub force: Vector3<f64>,
    /// Raw rate, mean of a window, rad/s.
    pub smooth_rate: Vector3<f64>,
    /// Slope of the raw rate over the window, rad/s².
    pub slope: Vector3<f64>,
}

/// A segment and what was measured in it.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// As on the tape.
    pub segment: Segment,
    /// Its number on the tape.
    pub number: usize,
    /// The face that a rest stands on the table with.
    pub face: Option<Face>,
    /// In order of time.
    pub intervals: Vec<Interval>,
    /// s.
    pub duration_s: f64,
    /// Means over it, raw.
    pub mean_rate: Vector3<f64>,
    /// Likewise, m/s².
    pub mean_force: Vector3<f64>,
}

/// All segments with their samples; those without samples are left out.
pub fn stretches(segments: &[Segment], readings: &[Reading]) -> Vec<Stretch> {
    (0..segments.len()).filter_map(|number| stretch(number, segments, readings)).collect()
}

/// The same from the tape's own records, what the device itself works from; `resting_rate` in rad/s.
pub fn records(tape: &HostTape, resting_rate: &Vector3<f64>) -> Vec<Stretch> {
    let all = (0..tape.len()).filter_map(|index| tape.record(index)).collect::<Vec<Record>>();
    let stretch = |number: usize| {
        let segment = &tape.segments()[number];
        let range = usize::from(segment.first)..usize::from(segment.end);
        assemble(number, tape.segments(), range.map(|index| recorded(&all, resting_rate, index)).collect())
    };
    (0..tape.segments().len()).filter_map(stretch).collect()
}

fn recorded(records: &[Record], resting_rate: &Vector3<f64>, index: usize) -> Interval {
    let record = &records[index];
    let rate = |record: &Record| record.rotation_rad.cast::<f64>() / f64::from(record.dt_s);
    let before = index.checked_sub(1).map_or(record, |before| &records[before]);
    let after = records.get(index + 1).unwrap_or(record);
    let (dt_s, span_s) = (f64::from(record.dt_s), f64::from(0.5 * (before.dt_s + after.dt_s) + record.dt_s));
    let slope = (rate(after) - rate(before)) / span_s;
    // The record's own coning, of the mean rate less the resting rate, goes out: `turned` has it anew from the slope. Its mean rate is not
    // known before: twice, for of a mrad of coning once leaves 20 µrad, and twice 0.3.
    let without = |mean: Vector3<f64>| rate(record) - (mean - resting_rate).cross(&slope) * (dt_s * dt_s / 12.0);
    let mean = without(without(rate(record)));
    Interval {
        dt_s,
        rates: [-0.5, 0.5].map(|end| mean + slope * (end * dt_s)),
        bend: Vector3::zeros(),
        force: record.specific_force_mps2.cast(),
        smooth_rate: rate(record),
        slope,
    }
}

fn stretch(number: usize, segments: &[Segment], readings: &[Reading]) -> Option<Stretch> {
    let segment = &segments[number];
    let first = readings.partition_point(|reading| reading.sample.t_us < segment.start_us);
    let end = readings.partition_point(|reading| reading.sample.t_us <= segment.end_us);
    assemble(number, segments, (first + 1..end).map(|last| interval(readings, last)).collect())
}

fn assemble(number: usize, segments: &[Segment], intervals: Vec<Interval>) -> Option<Stretch> {
    let duration_s: f64 = intervals.iter().map(|interval| interval.dt_s).sum();
    if duration_s <= 0.0 {
        return None;
    }
    let mean = |f: fn(&Interval) -> Vector3<f64>| {
        intervals.iter().map(|interval| f(interval) * interval.dt_s).sum::<Vector3<f64>>() / duration_s
    };
    let mean_rate = mean(|interval| 0.5 * (interval.rates[0] + interval.rates[1]));
    let mean_force = mean(|interval| interval.force);
    let (segment, face) = (segments[number], standing(segments, number));
    Some(Stretch { segment, number, face, duration_s, mean_rate, mean_force, intervals })
}

fn interval(readings: &[Reading], last: usize) -> Interval {
    let time_s = |index: usize| readings[index].sample.t_us as f64 * 1e-6;
    let rate = |index: usize| readings[index].sample.angular_rate_rad_s.cast::<f64>();
    let force = |index: usize| readings[index].sample.specific_force_mps2.cast::<f64>();
    let middle_s = 0.5 * (time_s(last) + time_s(last - 1));
    let window = (0..last).rev().take_while(|&index| middle_s - time_s(index) < SLOPE_S);
    let window = window.chain((last..readings.len()).take_while(|&index| time_s(index) - middle_s < SLOPE_S));
    let (mut count, mut sum, mut moment, mut inertia) = (0.0, Vector3::zeros(), Vector3::zeros(), 0.0);
    for index in window {
        let lever = time_s(index) - middle_s;
        count += 1.0;
        sum += rate(index);
        moment += rate(index) * lever;
        inertia += lever * lever;
    }
    Interval {
        dt_s: time_s(last) - time_s(last - 1),
        rates: [rate(last - 1), rate(last)],
        bend: integrate::bend(last, readings.len(), time_s, rate),
        force: 0.5 * (force(last - 1) + force(last)),
        smooth_rate: sum / count,
        slope: moment / inertia,
    }
}

impl Stretch {
    /// Adds a rate to all.
    pub fn shift(&mut self, by: &Vector3<f64>) {
        self.mean_rate += by;
        for interval in &mut self.intervals {
            interval.rates.iter_mut().chain([&mut interval.smooth_rate]).for_each(|rate| *rate += by);
        }
    }

    /// Is it a rest that counts?
    pub fn is_rest(&self) -> bool {
        self.segment.is_usable_still()
    }

    /// Is it a motion on the table that counts?
    pub fn is_turn(&self) -> bool {
        matches!(self.segment.kind, Kind::OnTable { .. }) && self.segment.exclusion == Exclusion::None
    }

    /// Is rotation lost in it?
    pub fn is_broken(&self) -> bool {
        matches!(self.segment.exclusion, Exclusion::Clipped | Exclusion::Gap | Exclusion::BiasJump)
    }
}

impl Interval {
    /// The rotation over it, by `ω = M (raw − b)`.
    pub fn turned(&self, correction: &Matrix3<f64>, bias: &Vector3<f64>) -> UnitQuaternion<f64> {
        let [a, b] = self.rates.map(|rate| correction * (rate - bias));
        integrate::rotation(&a, &b, &(correction * self.bend), self.dt_s)
    }
}
