//! The gyro's output bends: an odd term.
//!
//! `ω_raw,i = … + k_i·ω_i³`: the scale differs by `k_i·ω_i²`, the same for both ways round, so that only different
//! speeds tell it. The MPU-9250's sheet allows 0.1 % of full scale: at ±250 °/s that is 160 ppm at 100 °/s.
//!
//! Magnitude: the largest change of scale at 100 °/s, ppm.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_scale_cubic",
    name: "gyro scale changes with the square of the rate (odd term)",
    meaning: "the largest change of an axis' scale at 100 dps",
    unit: "ppm",
    default: 2000.0,
    values: Values::Range(0.0, 100_000.0),
    draws: (1000.0, 5000.0),
    source: "non-linearity 0.1 % of full scale (MPU-9250 sheet): up to 160 ppm at 100 dps on the 250 dps range",
    injects: true,
    make: |draw| Box::new(Cubic { ppm_at_100_dps: draw.spread() }),
};

#[derive(Debug, Clone)]
struct Cubic {
    ppm_at_100_dps: Vector3<f64>,
}

impl Model for Cubic {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        const REFERENCE_RAD_S: f64 = 100.0 * DPS;
        let cubed = at.ideal.angular_rate_rad_s.map(|rate| rate * (rate / REFERENCE_RAD_S).powi(2));
        signal.angular_rate_rad_s += self.ppm_at_100_dps.component_mul(&cubed) * PPM;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("k_at_100_dps", &self.ppm_at_100_dps, "ppm")
    }
}
