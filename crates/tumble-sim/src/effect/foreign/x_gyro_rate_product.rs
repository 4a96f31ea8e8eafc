//! Two rates together make a third.
//!
//! `ω_raw,i = … + k_i·ω_j·ω_k` (i, j, k all different): a proof mass whose principal axes are not those of its frame
//! feels the centrifugal moment. Nothing on a plain turn about a face, much while the box is turned over.
//!
//! Magnitude: the largest `|k_i|`, °/s at 100 °/s about both other axes.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_rate_product",
    name: "two rates together make a third",
    meaning: "the largest false rate at 100 dps about both other axes",
    unit: "dps",
    default: 1.0,
    values: Values::Range(0.0, 100.0),
    draws: (0.5, 3.0),
    source: "cross-axis inertia of the proof mass: 0.1 to 1 dps",
    injects: true,
    make: |draw| Box::new(RateProduct { dps: draw.spread() }),
};

#[derive(Debug, Clone)]
struct RateProduct {
    dps: Vector3<f64>,
}

impl Model for RateProduct {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let rate = at.ideal.angular_rate_rad_s / (100.0 * DPS);
        let products = Vector3::new(rate.y * rate.z, rate.z * rate.x, rate.x * rate.y);
        signal.angular_rate_rad_s += self.dps.component_mul(&products) * DPS;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("at_100_dps", &self.dps, "dps")
    }
}
