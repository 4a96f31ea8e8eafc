//! The gyro feels angular acceleration about its other axes.
//!
//! `ω_raw = … + C·ω̇`, `C` with a zero diagonal (which would be a delay): (°/s)/(°/s²), that is seconds. A proof mass
//! that is not balanced.
//!
//! Magnitude: the Frobenius norm of `C`, ms.

use crate::effect::prelude::*;
use nalgebra::Matrix3;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_angular_acceleration",
    name: "gyro feels angular acceleration about other axes",
    meaning: "the norm of the matrix from angular acceleration to rate",
    unit: "ms",
    default: 5.0,
    values: Values::Range(0.0, 500.0),
    draws: (2.0, 10.0),
    source: "proof masses out of balance: up to some ms",
    injects: false,
    make: |draw| {
        let matrix = Matrix3::from_fn(|i, j| if i == j { 0.0 } else { draw.rng.normal() });
        Box::new(AngularAcceleration { ms: matrix * (draw.magnitude / matrix.norm().max(1e-9)) })
    },
};

#[derive(Debug, Clone)]
struct AngularAcceleration {
    ms: Matrix3<f64>,
}

impl Model for AngularAcceleration {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        signal.angular_rate_rad_s += self.ms * at.angular_acceleration_rad_s2 * 1e-3;
    }

    fn parameters(&self) -> Vec<Parameter> {
        let axes = ["x", "y", "z"];
        let off_diagonal = (0..9).filter(|k| k / 3 != k % 3);
        let entry =
            |k: usize| Parameter::new(format!("c_{}{}", axes[k / 3], axes[k % 3]), self.ms[(k / 3, k % 3)], "ms");
        off_diagonal.map(entry).collect()
    }
}
