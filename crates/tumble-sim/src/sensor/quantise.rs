//! Range and resolution of a 16-bit sensor.

use crate::STANDARD_GRAVITY_MPS2;
use nalgebra::Vector3;

/// Full-scale ranges. Values are rounded to the least step and clipped to what 16 bits hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantisation {
    /// ± degrees per second.
    pub gyro_range_dps: f64,
    /// ± g.
    pub accel_range_g: f64,
}

impl Quantisation {
    /// Counts per degree per second: the sheet's rounded figures (131, 65.5, 32.8, 16.4), or 32768 per range for ranges
    /// that it does not list.
    pub fn gyro_counts_per_dps(&self) -> f64 {
        const SHEET: [(f64, f64); 4] = [(250.0, 131.0), (500.0, 65.5), (1000.0, 32.8), (2000.0, 16.4)];
        let known = SHEET.iter().find(|(range, _)| *range == self.gyro_range_dps);
        known.map_or(32768.0 / self.gyro_range_dps, |(_, counts)| *counts)
    }

    /// Counts per g.
    pub fn accel_counts_per_g(&self) -> f64 {
        32768.0 / self.accel_range_g
    }

    /// Rounds and clips an angular rate, rad/s.
    pub fn gyro(&self, rate: &Vector3<f64>) -> Vector3<f64> {
        round(rate, self.gyro_counts_per_dps().to_degrees())
    }

    /// Rounds and clips a specific force, m/s².
    pub fn accel(&self, force: &Vector3<f64>) -> Vector3<f64> {
        round(force, self.accel_counts_per_g() / STANDARD_GRAVITY_MPS2)
    }
}

/// To whole counts of 16 bits and back.
fn round(value: &Vector3<f64>, counts_per_unit: f64) -> Vector3<f64> {
    value.map(|v| (v * counts_per_unit).round().clamp(-32768.0, 32767.0) / counts_per_unit)
}
