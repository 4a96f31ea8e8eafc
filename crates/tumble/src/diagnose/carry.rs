//! What follows from a diagnosis: an effect that a calibration can carry is fitted, taken out of the readings, and the rest is
//! calibrated as ever.
//!
//! `ideal = correction · (raw − bias − effect)`: the effect's numbers stand beside the calibration's, in raw units.

use serde::{Deserialize, Serialize};
use tumble_core::estimate::Conditions;

use super::diagnosis::Value;
use super::numbers;
use super::posterior;
use super::prepare::prepare;
use super::search::bench::{Accepted, Bench};
use super::search::ledger::Ledger;
use crate::recording::{Inference, Reading, Recording};

/// Effects that depend on nothing but what a reading comes with: force, temperature, rate.
pub const CARRIED: [&str; 7] = [
    "gyro_g_sensitivity",
    "gyro_bias_temperature",
    "gyro_scale_temperature",
    "accel_bias_temperature",
    "accel_scale_temperature",
    "gyro_accel_lag",
    "accel_lever_arm",
];

/// An effect with its numbers, as the calibration's JSON has it under `with`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Carried {
    /// As in the contract.
    pub id: String,
    /// As a formula.
    pub equation: String,
    /// Of the formula.
    pub parameters: Vec<Value>,
    /// Mean temperature that slopes are about, °C; null where the recording has none.
    pub about_degc: Option<f64>,
}

/// Fits the effects and takes them out of the readings.
///
/// # Errors
/// An effect that cannot be carried, or cannot show in this recording: in words.
pub fn carry(
    recording: &Recording,
    conditions: Conditions,
    ids: &[String],
) -> Result<(Vec<Reading>, Vec<Carried>), String> {
    if let Some(id) = ids.iter().find(|id| !CARRIED.contains(&id.as_str())) {
        return Err(format!("--with {id}: a calibration can carry {}", CARRIED.join(", ")));
    }
    let prepared = prepare(recording, conditions).map_err(|why| format!("--with: {}", why.0))?;
    let mut bench = Bench::new(prepared.twin, &[]);
    let noise = bench.twin.noise;
    let rows = bench.rows(noise);
    let ledger = Ledger::new(&rows, |_| true);
    for id in ids {
        let accepted = accept(&bench, &ledger, id)?;
        bench.accepted.push(accepted);
    }
    bench.refit();
    let rows = bench.rows(noise);
    let ledger = Ledger::new(&rows, |_| true);
    let temperature = super::twin::trajectory::mean_temperature(&bench.original);
    let settled = posterior::noise(&mut bench);
    let mut carried = Vec::new();
    for (k, id) in ids.iter().enumerate() {
        let (values, _) = numbers::shift_values(&mut bench, &rows, &ledger, settled, k);
        carried.push(Carried {
            id: id.clone(),
            equation: bench.candidate(&bench.accepted[k]).effect.card.equation.into(),
            parameters: values,
            about_degc: temperature.is_finite().then_some(temperature),
        });
    }
    let mut readings = recording.samples(&Inference::of(recording));
    for (reading, raw) in readings.iter_mut().zip(&bench.twin.samples) {
        reading.sample.angular_rate_rad_s = raw.rate.cast();
        reading.sample.specific_force_mps2 = raw.force.cast();
    }
    Ok((readings, carried))
}

fn accept(bench: &Bench, ledger: &Ledger, id: &str) -> Result<Accepted, String> {
    let candidate = bench
        .candidates
        .iter()
        .position(|candidate| candidate.effect.card.id == id)
        .ok_or_else(|| format!("--with {id}: no such effect"))?;
    if let Some(why) = bench.candidates[candidate].absent {
        return Err(format!("--with {id}: it cannot show in this recording: {why}"));
    }
    let (_, variant, widening) = bench.weigh(ledger, &[], candidate);
    let parameters = bench.candidates[candidate].variants.get(variant).map_or(0, |v| v.parameters.len());
    Ok(Accepted { candidate, variant, widening, taken: vec![0.0; parameters] })
}

/// g-sensitivity as the calibration's own field has it: rad/s per m/s², row the gyroscope's axis.
pub fn g_sensitivity(carried: &[Carried]) -> Option<[[f32; 3]; 3]> {
    let effect = carried.iter().find(|carried| carried.id == "gyro_g_sensitivity")?;
    let unit = super::catalogue::DPS / super::catalogue::G;
    let element =
        |i: usize, j: usize| effect.parameters.get(3 * i + j).map_or(0.0, |value| (value.value * unit) as f32);
    Some(std::array::from_fn(|i| std::array::from_fn(|j| element(i, j))))
}
