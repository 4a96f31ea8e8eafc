//! The accelerometer's bias jumps once: `f_raw,i += c_i [t > t₀]`.

use super::{Card, Effect, G, Model, Variant, accel_axes, jump};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_bias_step",
    name: "the accelerometer's bias jumped",
    equation: "f_raw_i += c_i * (t > t0)",
    typical: "1 to 20 mg after a shock or bending of the board; none in undisturbed operation",
    shows: "gravity at rest before and after an instant differs on every face alike",
    confounded: &["accel_bias_random_walk", "platform_tilt_change", "accel_warm_up"],
    separate_by: "return to faces that were rested on before the jump",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    jump(twin, from)
}

/// Of an instant.
pub(super) fn from(from_s: f64) -> Variant {
    accel_axes("mg", 5.0, move |_, moment| if moment.t_s > from_s { 1e-3 * G } else { 0.0 })
}
