//! The gyro's least step is larger than its noise.
//!
//! `ω_out,i = q·round(ω_raw,i/q)`. The chip's own step at ±2000 °/s is 0.061 °/s, as large as its noise; a driver that
//! keeps 8 or 12 bits, or a log with one decimal, has 0.1 to 16 °/s.
//!
//! Magnitude: the step `q`, °/s.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_coarse_quantization",
    name: "gyro readings come in coarse steps",
    meaning: "the step of all three axes",
    unit: "dps",
    default: 0.5,
    values: Values::Range(0.001, 50.0),
    draws: (0.4, 2.0),
    source: "0.061 dps at 2000 dps full scale (MPU-9250 sheet); 12 bits of it have 0.98 dps",
    injects: true,
    make: |draw| Box::new(Steps { dps: draw.magnitude }),
};

#[derive(Debug, Clone)]
struct Steps {
    dps: f64,
}

impl Model for Steps {
    fn converter(&mut self, _: &Instant, signal: &mut Signal) {
        let step = self.dps * DPS;
        signal.angular_rate_rad_s = signal.angular_rate_rad_s.map(|rate| (rate / step).round() * step);
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("step", self.dps, "dps")]
    }
}
