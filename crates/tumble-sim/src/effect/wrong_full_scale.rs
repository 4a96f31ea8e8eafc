//! The chip is set to another range than the reader believes.
//!
//! `raw ↦ k·raw` of one whole triad, bias and noise included; then it is rounded and clipped as stated. `k` is 2 where
//! the chip has half the range. A write that was lost at start-up, or the wrong sensitivity in a driver.
//!
//! Magnitude: `k`. Which triad is drawn.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "wrong_full_scale",
    name: "range is not the one stated",
    meaning: "reading over truth for the whole triad: 2, 4, 8 or 0.5, 0.25, 0.125",
    unit: "times",
    default: 2.0,
    values: Values::Range(0.1, 10.0),
    draws: (2.0, 2.0),
    source: "ranges differ by factors of 2 (MPU-9250 sheet)",
    injects: true,
    make: |draw| {
        let triad = if draw.rng.chance(0.5) { Triad::Gyro } else { Triad::Accel };
        Box::new(FullScale { triad, times: draw.magnitude })
    },
};

#[derive(Debug, Clone)]
struct FullScale {
    triad: Triad,
    times: f64,
}

impl Model for FullScale {
    fn converter(&mut self, _: &Instant, signal: &mut Signal) {
        match self.triad {
            Triad::Gyro => signal.angular_rate_rad_s *= self.times,
            Triad::Accel => signal.specific_force_mps2 *= self.times,
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let triad = if self.triad == Triad::Gyro { 0.0 } else { 1.0 };
        vec![Parameter::new("factor", self.times, "times"), Parameter::new("triad", triad, "0 gyro, 1 accelerometer")]
    }
}
