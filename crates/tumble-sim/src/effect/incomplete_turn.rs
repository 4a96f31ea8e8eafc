//! Turns stop short of 360° although they are said to end against a stop.
//!
//! A turn goes by `±(360° − δ)`, and the next begins there. All turns do if the stop is displaced, or one if it was
//! missed once: which is drawn. A book as a fence gives way by 1 to 5°.
//!
//! Magnitude: `δ`, degrees.

use super::prelude::*;
use crate::motion::Shortfall;

pub(super) static KIND: Kind = Kind {
    id: "incomplete_turn",
    name: "turns stop short of 360 degrees",
    meaning: "by how much one turn, or every one, stops short",
    unit: "deg",
    default: 3.0,
    values: Values::Range(0.0, 180.0),
    draws: (1.0, 8.0),
    source: "a displaced or missed stop: 1 to 5 degrees; a good one holds to 0.1",
    injects: false,
    make: |draw| {
        // Six turns are in every scheme that has full ones.
        let only = draw.rng.chance(0.5).then_some(draw.rng.index(6));
        Box::new(Short { deg: draw.magnitude, only })
    },
};

#[derive(Debug, Clone)]
struct Short {
    deg: f64,
    only: Option<usize>,
}

impl Model for Short {
    fn before(&mut self, world: &mut World) {
        world.motion.shortfall = Some(Shortfall { angle_rad: self.deg.to_radians(), only: self.only });
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("shortfall", self.deg, "deg")];
        // Counted from 1, as people do; 0 for every one.
        all.push(Parameter::new("only_turn_number", self.only.map_or(0.0, |turn| turn as f64 + 1.0), ""));
        all
    }
}
