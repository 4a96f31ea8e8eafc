//! The accelerometer's scale follows the die's temperature: `f_raw,i += c_i (T − T̄) f_i`.

use super::{Card, Effect, Model, accel_axes, with_temperature};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_scale_temperature",
    name: "the accelerometer's scale follows its temperature",
    equation: "f_raw_i += c_i * (T - T_mean) * f_i",
    typical: "0.026 %/K (MPU-9250 sheet)",
    shows: "gravity's size moves with the temperature column, on faces where the axis is upright",
    confounded: &["accel_bias_temperature"],
    separate_by: "rest on both faces of an axis at two temperatures at least 5 K apart",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    with_temperature(twin, || accel_axes("%/K", 0.03, |axis, moment| 0.01 * moment.warmth_degc * moment.force[axis]))
}
