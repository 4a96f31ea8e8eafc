//! The gyroscope's bias depends on specific force: `ω_raw += G f`, all nine elements.

use nalgebra::Vector3;

use super::{AXES, Card, DPS, Effect, G, Model, Variant, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Push;

const CARD: Card = Card {
    id: "gyro_g_sensitivity",
    name: "the gyroscope's bias depends on how gravity acts on it",
    equation: "rate_raw += G * f, G 3x3",
    typical: "0.1 deg/s/g on the MPU-6050 (sheet), unspecified for the MPU-9250; Bancroft & Lachapelle 2012 found up to 0.2",
    shows: "rates at rest differ from face to face; turns and moves that start from them do not close",
    confounded: &["gyro_g_squared", "gyro_bias_step", "gyro_bias_random_walk"],
    separate_by: "rest on both faces of every axis, and come back to the first: a bias that returns with the face is g-sensitivity",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    let pairs = || (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    Model::Shift(vec![Variant {
        setting: None,
        parameters: pairs().map(|(i, j)| parameter(format!("{}_per_{}", AXES[i], AXES[j]), "dps/g", 0.1)).collect(),
        influences: pairs()
            .map(|(i, j)| reading(move |moment| Push::rate(Vector3::ith(i, DPS / G * moment.force[j]))))
            .collect(),
        own: None,
        at_size: None,
    }])
}
