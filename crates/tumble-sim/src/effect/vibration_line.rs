//! Something hums on the box.
//!
//! `f += A·u·sin(2πF t + φ)` and, half of the time, `ω += 0.1 (°/s)/mg·A·v·sin(2πF t + φ′)`, fixed to the box: a fan, a
//! motor, mains hum. `F` is 5 to 45 % of the sample rate, or (one time in three) above half of it, where the samples
//! show `|F − n·rate|` instead. 1 to 100 mg are usual near motors.
//!
//! Magnitude: the peak `A` of the specific force, mg.

use super::prelude::*;
use core::f64::consts::TAU;

pub(super) static KIND: Kind = Kind {
    id: "vibration_line",
    name: "a steady vibration",
    meaning: "the peak of its specific force",
    unit: "mg",
    default: 10.0,
    values: Values::Range(0.0, 2000.0),
    draws: (1.0, 10.0),
    source: "1 to 100 mg near fans and motors",
    injects: true,
    make: |draw| {
        let aliased = draw.rng.chance(1.0 / 3.0);
        let (low, high) = if aliased { (0.55, 1.45) } else { (0.05, 0.45) };
        let hz = draw.scene.rate_hz * draw.rng.uniform(low, high);
        let turns = if draw.rng.chance(0.5) { 0.1 * draw.magnitude } else { 0.0 };
        Box::new(Line {
            hz,
            force_mg: draw.vector(),
            rate_dps: draw.rng.direction() * turns,
            phases: [draw.rng.phase(), draw.rng.phase()],
        })
    },
};

#[derive(Debug, Clone)]
struct Line {
    hz: f64,
    force_mg: Vector3<f64>,
    rate_dps: Vector3<f64>,
    phases: [f64; 2],
}

impl Model for Line {
    fn ideal(&self, at: &Instant, ideal: &mut Ideal) {
        let [force, rate] = self.phases.map(|phase| (TAU * self.hz * at.t_s + phase).sin());
        ideal.specific_force_mps2 += self.force_mg * (MG * force);
        ideal.angular_rate_rad_s += self.rate_dps * (DPS * rate);
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("frequency", self.hz, "Hz")];
        all.extend(Parameter::xyz("force_peak", &self.force_mg, "mg"));
        all.extend(Parameter::xyz("rate_peak", &self.rate_dps, "dps"));
        all
    }
}
