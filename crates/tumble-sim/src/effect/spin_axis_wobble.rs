//! The spin axis of a turn wobbles.
//!
//! The box leans by `w` about two axes in the plate, once and (a third of it) twice a turn, faded in and out at the
//! turn's ends. A box turned by hand on a table does so by 0.1 to 2°: a crumb under it, a hand that pulls upwards.
//!
//! Magnitude: the amplitude `w`, degrees.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "spin_axis_wobble",
    name: "spin axis wobbles",
    meaning: "the amplitude of the lean during a turn",
    unit: "deg",
    default: 3.0,
    values: Values::Range(0.0, 19.0),
    draws: (2.0, 6.0),
    source: "0.1 to 2 degrees of a box turned by hand",
    injects: false,
    make: |draw| Box::new(Wobble { deg: draw.magnitude }),
};

#[derive(Debug, Clone)]
struct Wobble {
    deg: f64,
}

impl Model for Wobble {
    fn prepare(&mut self, config: &mut WorldConfig) {
        config.motion.hands.wobble_deg = self.deg;
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("amplitude", self.deg, "deg")]
    }
}
