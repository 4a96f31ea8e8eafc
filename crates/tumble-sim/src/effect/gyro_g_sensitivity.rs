//! A specific force moves the gyro's zero.
//!
//! `ω_raw = D·ω + b + G·f`, `G` a full 3×3 matrix in (°/s)/g. Unequal proof masses make it so. The MPU-9250's sheet
//! does not state it; its sibling MPU-6050 has 0.1 °/s/g typical, industrial parts 0.01.
//!
//! Magnitude: the Frobenius norm of `G`, (°/s)/g; its direction among the nine is drawn.

use super::prelude::*;
use nalgebra::Matrix3;

pub(super) static KIND: Kind = Kind {
    id: "gyro_g_sensitivity",
    name: "gyro bias depends on specific force",
    meaning: "the norm of the 3x3 matrix G",
    unit: "dps/g",
    default: 0.1,
    values: Values::Range(0.0, 5.0),
    draws: (0.03, 0.1),
    source: "0.1 dps/g typical (MPU-6050 sheet); the MPU-9250's sheet is silent",
    injects: true,
    make: |draw| {
        let matrix = Matrix3::from_fn(|_, _| draw.rng.normal());
        let matrix = matrix * (draw.magnitude / matrix.norm().max(1e-9));
        Box::new(GSensitivity { dps_per_g: matrix, within_truth: false })
    },
};

#[derive(Debug, Clone)]
struct GSensitivity {
    dps_per_g: Matrix3<f64>,
    /// A simulated sensor has a place for it, so that the truth shows it as well.
    within_truth: bool,
}

impl GSensitivity {
    fn matrix_si(&self) -> Matrix3<f64> {
        self.dps_per_g * (DPS / G)
    }
}

impl Model for GSensitivity {
    fn prepare(&mut self, config: &mut WorldConfig) {
        config.sensor.truth.gyro_g_sensitivity += self.matrix_si();
        self.within_truth = true;
    }

    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        if !self.within_truth {
            signal.angular_rate_rad_s += self.matrix_si() * at.ideal.specific_force_mps2;
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let entry = |i: usize, j: usize| {
            let axes = ["x", "y", "z"];
            Parameter::new(format!("g_{}{}", axes[i], axes[j]), self.dps_per_g[(i, j)], "dps/g")
        };
        (0..9).map(|k| entry(k / 3, k % 3)).collect()
    }
}
