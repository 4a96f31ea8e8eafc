//! The accelerometer's bias settles after switch-on.
//!
//! `b(t) = b + w·e^(−t/τ)` with `t` from the first sample and `τ` of 20 to 100 s: the die warms itself by one to three kelvin
//! where the chip's own thermometer, if it is recorded at all, sees only the end of it.
//!
//! Magnitude: the length of `w`, mg.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_warm_up",
    name: "accelerometer bias settles after switch-on",
    meaning: "the length of the part of the bias that decays",
    unit: "mg",
    default: 2.0,
    values: Values::Range(0.0, 500.0),
    draws: (1.0, 5.0),
    source: "1 to 3 K of self-heating at 1.5 mg/degC (MPU-9250 sheet)",
    injects: true,
    make: |draw| {
        let tau_s = draw.rng.uniform(20.0, 100.0);
        Box::new(WarmUp { start_s: draw.scene.start_s, tau_s, mg: draw.vector() })
    },
};

#[derive(Debug, Clone)]
struct WarmUp {
    start_s: f64,
    tau_s: f64,
    mg: Vector3<f64>,
}

impl Model for WarmUp {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        signal.specific_force_mps2 += self.mg * (MG * (-(at.t_s - self.start_s) / self.tau_s).exp());
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("time_constant", self.tau_s, "s")];
        all.extend(Parameter::xyz("decaying_bias", &self.mg, "mg"));
        all
    }
}
