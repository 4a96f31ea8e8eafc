//! The accelerometer creeps towards its reading after a new face.
//!
//! `f_raw,i = … − c_i·(f_i − s_i)`, `τ·ṡ = f − s`, `τ` of 3 to 15 s: a share of every change comes late. Glue under the
//! die.
//!
//! Magnitude: the largest `|c_i|`, mg for each g of change.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_accel_creep",
    name: "accelerometer creeps after a new face",
    meaning: "the largest share of a change that comes late",
    unit: "mg/g",
    default: 5.0,
    values: Values::Range(0.0, 500.0),
    draws: (2.0, 10.0),
    source: "creep of die attach: 0.05 to 0.5 %",
    injects: true,
    make: |draw| {
        let tau_s = draw.rng.uniform(3.0, 15.0);
        Box::new(Creep { tau_s, mg_per_g: draw.spread(), settled: None })
    },
};

#[derive(Debug, Clone)]
struct Creep {
    tau_s: f64,
    mg_per_g: Vector3<f64>,
    /// When, and what it has settled to, m/s².
    settled: Option<(f64, Vector3<f64>)>,
}

impl Model for Creep {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let force = at.ideal.specific_force_mps2;
        let (last_s, before) = self.settled.unwrap_or((at.t_s, force));
        let keep = (-(at.t_s - last_s).max(0.0) / self.tau_s).exp();
        let settled = force + (before - force) * keep;
        self.settled = Some((at.t_s, settled));
        signal.specific_force_mps2 -= self.mg_per_g.component_mul(&(force - settled)) * 1e-3;
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("time_constant", self.tau_s, "s")];
        all.extend(Parameter::xyz("late_share", &self.mg_per_g, "mg/g"));
        all
    }
}
