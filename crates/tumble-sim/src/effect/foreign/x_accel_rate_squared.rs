//! Turning moves the accelerometer's zero, whatever the axis of the turn.
//!
//! `f_raw = … + a·(|ω|/100 °/s)²`, `a` fixed to the sensor: no lever arm does that, whose part points to the axis. A
//! package that bends.
//!
//! Magnitude: the length of `a`, mg.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_accel_rate_squared",
    name: "turning moves the accelerometer's zero",
    meaning: "the length of the shift at 100 dps",
    unit: "mg",
    default: 20.0,
    values: Values::Range(0.0, 1000.0),
    draws: (8.0, 40.0),
    source: "packages that bend: 0.1 to 10 mg at 100 dps",
    injects: true,
    make: |draw| Box::new(RateSquared { mg: draw.vector() }),
};

#[derive(Debug, Clone)]
struct RateSquared {
    mg: Vector3<f64>,
}

impl Model for RateSquared {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let turning = (at.ideal.angular_rate_rad_s / (100.0 * DPS)).norm_squared();
        signal.specific_force_mps2 += self.mg * (MG * turning);
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("at_100_dps", &self.mg, "mg")
    }
}
