//! The accelerometer clips below the end of its stated range.
//!
//! `f_out,i = clamp(f_raw,i, ±L)`, a hard clip of every sample after noise. A ±2 g chip clips when the box is put down
//! hard; with an offset and a scale error a level near 1 g cuts into the stills themselves.
//!
//! Magnitude: the level `L`, g. A *lower* one is the larger effect.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_saturation",
    name: "accelerometer clips",
    meaning: "the level at which all three axes clip",
    unit: "g",
    default: 1.0,
    values: Values::Range(0.1, 16.0),
    draws: (0.85, 0.98),
    source: "full scale 2 to 16 g (MPU-9250 sheet); rest is 1 g, a put-down 1.1 to 3 g",
    injects: true,
    make: |draw| Box::new(Clip { g: draw.magnitude, clipped: 0 }),
};

#[derive(Debug, Clone)]
struct Clip {
    g: f64,
    clipped: u32,
}

impl Model for Clip {
    fn converter(&mut self, _: &Instant, signal: &mut Signal) {
        let level = self.g * G;
        self.clipped += u32::from(signal.specific_force_mps2.amax() > level);
        signal.specific_force_mps2 = signal.specific_force_mps2.map(|force| force.clamp(-level, level));
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("level", self.g, "g"), Parameter::new("samples_clipped", f64::from(self.clipped), "")]
    }
}
