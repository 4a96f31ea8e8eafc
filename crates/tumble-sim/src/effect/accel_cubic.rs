//! The accelerometer's output bends: an odd term.
//!
//! `f_raw,i = … + k_i·f_i³`, `k` in mg/g³. On six exact faces it is a scale; only oblique attitudes and
//! accelerations tell it. The MPU-9250's
//! sheet allows 0.5 % of full scale of non-linearity.
//!
//! Magnitude: the largest `|k_i|`; the others have 30 to 100 % of it, every one with its own sign.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_cubic",
    name: "accelerometer output has a cubic term",
    meaning: "the largest of the three axes' coefficients",
    unit: "mg/g³",
    default: 6.0,
    values: Values::Range(0.0, 500.0),
    draws: (3.0, 15.0),
    source: "non-linearity 0.5 % of full scale (MPU-9250 sheet): 10 mg at 2 g, 1.3 mg/g³",
    injects: true,
    make: |draw| Box::new(Cubic { coefficient: draw.spread() }),
};

#[derive(Debug, Clone)]
struct Cubic {
    /// mg/g³.
    coefficient: Vector3<f64>,
}

impl Model for Cubic {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let power = (at.ideal.specific_force_mps2 / G).map(|f| f.powi(3));
        signal.specific_force_mps2 += self.coefficient.component_mul(&power) * MG;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("k", &self.coefficient, "mg/g³")
    }
}
