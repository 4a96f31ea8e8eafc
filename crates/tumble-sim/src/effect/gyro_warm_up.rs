//! The gyro's bias settles after switch-on.
//!
//! `b(t) = b + w·e^(−t/τ)` with `t` from the first sample and `τ` of 20 to 100 s. It goes with time and not with the
//! temperature that the chip reports: the drive loop and the package's stress settle. 0.05 to 0.5 °/s in the first
//! minutes are usual.
//!
//! Magnitude: the length of `w`, °/s.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_warm_up",
    name: "gyro bias settles after switch-on",
    meaning: "the length of the part of the bias that decays",
    unit: "dps",
    default: 0.1,
    values: Values::Range(0.0, 50.0),
    draws: (0.04, 0.2),
    source: "0.05 to 0.5 dps in the first minutes of consumer parts",
    injects: true,
    make: |draw| {
        let tau_s = draw.rng.uniform(20.0, 100.0);
        Box::new(WarmUp { start_s: draw.scene.start_s, tau_s, dps: draw.vector() })
    },
};

#[derive(Debug, Clone)]
struct WarmUp {
    start_s: f64,
    tau_s: f64,
    dps: Vector3<f64>,
}

impl Model for WarmUp {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        signal.angular_rate_rad_s += self.dps * (DPS * (-(at.t_s - self.start_s) / self.tau_s).exp());
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("time_constant", self.tau_s, "s")];
        all.extend(Parameter::xyz("decaying_bias", &self.dps, "dps"));
        all
    }
}
