//! What ails a recording's samples, before it is calibrated from: the gates of the diagnosis, and what can be put right is.
//!
//! The board reads its sensor on the data-ready interrupt, knows its range and stamps by its own clock. A recording from elsewhere may clip
//! below its range, repeat old values or be stamped by a host, and none of that shows in how well a session fits: gyroscopes that clipped
//! were off by 45 sigma, repeated samples cost 12, jitter of 2 ms 10.

use crate::diagnose::diagnosis::Found;
use crate::diagnose::gates::{self, Scene};
use crate::diagnose::intake::repair;
use crate::diagnose::twin::data::Raw;
use crate::recording::{Inference, Reading, Recording};
use crate::settle::{self, HostTape};

/// Stamps whose errors an even grid takes away: they stray from it by no more than this many of their usual errors (white ones of a
/// session of 10⁵ samples reach 4.4 of their rms, steps one of theirs).
const STRAY: f64 = 6.0;

/// Readings, with what was wrong put right or marked.
pub struct Mended {
    /// In order of time.
    pub readings: Vec<Reading>,
    /// Samples that never came.
    pub lost: u32,
    /// What a person should know, a sentence each.
    pub remarks: Vec<String>,
}

/// Looks for faults of the samples.
pub fn mend(recording: &Recording, inference: &Inference, mut readings: Vec<Reading>) -> Mended {
    let mut tape = Box::new(HostTape::new());
    settle::record(&readings, 1.0, &mut tape);
    let origin_s = recording.origin_s();
    let mut samples: Vec<Raw> = recording.rows.iter().map(|row| Raw::of(row, origin_s)).collect();
    let mut gated =
        gates::examine(&Scene { recording, inference, samples: &samples, segments: tape.segments(), without: &[] });
    let mut lost = inference.missing();
    // Axes and ranges stay as they are recorded: which of the two triads is wrong is for a person to say.
    gated.remap = None;
    if !gated.repaired.is_empty() {
        repair(&mut samples, &mut readings, &gated);
    }
    for (index, channels) in &gated.clipped {
        readings[*index].clipped |= channels;
    }
    let mut remarks = Vec::new();
    for found in &gated.found {
        let done = match found.id.as_str() {
            "gyro_saturation" | "accel_saturation" | "frozen_reading" => "what moved meanwhile is left out",
            "duplicated_samples" | "byte_tearing" => "the means of their neighbours were put in their places",
            "timestamp_jitter" | "timestamp_quantization" if restamp(&mut readings, found) => {
                lost = 0;
                "samples were taken to be evenly spaced"
            }
            "timestamp_jitter"
            | "timestamp_quantization"
            | "undersampling"
            | "gyro_coarse_quantization"
            | "gyro_dead_zone"
            | "axis_mapping"
            | "wrong_full_scale" => "numbers are less sure than their sigmas say",
            // What swings, stops short or knocks distorts no sample, and the estimator counts the lost itself.
            _ => continue,
        };
        remarks.push(remark(found, done));
    }
    Mended { readings, lost, remarks }
}

fn remark(found: &Found, done: &str) -> String {
    let numbers: Vec<String> = found
        .parameters
        .iter()
        .take(2)
        .map(|value| format!("{} {:.4} {}", value.name, value.value, value.unit))
        .collect();
    let numbers = numbers.iter().map(|number| number.trim_end()).collect::<Vec<_>>().join(", ");
    format!(
        "The samples have a fault, {} ({numbers}): {done}. `tumble diagnose` tells more. To do better: {}.",
        found.name, found.separate_by
    )
}

/// Gives samples the stamps of an even grid, if their own nowhere stray from it by more than their errors.
fn restamp(readings: &mut [Reading], found: &Found) -> bool {
    let (Some(first), Some(last), Some(error)) = (readings.first(), readings.last(), found.parameters.first()) else {
        return false;
    };
    let (from_us, count) = (first.sample.t_us as f64, (readings.len() - 1).max(1) as f64);
    let spacing_us = (last.sample.t_us as f64 - from_us) / count;
    let grid = |index: usize| from_us + spacing_us * index as f64;
    // Milliseconds, an rms or a step.
    let allowed_us = STRAY * 1e3 * error.value;
    let even =
        readings.iter().enumerate().all(|(k, reading)| (reading.sample.t_us as f64 - grid(k)).abs() < allowed_us);
    if even {
        readings.iter_mut().enumerate().for_each(|(k, reading)| reading.sample.t_us = grid(k).round() as u64);
    }
    even
}
