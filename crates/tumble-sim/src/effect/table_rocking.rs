//! The table rocks all the time.
//!
//! `R_n_from_p ↦ R(h, A·sin(2πft + φ))·R_n_from_p` about a level axis `h` 0.7 m below the plate, `f` of 0.3 to 2 Hz:
//! gravity's direction, the rate and the horizontal acceleration of the plate all follow. A boat, a floor that people
//! walk on, a table on a carpet: 0.001 to 0.1°.
//!
//! Magnitude: the amplitude `A`, degrees.

use super::prelude::*;
use crate::motion::{Course, Lean};
use core::f64::consts::TAU;

pub(super) static KIND: Kind = Kind {
    id: "table_rocking",
    name: "table rocks",
    meaning: "the amplitude of the rocking",
    unit: "deg",
    default: 0.05,
    values: Values::Range(0.0, 10.0),
    draws: (0.01, 0.08),
    source: "0.001 to 0.1 degrees at 0.3 to 2 Hz of tables on soft floors",
    injects: false,
    make: |draw| {
        let (heading_rad, phase_rad) = (draw.rng.phase(), draw.rng.phase());
        Box::new(Rocking { deg: draw.magnitude, hz: draw.rng.uniform(0.3, 2.0), heading_rad, phase_rad })
    },
};

/// The floor below the plate, m.
const FLOOR_M: f64 = 0.7;

#[derive(Debug, Clone)]
struct Rocking {
    deg: f64,
    hz: f64,
    heading_rad: f64,
    phase_rad: f64,
}

impl Model for Rocking {
    fn before(&mut self, world: &mut World) {
        world.motion.leans.push(Lean {
            axis_n: Vector3::new(self.heading_rad.cos(), self.heading_rad.sin(), 0.0),
            pivot_n_m: Vector3::z() * -FLOOR_M,
            angle_rad: self.deg.to_radians(),
            course: Course::Rock { frequency_hz: self.hz, phase_rad: self.phase_rad },
        });
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            Parameter::new("amplitude", self.deg, "deg"),
            Parameter::new("frequency", self.hz, "Hz"),
            Parameter::new("axis_from_east", self.heading_rad.to_degrees() % TAU.to_degrees(), "deg"),
            Parameter::new("phase", self.phase_rad.to_degrees(), "deg"),
        ]
    }
}
