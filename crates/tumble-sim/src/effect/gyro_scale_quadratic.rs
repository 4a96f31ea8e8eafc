//! The gyro's output bends: an even term.
//!
//! `ω_raw,i = … + k_i·ω_i²`: the scale differs by `k_i·ω_i`, which has opposite signs for the two ways round. The
//! MPU-9250's sheet allows 0.1 % of full scale of non-linearity: at ±2000 °/s, 2 °/s or 0.5 ppm/(°/s) if all of it is
//! even; 4 ppm at ±250.
//!
//! Magnitude: the largest `|k_i|` in ppm of the rate for every °/s.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_scale_quadratic",
    name: "gyro scale changes with the rate (even term)",
    meaning: "the largest change of an axis' scale for each degree per second",
    unit: "ppm/dps",
    default: 15.0,
    values: Values::Range(0.0, 500.0),
    draws: (6.0, 30.0),
    source: "non-linearity 0.1 % of full scale (MPU-9250 sheet): 0.5 to 4 ppm/dps",
    injects: true,
    make: |draw| Box::new(Quadratic { ppm_per_dps: draw.spread() }),
};

#[derive(Debug, Clone)]
struct Quadratic {
    ppm_per_dps: Vector3<f64>,
}

impl Model for Quadratic {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let squared = at.ideal.angular_rate_rad_s.map(|rate| rate * rate);
        signal.angular_rate_rad_s += self.ppm_per_dps.component_mul(&squared) * (PPM / DPS);
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("k", &self.ppm_per_dps, "ppm/dps")
    }
}
