//! The Earth turns.
//!
//! `ω = ω_nb + m·R_b_from_n·ω_ie`, and twice `m·ω_ie` × velocity in the specific force; `ω_ie` is 15.04 °/h (WGS 84),
//! 4.18 mdps. The nominal world has it (`m = 1`), as every real recording does: 0 leaves it out, more than 1 makes it
//! large enough to be found in one recording.
//!
//! Magnitude: the factor `m`.

use super::prelude::*;
use crate::EARTH_RATE_RAD_S;

pub(super) static KIND: Kind = Kind {
    id: "earth_rotation",
    name: "the Earth's rotation",
    meaning: "how many times the Earth's rate; 1 is the nominal world, 0 leaves it out",
    unit: "times",
    default: 1.0,
    values: Values::Range(0.0, 1000.0),
    draws: (5.0, 20.0),
    source: "WGS 84: 15.04 deg/h",
    injects: false,
    make: |draw| Box::new(Earth { times: draw.magnitude }),
};

#[derive(Debug, Clone)]
struct Earth {
    times: f64,
}

impl Model for Earth {
    fn before(&mut self, world: &mut World) {
        world.earth_rate_share = self.times;
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("rate", self.times * EARTH_RATE_RAD_S / DPS, "dps")]
    }
}
