//! Slow turns are not seen.
//!
//! The standard soft dead zone, without a jump: `ω ↦ 0` for `|ω_i| < d`, else `ω_i − d·sign ω_i`. It acts on the true
//! rate, before the bias and the noise are added: an element that sticks. Full turns then lose `d·T`: 1° at 0.1 °/s in
//! 10 s. IEEE Std 528 has the term; ring lasers lock in at 0.03 to 0.3 °/s, drivers that "zero" small rates use 0.05 to
//! 1.
//!
//! Magnitude: the half width `d` of all three axes, °/s.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_dead_zone",
    name: "gyro does not see slow turns",
    meaning: "the rate below which every axis says nothing (soft dead zone)",
    unit: "dps",
    default: 0.1,
    values: Values::Range(0.0, 20.0),
    draws: (0.05, 0.2),
    source: "0.05 to 1 dps in drivers that zero small rates; dead band of IEEE Std 528",
    injects: true,
    make: |draw| Box::new(DeadZone { dps: draw.magnitude }),
};

#[derive(Debug, Clone)]
struct DeadZone {
    dps: f64,
}

impl Model for DeadZone {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let half_width = self.dps * DPS;
        signal.angular_rate_rad_s -= at.ideal.angular_rate_rad_s.map(|rate| rate.clamp(-half_width, half_width));
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("half_width", self.dps, "dps")]
    }
}
