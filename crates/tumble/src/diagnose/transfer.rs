//! What was found in one recording, tried on another with the very same numbers: the proof that nobody can fit.
//!
//! On the other recording the nominal sensor is fitted anew (its biases and scales may have moved), the effect is not.

use super::diagnosis::{Diagnosis, Found, OtherRecording};
use super::intake::bench;
use super::options::Options;
use super::search::bench::{Bench, Placed};
use crate::recording::Recording;

/// What a sensor keeps from one recording to the next. Not among them: steps and warm-up (they have their own time), walks
/// (they have a size but no course), turns, table, Earth and lever arm (they belong to the day, not to the sensor).
pub const CARRY_OVER: [&str; 14] = [
    "gyro_g_sensitivity",
    "gyro_g_squared",
    "gyro_scale_quadratic",
    "gyro_scale_cubic",
    "gyro_scale_asymmetry",
    "gyro_dead_zone",
    "gyro_bias_temperature",
    "gyro_scale_temperature",
    "accel_bias_temperature",
    "accel_scale_temperature",
    "accel_quadratic",
    "accel_cubic",
    "accel_internal_lever_arms",
    "gyro_accel_lag",
];
/// The moments at which an effect is evaluated come from samples that contain it: once more with it taken out.
const ROUNDS: usize = 2;

/// Columns of a bench with the size that each has.
type Sized = Vec<(usize, f64)>;

/// Tries what `diagnosis` found on `recording`, and enters the result there.
pub fn try_on(diagnosis: &mut Diagnosis, recording: &Recording, file: &str, options: &Options) {
    if !diagnosis.effects.iter().any(carries) {
        if !diagnosis.effects.is_empty() {
            diagnosis.reasons.push(format!("{file}: not tried, nothing that was found stays with the sensor."));
        }
        return;
    }
    let mut bench = match bench(recording, options) {
        Ok(bench) => bench,
        Err(why) => return diagnosis.reasons.push(format!("{file}: not tried, {why}.")),
    };
    let sized: Vec<Option<Sized>> = diagnosis.effects.iter().map(|found| sizes(&bench, found)).collect();
    let (after, rows) = mean_square(&mut bench, &sized.iter().flatten().flatten().copied().collect::<Vec<_>>());
    for (k, found) in diagnosis.effects.iter_mut().enumerate().filter(|(_, found)| carries(found)) {
        if sized[k].is_none() {
            diagnosis.reasons.push(format!("{file}: {} was not tried, it cannot show in this recording.", found.id));
            continue;
        }
        let others: Sized = (0..sized.len()).filter(|j| *j != k).filter_map(|j| sized[j].clone()).flatten().collect();
        let (before, _) = mean_square(&mut bench, &others);
        let gain = 0.5 * rows * (before - after);
        found.other_recordings.push(OtherRecording { file: file.into(), before, after, gain });
    }
}

/// Does it stay with the sensor?
pub fn carries(found: &Found) -> bool {
    CARRY_OVER.contains(&found.id.as_str())
}

/// The effect's columns on this bench at the sizes that were found; none if it does not carry over or cannot show.
fn sizes(bench: &Bench, found: &Found) -> Option<Sized> {
    if !carries(found) {
        return None;
    }
    let candidate = bench.candidates.iter().find(|candidate| candidate.effect.card.id == found.id)?;
    let value = |name: &str| found.parameters.iter().find(|value| value.name == name).map(|value| value.value);
    // Of several settings the nearest to the one found.
    let off = |placed: &Placed| match placed.setting {
        Some((name, at, _)) => value(name).map_or(f64::MAX, |found| (found - at).abs()),
        None => 0.0,
    };
    let placed = candidate.variants.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    let sized = placed.columns.clone().zip(&placed.parameters);
    sized.map(|(column, parameter)| Some((column, value(&parameter.name)?))).collect()
}

/// Mean square and number of the nominal's rows when these are taken out of the samples and the nominal is fitted to what
/// is left.
fn mean_square(bench: &mut Bench, sized: &[(usize, f64)]) -> (f64, f64) {
    bench.take_out(&[]);
    bench.fit_nominal();
    for _ in 0..if sized.is_empty() { 0 } else { ROUNDS } {
        bench.take_out(sized);
        bench.fit_nominal();
    }
    let rows = bench.twin.rows(&[]);
    (rows.mean_square(|_| true), rows.at.len() as f64)
}
