//! The Earth's rotation, or a turning platform's, in the rates: `ω += Rᵀ Ω`.

use super::{AXES, Card, DPS, Effect, Model, Variant, parameter};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Influence;

const CARD: Card = Card {
    id: "earth_rotation",
    name: "the ground itself turns",
    equation: "rate += R^T * W",
    typical: "15.04 deg/h for the Earth; more on a ship or a turntable",
    shows: "rates at rest depend on the attitude towards north and up, as a fixed vector does",
    confounded: &["gyro_g_sensitivity"],
    separate_by: "rest on the same face in four headings",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    Model::Shift(vec![Variant {
        setting: None,
        parameters: AXES.iter().map(|axis| parameter(format!("n_{axis}"), "deg/h", 60.0)).collect(),
        influences: (0..3).map(|axis| Influence::Earth(axis, DPS / 3600.0)).collect(),
        own: None,
        at_size: None,
    }])
}
