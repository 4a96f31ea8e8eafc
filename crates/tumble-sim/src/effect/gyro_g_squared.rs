//! The gyro's zero moves with the square of the specific force.
//!
//! `ω_raw,i = … + c_i·f_i²`, `c` in (°/s)/g²: vibration rectification. Industrial MEMS gyros state 0.0001 to 0.01
//! (°/s)/g², tuning forks up to 0.1; consumer sheets are silent.
//!
//! Magnitude: the largest `|c_i|`; the other axes have 30 to 100 % of it, every one with its own sign.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_g_squared",
    name: "gyro bias depends on the square of specific force",
    meaning: "the largest of the three axes' coefficients",
    unit: "dps/g²",
    default: 0.05,
    values: Values::Range(0.0, 5.0),
    draws: (0.02, 0.1),
    source: "vibration rectification: 0.0001 to 0.01 dps/g² for industrial parts, up to 0.1 for tuning forks",
    injects: true,
    make: |draw| Box::new(GSquared { dps_per_g2: draw.spread() }),
};

#[derive(Debug, Clone)]
struct GSquared {
    dps_per_g2: Vector3<f64>,
}

impl Model for GSquared {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let squared = (at.ideal.specific_force_mps2 / G).map(|f| f * f);
        signal.angular_rate_rad_s += self.dps_per_g2.component_mul(&squared) * DPS;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("c", &self.dps_per_g2, "dps/g²")
    }
}
