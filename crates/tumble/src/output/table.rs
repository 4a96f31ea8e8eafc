//! The result for a person at a terminal.

use std::fmt::{self, Write};

use tumble_core::{DEGREE_RAD, STANDARD_GRAVITY_MPS2};

use super::{Matrix, Report, Vector};
use crate::recording::{Basis, Inference, Known, Recording};

/// What the recording is, as far as it says or shows.
pub fn recording(recording: &Recording, inference: &Inference) -> String {
    let mut text = String::new();
    let rows = &recording.rows;
    let length_s = rows.last().map_or(0.0, |last| last.t_s - recording.origin_s());
    let sensor = recording.metadata.sensor.as_deref().unwrap_or("sensor not stated");
    let _ = writeln!(
        text,
        "{sensor}: {} samples, {length_s:.1} s at {:.2} Hz; gyroscope ±{:.0} °/s ({}), accelerometer ±{:.0} g ({})",
        rows.len(),
        inference.rate_hz,
        inference.gyro_range_dps.value,
        basis(&inference.gyro_range_dps),
        inference.accel_range_g.value,
        basis(&inference.accel_range_g),
    );
    for notice in &recording.notices {
        let _ = writeln!(text, "note: {notice}");
    }
    if let Some(longest) = inference.gaps.iter().max_by(|a, b| a.length_s.total_cmp(&b.length_s)) {
        let _ = writeln!(
            text,
            "note: {} gaps, {} samples missing; the longest, {:.3} s, at {:.3} s",
            inference.gaps.len(),
            inference.missing(),
            longest.length_s,
            longest.start_s
        );
    }
    let names = ["gx_dps", "gy_dps", "gz_dps", "ax_g", "ay_g", "az_g"];
    for (name, count) in names.iter().zip(inference.clipped_counts(rows)).filter(|(_, count)| *count > 0) {
        let _ = writeln!(text, "note: {name} stands at the end of its range in {count} samples");
    }
    text
}

fn basis(known: &Known) -> &'static str {
    match known.basis {
        Basis::Stated => "stated",
        Basis::Step => "by its least step",
        Basis::Largest => "at least, by its largest value",
    }
}

/// The verdict, the numbers with their sigmas, and what they rest on.
pub fn report(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_report(&mut text, report);
    text
}

fn write_report(to: &mut String, report: &Report) -> fmt::Result {
    writeln!(to, "verdict: {}", report.verdict.replace('_', " "))?;
    for reason in &report.reasons {
        writeln!(to, "  - {reason}")?;
    }
    if let (Some(accel), Some(gyro)) = (&report.accelerometer, &report.gyroscope) {
        let frame = report.frame.as_deref().unwrap_or("-");
        writeln!(to, "\n{}, axes of the {frame}", report.model)?;
        writeln!(to, "{:<28}{:>12}{:>12}{:>12}", "", "x", "y", "z")?;
        bias(to, "accelerometer bias, mg", &accel.bias_mps2, &accel.bias_sigma_mps2, 1000.0 / STANDARD_GRAVITY_MPS2)?;
        correction(to, "accelerometer", &accel.correction, &accel.correction_sigma)?;
        bias(to, "gyroscope bias, °/s", &gyro.bias_rad_s, &gyro.bias_sigma_rad_s, 1.0 / DEGREE_RAD)?;
        correction(to, "gyroscope", &gyro.correction, &gyro.correction_sigma)?;
        if let (Some(value), Some(sigma)) = (gyro.g_sensitivity_rad_s_per_mps2, gyro.g_sensitivity_sigma_rad_s_per_mps2)
        {
            sensitivity(to, &value, &sigma)?;
        }
    }
    for carried in &report.with {
        writeln!(to, "carried besides: {}: {}", carried.id, carried.equation)?;
        for value in &carried.parameters {
            writeln!(to, "    {:<26}{:>12.5} ± {:.5} {}", value.name, value.value, value.sigma, value.unit)?;
        }
    }
    write_segments(to, report)?;
    if let Some(fit) = &report.fit {
        writeln!(
            to,
            "fit: NIS per degree of freedom {:.2}; gravity rms {:.2} mg, largest {:.2} mg; turn closure rms {:.3}°",
            fit.nis_per_dof, fit.gravity_rms_mg, fit.gravity_max_mg, fit.turn_closure_rms_deg
        )?;
    }
    Ok(())
}

fn bias(to: &mut String, name: &str, value: &Vector, sigma: &Vector, unit: f32) -> fmt::Result {
    row(to, name, value.map(|v| Some(v * unit)), 4)?;
    row(to, "  one sigma", sigma.map(|v| Some(v * unit)), 4)
}

/// Row by row.
fn correction(to: &mut String, sensor: &str, value: &Matrix, sigma: &Matrix) -> fmt::Result {
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        let name = format!("{sensor} correction {axis}");
        row(to, &name, value[i], 6)?;
        row(to, "  one sigma", sigma[i], 6)?;
    }
    Ok(())
}

/// Row by row, per g. Taken off the raw rate for the compensated force, beside the bias.
fn sensitivity(to: &mut String, value: &[Vector; 3], sigma: &[Vector; 3]) -> fmt::Result {
    let unit = STANDARD_GRAVITY_MPS2 / DEGREE_RAD;
    writeln!(to, "the gyroscope feels force: ideal = correction * (raw - bias - this * accelerometer's ideal)")?;
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        row(to, &format!("gyroscope {axis}, °/s per g"), value[i].map(|v| Some(v * unit)), 4)?;
        row(to, "  one sigma", sigma[i].map(|v| Some(v * unit)), 4)?;
    }
    Ok(())
}

fn row(to: &mut String, name: &str, values: [Option<f32>; 3], decimals: usize) -> fmt::Result {
    write!(to, "{name:<28}")?;
    for value in values {
        match value {
            Some(value) => write!(to, "{value:>12.decimals$}")?,
            None => write!(to, "{:>12}", "not seen")?, // not observable: never a number
        }
    }
    writeln!(to)
}

fn write_segments(to: &mut String, report: &Report) -> fmt::Result {
    let count = |kind: &str| report.segments.iter().filter(|s| s.kind == kind).count();
    if report.segments.is_empty() {
        return Ok(());
    }
    writeln!(to, "\nfound {} stills, {} turns and {} moves", count("still"), count("turn"), count("move"))?;
    for segment in report.segments.iter().filter(|s| !s.used && !s.why.is_empty()) {
        writeln!(
            to,
            "  left out: {} on {} from {:.2} to {:.2} s: {}",
            segment.kind, segment.face, segment.start_s, segment.end_s, segment.why
        )?;
    }
    Ok(())
}
