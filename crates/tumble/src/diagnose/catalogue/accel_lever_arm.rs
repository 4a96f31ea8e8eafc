//! The accelerometer sits off the turns' axis: `f += ω × (ω × l) + ω̇ × l`.
//!
//! The estimator carries a lever arm, so calibration does not suffer. A sensor in the middle of its box is within
//! [`LEVER_SIGMA_M`](crate::diagnose::twin::noise::LEVER_SIGMA_M) of the axis; what is beyond is said.

use super::{AXES, Card, Effect, Model, Variant, parameter};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::influence::Influence;

const CARD: Card = Card {
    id: "accel_lever_arm",
    name: "the accelerometer sits off the axis of the turns",
    equation: "f += rate x (rate x l) + d(rate)/dt x l",
    typical: "0 in the middle of a box, 1 to 10 cm for a board mounted at its edge",
    shows: "a steady outward force in turns, with the square of the rate",
    confounded: &["accel_internal_lever_arms"],
    separate_by: "turn at two speeds: the force grows with the square of the rate",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    if !twin.stretches.iter().any(|stretch| matches!(stretch.deed, Deed::Turn { .. })) {
        return Model::Absent("no turns about a fixed axis: turn the box on the table");
    }
    Model::Shift(vec![Variant {
        setting: None,
        parameters: AXES.iter().map(|axis| parameter(*axis, "cm", 3.0)).collect(),
        influences: (0..3).map(|axis| Influence::Lever(axis, 0.01)).collect(),
        own: None,
        at_size: None,
    }])
}
