//! The gyro's scale depends on the specific force.
//!
//! `ω_raw,i = … + k_i·f_i·ω_i`: a load on the springs changes their stiffness, so that the scale is another with the
//! axis up than with it down.
//!
//! Magnitude: the largest `|k_i|`, ppm for each g.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_force_rate_product",
    name: "gyro scale depends on specific force",
    meaning: "the largest change of an axis' scale for each g along it",
    unit: "ppm/g",
    default: 1000.0,
    values: Values::Range(0.0, 100000.0),
    draws: (300.0, 1500.0),
    source: "springs that stiffen under load: 10 to 1000 ppm/g",
    injects: true,
    make: |draw| Box::new(ForceRate { ppm_per_g: draw.spread() }),
};

#[derive(Debug, Clone)]
struct ForceRate {
    ppm_per_g: Vector3<f64>,
}

impl Model for ForceRate {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let product = at.ideal.specific_force_mps2.component_mul(&at.ideal.angular_rate_rad_s) / G;
        signal.angular_rate_rad_s += self.ppm_per_g.component_mul(&product) * PPM;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("k", &self.ppm_per_g, "ppm/g")
    }
}
