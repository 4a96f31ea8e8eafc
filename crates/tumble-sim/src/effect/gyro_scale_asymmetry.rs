//! Clockwise and anticlockwise have different scales.
//!
//! `ω_raw,i = … + ½·s_i·|ω_i|`: the scale of positive rates is `s_i` above that of negative ones, and their mean is
//! unchanged. Sheets of rate gyros that state it allow 100 to 1000 ppm (IEEE Std 528 names it input-output asymmetry).
//!
//! Magnitude: the largest `|s_i|`, ppm.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_scale_asymmetry",
    name: "gyro scale differs between the two ways round",
    meaning: "the largest difference between an axis' scales for positive and negative rates",
    unit: "ppm",
    default: 1000.0,
    values: Values::Range(0.0, 100_000.0),
    draws: (700.0, 2500.0),
    source: "100 to 1000 ppm where sheets state it (scale factor asymmetry, IEEE Std 528)",
    injects: true,
    make: |draw| Box::new(Asymmetry { ppm: draw.spread() }),
};

#[derive(Debug, Clone)]
struct Asymmetry {
    ppm: Vector3<f64>,
}

impl Model for Asymmetry {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        signal.angular_rate_rad_s += self.ppm.component_mul(&at.ideal.angular_rate_rad_s.abs()) * (0.5 * PPM);
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("scale_positive_less_negative", &self.ppm, "ppm")
    }
}
