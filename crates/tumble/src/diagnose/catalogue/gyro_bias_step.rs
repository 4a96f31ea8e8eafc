//! The gyroscope's bias jumps once: `ω_raw,i += c_i [t > t₀]`.

use super::{Card, DPS, Effect, Model, Variant, gyro_axes, jump};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_bias_step",
    name: "the gyroscope's bias jumped",
    equation: "rate_raw_i += c_i * (t > t0)",
    typical: "0.02 to 0.5 deg/s after a shock or a supply step; none in undisturbed operation",
    shows: "rates at rest before and after an instant differ, within each part they agree",
    confounded: &["gyro_bias_random_walk", "gyro_g_sensitivity", "gyro_warm_up"],
    separate_by: "return to faces that were rested on before the jump",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    jump(twin, from)
}

/// Of an instant.
pub(super) fn from(from_s: f64) -> Variant {
    gyro_axes("dps", 0.1, move |_, moment| if moment.t_s > from_s { DPS } else { 0.0 })
}
