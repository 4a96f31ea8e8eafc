//! The gyroscope's bias settles after switching on: `ω_raw,i += c_i e^(−t/τ)`.

use super::{Card, DPS, Effect, Model, Variant, gyro_axes};
use crate::diagnose::twin::Twin;

/// Time constants tried, s: a die in its package to a board on its feet.
pub(super) const TIMES_S: [f64; 6] = [8.0, 16.0, 30.0, 55.0, 100.0, 180.0];

const CARD: Card = Card {
    id: "gyro_warm_up",
    name: "the gyroscope's bias settles after it was switched on",
    equation: "rate_raw_i += c_i * exp(-t / tau)",
    typical: "0.05 to 0.5 deg/s within the first minutes, time constant 20 to 100 s; drive start-up 35 ms (sheet)",
    shows: "rates at rest approach a value, fast at first",
    confounded: &["gyro_bias_temperature", "gyro_bias_random_walk", "gyro_bias_step"],
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
    gyro_axes("dps", 0.2, move |_, moment| DPS * (-moment.t_s / tau_s).exp())
}
