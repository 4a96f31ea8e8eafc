//! Effects added to a recording of a real sensor.
//!
//! Metadata stay as they are, but for the rate if the effect changes it. Readings that no effect touches keep their
//! digits; the others get as many decimals as their column has, and are rounded to counts where the recording states
//! its ranges.

use nalgebra::Vector3;
use tumble_sim::effect::{EffectError, inject};
use tumble_sim::sensor::EffectTruth;
use tumble_sim::sensor::Quantisation;
use tumble_sim::{Effect, Sample};

use crate::recording::{Basis, Inference, Known, Recording, Row, STANDARD_GRAVITY_MPS2};

/// More than that is rounding of the arithmetic.
const MOST_DECIMALS: usize = 9;

/// Adds effects; says what was drawn.
pub fn add(recording: &mut Recording, effects: &[Effect], seed: u64) -> Result<Vec<EffectTruth>, EffectError> {
    let decimals = decimals(&recording.rows);
    let ranges = ranges(recording);
    let mut samples: Vec<Sample> = recording.rows.iter().map(sample).collect();
    let before = samples.clone();
    let truths = inject(effects, &mut samples, ranges, seed)?;
    let same_rows = samples.len() == recording.rows.len();
    let rows = samples.iter().enumerate().map(|(k, sample)| {
        let old = same_rows.then(|| (&recording.rows[k], &before[k]));
        row(sample, old, &decimals)
    });
    recording.rows = rows.collect();
    for kept in truths.iter().flat_map(|truth| &truth.parameters).filter(|one| one.name == "kept_one_of") {
        recording.metadata.rate_hz = recording.metadata.rate_hz.map(|rate_hz| rate_hz / kept.value);
    }
    Ok(truths)
}

/// Ranges that are stated or that the least step shows. One that is merely large enough for the largest reading says
/// nothing of the step.
fn ranges(recording: &Recording) -> Option<Quantisation> {
    let inference = Inference::of(recording);
    let known = |range: Known| (range.basis != Basis::Largest).then_some(range.value);
    let (gyro, accel) = (known(inference.gyro_range_dps)?, known(inference.accel_range_g)?);
    Some(Quantisation { gyro_range_dps: gyro, accel_range_g: accel })
}

fn sample(row: &Row) -> Sample {
    Sample {
        t_s: row.t_s,
        angular_rate_rad_s: Vector3::from(row.gyro_dps.map(f64::to_radians)),
        specific_force_mps2: Vector3::from(row.accel_g.map(|g| g * STANDARD_GRAVITY_MPS2)),
        temperature_degc: row.temp_c.unwrap_or(f64::NAN),
    }
}

/// The most decimals of the stamps, the rates, the forces and the temperatures.
fn decimals(rows: &[Row]) -> [usize; 4] {
    let of = |value: f64| value.to_string().split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let most = |values: &mut dyn Iterator<Item = f64>| values.map(of).max().unwrap_or(0).min(MOST_DECIMALS);
    [
        most(&mut rows.iter().map(|row| row.t_s)),
        most(&mut rows.iter().flat_map(|row| row.gyro_dps)),
        most(&mut rows.iter().flat_map(|row| row.accel_g)),
        most(&mut rows.iter().filter_map(|row| row.temp_c)),
    ]
}

/// Back to the file's units; `old` is the row of the same number with its sample, if rows still correspond.
fn row(sample: &Sample, old: Option<(&Row, &Sample)>, decimals: &[usize; 4]) -> Row {
    let rounded = |value: f64, places: usize| {
        let unit = 10f64.powi(i32::try_from(places).unwrap_or(0));
        (value * unit).round() / unit
    };
    let [_, gyro, accel, temperature] = *decimals;
    // A stamp may need more places than the file had: the scatter of a stamp is below its step otherwise.
    let mut row = Row {
        t_s: rounded(sample.t_s, 6.max(decimals[0])),
        gyro_dps: sample.angular_rate_rad_s.map(|v| rounded(v.to_degrees(), gyro)).into(),
        accel_g: sample.specific_force_mps2.map(|v| rounded(v / STANDARD_GRAVITY_MPS2, accel)).into(),
        temp_c: Some(sample.temperature_degc).filter(|v| v.is_finite()).map(|v| rounded(v, temperature)),
    };
    if let Some((text, before)) = old {
        let kept = |now: f64, before: f64, text: f64, new: f64| if now == before { text } else { new };
        row.t_s = kept(sample.t_s, before.t_s, text.t_s, row.t_s);
        for i in 0..3 {
            let (now, then) = (sample.angular_rate_rad_s[i], before.angular_rate_rad_s[i]);
            row.gyro_dps[i] = kept(now, then, text.gyro_dps[i], row.gyro_dps[i]);
            let (now, then) = (sample.specific_force_mps2[i], before.specific_force_mps2[i]);
            row.accel_g[i] = kept(now, then, text.accel_g[i], row.accel_g[i]);
        }
    }
    row
}
