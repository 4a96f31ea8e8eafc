//! The table's tilt changes for good.
//!
//! `R_n_from_p ↦ R(h, δ)·R_n_from_p` about a level axis `h`, within half a second, between two moves in the middle of
//! the recording: a leg slips, somebody leans on it, a book under the plate gives way. 0.05 to 1° are usual.
//!
//! Magnitude: `δ`, degrees.

use super::prelude::*;
use crate::motion::{Course, Lean};
use core::f64::consts::TAU;

pub(super) static KIND: Kind = Kind {
    id: "platform_tilt_change",
    name: "table tilts for good",
    meaning: "the angle by which the table tilts once",
    unit: "deg",
    default: 0.2,
    values: Values::Range(0.0, 20.0),
    draws: (0.05, 0.4),
    source: "a leg that slips or a soft support: 0.05 to 1 degree",
    injects: false,
    make: |draw| {
        let time_s = draw.time_s();
        Box::new(Tilt { deg: draw.magnitude, heading_rad: draw.rng.uniform(0.0, TAU), time_s })
    },
};

/// How long it takes, s.
const SINKS_IN_S: f64 = 0.5;

#[derive(Debug, Clone)]
struct Tilt {
    deg: f64,
    heading_rad: f64,
    time_s: f64,
}

impl Model for Tilt {
    fn after(&mut self, world: &mut World) {
        // At the end of the move that is under way, so that the change lies between two.
        let ends = world.motion.segments().iter().map(|segment| segment.end_s());
        self.time_s = ends.into_iter().find(|end_s| *end_s >= self.time_s).unwrap_or(self.time_s);
        world.motion.leans.push(Lean {
            axis_n: Vector3::new(self.heading_rad.cos(), self.heading_rad.sin(), 0.0),
            pivot_n_m: Vector3::zeros(),
            angle_rad: self.deg.to_radians(),
            course: Course::Sink { start_s: self.time_s, duration_s: SINKS_IN_S },
        });
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            Parameter::new("angle", self.deg, "deg"),
            Parameter::new("axis_from_east", self.heading_rad.to_degrees(), "deg"),
            Parameter::new("time", self.time_s, "s"),
        ]
    }
}
