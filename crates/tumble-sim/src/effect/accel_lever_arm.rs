//! The sensor sits far from the spin axis.
//!
//! `f = R_b_from_n·(a + g·up) + ω̇ × r + ω × (ω × r)`: 10 cm at 42 °/s are 5.5 mg towards the axis. The nominal world
//! has (3, 2, 1) cm.
//!
//! Magnitude: the length of `r`, cm, in place of the nominal one; its direction is drawn.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_lever_arm",
    name: "sensor sits off the spin axis",
    meaning: "the distance from the box's centre, where the axis passes",
    unit: "cm",
    default: 10.0,
    values: Values::Range(0.0, 90.0),
    draws: (8.0, 25.0),
    source: "physics: omega² r; boards sit 1 to 10 cm from the middle of their box",
    injects: false,
    make: |draw| Box::new(Lever { cm: draw.vector() }),
};

#[derive(Debug, Clone)]
struct Lever {
    cm: Vector3<f64>,
}

impl Model for Lever {
    fn prepare(&mut self, config: &mut WorldConfig) {
        config.motion.shape.lever_b_m = self.cm / 100.0;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("lever", &self.cm, "cm")
    }
}
