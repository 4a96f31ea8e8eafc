//! The accelerometer's bias wanders: increments independent of each other, variance `q` a second on each axis.

use super::{Card, Effect, G, Model};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_bias_random_walk",
    name: "the accelerometer's bias wanders",
    equation: "d(bias) = q * dW",
    typical: "below 20 ug/sqrt(s) for a healthy MEMS accelerometer",
    shows: "gravity at rest differs by amounts that grow with the time between, with no relation to faces",
    confounded: &["accel_bias_step", "platform_tilt_change", "accel_warm_up"],
    separate_by: "leave the sensor untouched for ten minutes: what wanders then is the bias itself",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    Model::Walk { gyro: false, unit_si: 1e-6 * G, unit: "ug/sqrt(s)" }
}
