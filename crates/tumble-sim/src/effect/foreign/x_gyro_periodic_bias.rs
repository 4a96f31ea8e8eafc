//! The gyro's bias swings slowly.
//!
//! `b(t) = b + a·sin(2πFt + φ)`, `F` of 0.03 to 0.2 Hz: a heater that switches, a supply that breathes with a radio.
//!
//! Magnitude: the length of `a`, °/s.

use crate::effect::prelude::*;
use core::f64::consts::TAU;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_periodic_bias",
    name: "gyro bias swings slowly",
    meaning: "the length of the swinging part",
    unit: "dps",
    default: 0.05,
    values: Values::Range(0.0, 10.0),
    draws: (0.02, 0.1),
    source: "heaters and supplies: 0.01 to 0.1 dps",
    injects: true,
    make: |draw| {
        let (hz, phase_rad) = (draw.rng.uniform(0.03, 0.2), draw.rng.phase());
        Box::new(Swinging { hz, phase_rad, dps: draw.vector() })
    },
};

#[derive(Debug, Clone)]
struct Swinging {
    hz: f64,
    phase_rad: f64,
    dps: Vector3<f64>,
}

impl Model for Swinging {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        signal.angular_rate_rad_s += self.dps * (DPS * (TAU * self.hz * at.t_s + self.phase_rad).sin());
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![
            Parameter::new("frequency", self.hz, "Hz"),
            Parameter::new("phase", self.phase_rad.to_degrees(), "deg"),
        ];
        all.extend(Parameter::xyz("amplitude", &self.dps, "dps"));
        all
    }
}
