//! A recording through the gates, what they repair and mask, and its twin: how every diagnosis and every trial begins.

use tumble_core::calibration::Reason;
use tumble_core::estimate::{Conditions, judge};
use tumble_core::tape::Kind;

use super::gates::{self, Gated, Leap, Scene};
use super::options::Options;
use super::prepare::{Prepared, prepare};
use super::search::bench::Bench;
use super::twin::data::Raw;
use crate::recording::{Inference, Reading, Recording};
use crate::settle::{self, Session, Settled};

/// What came of it.
pub struct Intake {
    /// What the gates found.
    pub gated: Gated,
    /// Table and box: as asked for, or as the recording states.
    pub conditions: Conditions,
    /// The twin, or in words why there is none.
    pub prepared: Result<Prepared, String>,
    /// What the estimator says of box, table and sensor, in sentences: the nominal model allows for it.
    pub remarks: Vec<String>,
}

/// Takes a recording in.
pub fn intake(recording: &Recording, options: &Options) -> Intake {
    take(recording, options, false)
}

/// The same, but rotation while the box is moved from face to face is taken for lost.
pub fn intake_without_moves(recording: &Recording, options: &Options) -> Intake {
    take(recording, options, true)
}

/// A recording's twin, with the columns of all that may be searched for.
///
/// # Errors
/// Why there is none, in words.
pub fn bench(recording: &Recording, options: &Options) -> Result<Bench, String> {
    let prepared = intake(recording, options).prepared?;
    Ok(Bench::new(prepared.twin, &options.without))
}

fn take(recording: &Recording, options: &Options, without_moves: bool) -> Intake {
    let inference = Inference::of(recording);
    let origin_s = recording.origin_s();
    let conditions = options.conditions.unwrap_or_else(|| settle::conditions(&recording.metadata));
    let mut readings = recording.samples(&inference);
    let mut samples: Vec<Raw> = recording.rows.iter().map(|row| Raw::of(row, origin_s)).collect();
    let lost = inference.missing();
    let session = Session { readings: &readings, origin_s, lost, conditions };
    let mut settled = session.settle(&mut |_| {});
    let segments = settled.tape.segments();
    let gated = gates::examine(&Scene {
        recording,
        inference: &inference,
        samples: &samples,
        segments,
        without: &options.without,
    });
    if let Some(stop) = &gated.stop {
        let prepared = Err(stop.clone());
        return Intake { gated, conditions, prepared, remarks: Vec::new() };
    }
    let mut masked = masked(&gated);
    if without_moves {
        let segments = settled.tape.segments().iter().enumerate();
        masked.extend(segments.filter(|(_, segment)| matches!(segment.kind, Kind::Hand)).map(|(number, _)| number));
    }
    if !gated.repaired.is_empty() || gated.remap.is_some() || !gated.leaps.is_empty() {
        repair(&mut samples, &mut readings, &gated);
        settled = Session { readings: &readings, origin_s, lost, conditions }.settle(&mut |_| {});
        masked.extend(leapt(&samples, &settled, &gated));
    }
    let remarks = remarks(&settled, lost);
    let prepared = prepare(samples, &settled, conditions, &masked).map_err(|why| why.0);
    Intake { gated, conditions, prepared, remarks }
}

/// What the estimator found that is nobody's physics, but nothing that a person should not hear of: its numbers absorb it.
fn remarks(settled: &Settled, lost: u32) -> Vec<String> {
    let Ok((estimate, _)) = &settled.estimate else { return Vec::new() };
    let reasons = judge::judge(estimate, &settled.tape, lost).0.reasons;
    let mut remarks = Vec::new();
    for reason in &reasons {
        let more = match reason {
            Reason::CrookedBox { .. } => " A table whose tilt changed between two faces would look much like it.",
            Reason::LooseContact { .. } | Reason::OutOfRange { .. } => "",
            _ => continue,
        };
        remarks.push(format!("The nominal model allows for this: {reason}{more}"));
    }
    remarks
}

/// Segments whose readings are bounds, knocks or old: their rotation and force are lost.
fn masked(gated: &Gated) -> Vec<usize> {
    const LOST: [&str; 4] = ["gyro_saturation", "accel_saturation", "shock", "frozen_reading"];
    let lost = gated.found.iter().filter(|found| LOST.contains(&found.id.as_str()));
    lost.flat_map(|found| found.place.segments.iter().copied()).collect()
}

/// Motions in which the bias may have jumped, of the repaired recording.
fn leapt(samples: &[Raw], settled: &Settled, gated: &Gated) -> Vec<usize> {
    let us = |index: usize| (samples[index.min(samples.len() - 1)].t_s * 1e6) as u64;
    let within = |leap: &Leap| (us(leap.within.start), us(leap.within.end));
    let leaps: Vec<(u64, u64)> = gated.leaps.iter().map(within).collect();
    let segments = settled.tape.segments().iter().enumerate();
    let touched = segments.filter(|(_, segment)| {
        leaps.iter().any(|(from_us, to_us)| segment.start_us < *to_us && segment.end_us > *from_us)
    });
    touched.filter(|(_, segment)| !matches!(segment.kind, Kind::Still { .. })).map(|(number, _)| number).collect()
}

/// Puts neighbours' means for samples that are no measurements, and axes and scales right.
pub fn repair(samples: &mut [Raw], readings: &mut [Reading], gated: &Gated) {
    // In order, so that the sample before is good by now; the one after may be the next of a run.
    for (k, &index) in gated.repaired.iter().enumerate() {
        let run = gated.repaired[k..].iter().zip(index..).take_while(|(one, next)| *one == next).count();
        if index == 0 || index + run >= samples.len() {
            continue;
        }
        let (before, after) = (samples[index - 1], samples[index + run]);
        let share = (samples[index].t_s - before.t_s) / (after.t_s - before.t_s).max(f64::MIN_POSITIVE);
        samples[index].rate = before.rate.lerp(&after.rate, share);
        samples[index].force = before.force.lerp(&after.force, share);
    }
    if let Some((rate, force)) = &gated.remap {
        for raw in samples.iter_mut() {
            raw.rate = rate * raw.rate;
            raw.force = force * raw.force;
        }
    }
    for leap in &gated.leaps {
        samples[(leap.within.start + leap.within.end) / 2..].iter_mut().for_each(|raw| raw.rate -= leap.by);
    }
    for (reading, raw) in readings.iter_mut().zip(samples.iter()) {
        reading.sample.angular_rate_rad_s = raw.rate.cast();
        reading.sample.specific_force_mps2 = raw.force.cast();
    }
}
