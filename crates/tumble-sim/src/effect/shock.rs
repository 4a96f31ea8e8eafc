//! One knock.
//!
//! `f += A·u·sin(π·(t − t₀)/T)` for `t₀ ≤ t ≤ t₀ + T`, a half sine of 5 to 20 ms (the form of IEC 60068-2-27), and with
//! it a full sine of rate, 15 °/s for every g, that leaves the box as it stood. A finger's tap has 0.2 to 2 g, a
//! dropped tool 5 g. It comes in the middle of a rest or of a turn.
//!
//! Magnitude: the peak `A`, g.

use super::prelude::*;
use crate::motion::Kind as Move;
use core::f64::consts::{PI, TAU};

pub(super) static KIND: Kind = Kind {
    id: "shock",
    name: "one knock",
    meaning: "the peak of its specific force",
    unit: "g",
    default: 1.0,
    values: Values::Range(0.0, 100.0),
    draws: (0.3, 5.0),
    source: "a tap 0.2 to 2 g, 5 to 20 ms (half sine as in IEC 60068-2-27)",
    injects: true,
    make: |draw| {
        let length_s = draw.rng.uniform(0.005, 0.02).max(2.0 / draw.scene.rate_hz);
        let rate_dps = draw.rng.direction() * (15.0 * draw.magnitude);
        Box::new(Shock { start_s: draw.time_s(), length_s, force_g: draw.vector(), rate_dps })
    },
};

#[derive(Debug, Clone)]
struct Shock {
    start_s: f64,
    length_s: f64,
    force_g: Vector3<f64>,
    rate_dps: Vector3<f64>,
}

impl Model for Shock {
    fn after(&mut self, world: &mut World) {
        let calm = |kind: Move| kind == Move::Rest || kind == Move::Turn;
        let later = world.motion.segments().iter().find(|s| s.end_s() > self.start_s && calm(s.kind()));
        if let Some(segment) = later.filter(|segment| segment.start_s > self.start_s - 0.2) {
            self.start_s = segment.start_s + 0.5 * segment.duration_s;
        }
    }

    fn ideal(&self, at: &Instant, ideal: &mut Ideal) {
        let share = (at.t_s - self.start_s) / self.length_s;
        if (0.0..=1.0).contains(&share) {
            ideal.specific_force_mps2 += self.force_g * (G * (PI * share).sin());
            ideal.angular_rate_rad_s += self.rate_dps * (DPS * (TAU * share).sin());
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all =
            vec![Parameter::new("start", self.start_s, "s"), Parameter::new("duration", 1e3 * self.length_s, "ms")];
        all.extend(Parameter::xyz("force_peak", &self.force_g, "g"));
        all.extend(Parameter::xyz("rate_peak", &self.rate_dps, "dps"));
        all
    }
}
