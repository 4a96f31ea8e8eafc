//! The accelerometer's bias follows the die's temperature: `f_raw,i += c_i (T − T̄)`.

use super::{Card, Effect, G, Model, accel_axes, with_temperature};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_bias_temperature",
    name: "the accelerometer's bias follows its temperature",
    equation: "f_raw_i += c_i * (T - T_mean)",
    typical: "up to 1.5 mg/K (MPU-9250 sheet: 1.5 mg/degC)",
    shows: "gravity at rest moves with the temperature column, by the same on every face",
    confounded: &["accel_bias_random_walk", "accel_scale_temperature", "accel_warm_up"],
    separate_by: "rest on the same face at two temperatures at least 5 K apart",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    with_temperature(twin, || accel_axes("mg/K", 1.0, |_, moment| 1e-3 * G * moment.warmth_degc))
}
