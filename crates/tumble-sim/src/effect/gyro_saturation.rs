//! The gyro clips below the end of its stated range.
//!
//! `ω_out,i = clamp(ω_raw,i, ±L)`, a hard clip of every sample after noise. A chip set to ±250 °/s clips there; hands
//! that turn a box over reach 70 to 150 °/s, a full turn in 10 s some 45.
//!
//! Magnitude: the level `L`, °/s. A *lower* one is the larger effect.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_saturation",
    name: "gyro clips",
    meaning: "the level at which all three axes clip",
    unit: "dps",
    default: 60.0,
    values: Values::Range(1.0, 2000.0),
    draws: (30.0, 80.0),
    source: "full scale 250 to 2000 dps (MPU-9250 sheet); hands reach 70 to 150 dps",
    injects: true,
    make: |draw| Box::new(Clip { dps: draw.magnitude, clipped: 0 }),
};

#[derive(Debug, Clone)]
struct Clip {
    dps: f64,
    clipped: u32,
}

impl Model for Clip {
    fn converter(&mut self, _: &Instant, signal: &mut Signal) {
        let level = self.dps * DPS;
        self.clipped += u32::from(signal.angular_rate_rad_s.amax() > level);
        signal.angular_rate_rad_s = signal.angular_rate_rad_s.map(|rate| rate.clamp(-level, level));
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("level", self.dps, "dps"), Parameter::new("samples_clipped", f64::from(self.clipped), "")]
    }
}
