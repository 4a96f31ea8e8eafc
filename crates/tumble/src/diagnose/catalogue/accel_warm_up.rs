//! The accelerometer's bias settles after switching on: `f_raw,i += c_i e^(−t/τ)`.

use super::gyro_warm_up::TIMES_S;
use super::{Card, Effect, G, Model, Variant, accel_axes};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_warm_up",
    name: "the accelerometer's bias settles after it was switched on",
    equation: "f_raw_i += c_i * exp(-t / tau)",
    typical: "1 to 5 mg: a chip warms itself by 1 to 3 K, at 1.5 mg/degC (MPU-9250 sheet), time constant 20 to 100 s",
    shows: "gravity at rest approaches a value, fast at first, by the same on every face",
    confounded: &["accel_bias_temperature", "accel_bias_random_walk", "accel_bias_step"],
    separate_by: "leave it switched on for five minutes and record again: a warm-up is gone",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    let variant = |tau_s: f64| Variant { setting: Some(("tau", tau_s, "s")), ..of(tau_s) };
    Model::Shift(TIMES_S.into_iter().map(variant).collect())
}

/// Of a time constant.
pub(super) fn of(tau_s: f64) -> Variant {
    accel_axes("mg", 2.0, move |_, moment| 1e-3 * G * (-moment.t_s / tau_s).exp())
}
