//! The accelerometer's output bends: an even term.
//!
//! `f_raw,i = … + k_i·f_i²`, `k` in mg/g². A shift of the same sign on both faces of an axis and none on the
//! others. The MPU-9250's
//! sheet allows 0.5 % of full scale of non-linearity.
//!
//! Magnitude: the largest `|k_i|`; the others have 30 to 100 % of it, every one with its own sign.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_quadratic",
    name: "accelerometer output has a quadratic term",
    meaning: "the largest of the three axes' coefficients",
    unit: "mg/g²",
    default: 3.0,
    values: Values::Range(0.0, 500.0),
    draws: (1.0, 6.0),
    source: "non-linearity 0.5 % of full scale (MPU-9250 sheet): 10 mg at 2 g, 2.5 mg/g²",
    injects: true,
    make: |draw| Box::new(Quadratic { coefficient: draw.spread() }),
};

#[derive(Debug, Clone)]
struct Quadratic {
    /// mg/g².
    coefficient: Vector3<f64>,
}

impl Model for Quadratic {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let power = (at.ideal.specific_force_mps2 / G).map(|f| f.powi(2));
        signal.specific_force_mps2 += self.coefficient.component_mul(&power) * MG;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("k", &self.coefficient, "mg/g²")
    }
}
