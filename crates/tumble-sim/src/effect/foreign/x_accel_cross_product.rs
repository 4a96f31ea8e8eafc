//! Two forces together move the third axis.
//!
//! `f_raw,i = … + k_i·f_j·f_k` (i, j, k all different): a cross-coupling of the springs. Nothing on six exact faces,
//! much in oblique attitudes.
//!
//! Magnitude: the largest `|k_i|`, mg/g².

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_accel_cross_product",
    name: "two forces together move the third axis",
    meaning: "the largest of the three coefficients",
    unit: "mg/g²",
    default: 20.0,
    values: Values::Range(0.0, 1000.0),
    draws: (10.0, 50.0),
    source: "cross-coupling of the springs: 0.1 to 5 mg/g²",
    injects: true,
    make: |draw| Box::new(CrossProduct { mg_per_g2: draw.spread() }),
};

#[derive(Debug, Clone)]
struct CrossProduct {
    mg_per_g2: Vector3<f64>,
}

impl Model for CrossProduct {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let f = at.ideal.specific_force_mps2 / G;
        let products = Vector3::new(f.y * f.z, f.z * f.x, f.x * f.y);
        signal.specific_force_mps2 += self.mg_per_g2.component_mul(&products) * MG;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("k", &self.mg_per_g2, "mg/g²")
    }
}
