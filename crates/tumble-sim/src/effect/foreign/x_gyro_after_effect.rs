//! A fast turn leaves a bias that dies away.
//!
//! `b_i(t) = a_i·∫|ω_i|/360°·e^(−(t−t′)/τ) dt′`: a full turn about an axis leaves `a_i`, whichever way round, and `τ`
//! of 5 to 30 s forgets it. Springs of metal and of glued packages do so (anelastic after-effect).
//!
//! Magnitude: the largest `|a_i|`, °/s.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_after_effect",
    name: "a turn leaves a bias that dies away",
    meaning: "the largest bias that a full turn leaves on an axis",
    unit: "dps",
    default: 0.05,
    values: Values::Range(0.0, 10.0),
    draws: (0.03, 0.15),
    source: "anelastic after-effect: 1e-4 to 1e-3 of the load",
    injects: true,
    make: |draw| {
        let tau_s = draw.rng.uniform(5.0, 30.0);
        Box::new(AfterEffect { tau_s, dps: draw.spread(), turned: Vector3::zeros(), last_s: None })
    },
};

#[derive(Debug, Clone)]
struct AfterEffect {
    tau_s: f64,
    dps: Vector3<f64>,
    /// What is not forgotten yet, in full turns.
    turned: Vector3<f64>,
    last_s: Option<f64>,
}

impl Model for AfterEffect {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let dt_s = self.last_s.map_or(0.0, |last_s| (at.t_s - last_s).max(0.0));
        self.last_s = Some(at.t_s);
        let turned = at.ideal.angular_rate_rad_s.abs() * (dt_s / core::f64::consts::TAU);
        self.turned = self.turned * (-dt_s / self.tau_s).exp() + turned;
        signal.angular_rate_rad_s += self.dps.component_mul(&self.turned) * DPS;
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("time_constant", self.tau_s, "s")];
        all.extend(Parameter::xyz("bias_after_a_turn", &self.dps, "dps"));
        all
    }
}
