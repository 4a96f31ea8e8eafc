//! The gyroscope's bias wanders: increments independent of each other, variance `q` a second on each axis.

use super::{Card, DPS, Effect, Model};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_bias_random_walk",
    name: "the gyroscope's bias wanders",
    equation: "d(bias) = q * dW",
    typical: "below 1 mdps/sqrt(s) for a healthy MEMS gyroscope; what is more is drift that no calibration can take out",
    shows: "rates at rest differ by amounts that grow with the time between them, with no relation to faces",
    confounded: &["gyro_bias_step", "gyro_warm_up", "gyro_g_sensitivity"],
    separate_by: "leave the sensor untouched for ten minutes: what wanders then is the bias itself",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    Model::Walk { gyro: true, unit_si: 1e-3 * DPS, unit: "mdps/sqrt(s)" }
}
