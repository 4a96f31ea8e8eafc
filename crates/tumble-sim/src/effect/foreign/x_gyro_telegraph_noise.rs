//! One gyro axis jumps to and fro between two biases.
//!
//! `b_i(t) = b_i ± a`, each dwell exponential with a mean of 3 to 15 s: a single charge trap (random telegraph noise).
//!
//! Magnitude: half of the jump, `a`, °/s. The axis is drawn.

use crate::effect::prelude::*;
use crate::rng::{Purpose, Rng};

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_telegraph_noise",
    name: "one gyro axis jumps between two biases",
    meaning: "half of the jump",
    unit: "dps",
    default: 0.05,
    values: Values::Range(0.0, 10.0),
    draws: (0.03, 0.15),
    source: "popcorn noise of charge traps: 0.01 to 0.1 dps",
    injects: true,
    make: |draw| {
        let rng = Rng::new((draw.rng.unit() * 2f64.powi(53)) as u64, Purpose::Effect);
        let (axis, dwell_s) = (draw.axis(), draw.rng.uniform(3.0, 15.0));
        Box::new(Telegraph { axis, dps: draw.magnitude * draw.sign(), dwell_s, next_s: None, jumps: 0, rng })
    },
};

#[derive(Debug, Clone)]
struct Telegraph {
    axis: usize,
    dps: f64,
    dwell_s: f64,
    next_s: Option<f64>,
    jumps: u32,
    rng: Rng,
}

impl Telegraph {
    fn dwell(&mut self) -> f64 {
        -self.dwell_s * (1.0 - self.rng.unit()).ln()
    }
}

impl Model for Telegraph {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let mut next_s = match self.next_s {
            Some(next_s) => next_s,
            None => at.t_s + self.dwell(),
        };
        while at.t_s >= next_s {
            self.dps = -self.dps;
            self.jumps += 1;
            // Not below a millisecond, so that the loop ends.
            next_s += self.dwell().max(1e-3);
        }
        self.next_s = Some(next_s);
        signal.angular_rate_rad_s[self.axis] += self.dps * DPS;
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            Parameter::new("axis", self.axis as f64, "0 x, 1 y, 2 z"),
            Parameter::new("half_jump", self.dps.abs(), "dps"),
            Parameter::new("mean_dwell", self.dwell_s, "s"),
            Parameter::new("jumps", f64::from(self.jumps), ""),
        ]
    }
}
