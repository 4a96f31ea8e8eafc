//! The gyro feels the Earth's magnetic field.
//!
//! `ω_raw = … + M·R_b_from_n·m̂`, `m̂` the field's direction: to the north and 65° below level, as in central Europe. A
//! vibrating element with a current in it.
//!
//! Magnitude: the Frobenius norm of `M`, °/s.

use crate::effect::prelude::*;
use nalgebra::Matrix3;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_magnetic",
    name: "gyro feels the magnetic field",
    meaning: "the norm of the matrix from the field's direction to the bias",
    unit: "dps",
    default: 0.1,
    values: Values::Range(0.0, 10.0),
    draws: (0.05, 0.2),
    source: "0.01 to 0.1 dps in the Earth's field where it is stated",
    injects: false,
    make: |draw| {
        let matrix = Matrix3::from_fn(|_, _| draw.rng.normal());
        Box::new(Magnetic { dps: matrix * (draw.magnitude / matrix.norm().max(1e-9)) })
    },
};

/// Below level, degrees.
const DIP_DEG: f64 = 65.0;

#[derive(Debug, Clone)]
struct Magnetic {
    dps: Matrix3<f64>,
}

impl Model for Magnetic {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let (down, north) = DIP_DEG.to_radians().sin_cos();
        let field_b = at.rotation_n_from_b.inverse_transform_vector(&Vector3::new(0.0, north, -down));
        signal.angular_rate_rad_s += self.dps * field_b * DPS;
    }

    fn parameters(&self) -> Vec<Parameter> {
        let axes = ["x", "y", "z"];
        let entry =
            |k: usize| Parameter::new(format!("m_{}{}", axes[k / 3], axes[k % 3]), self.dps[(k / 3, k % 3)], "dps");
        (0..9).map(entry).collect()
    }
}
