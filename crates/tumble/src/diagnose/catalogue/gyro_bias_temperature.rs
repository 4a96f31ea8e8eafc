//! The gyroscope's bias follows the die's temperature: `ω_raw,i += c_i (T − T̄)`.

use super::{Card, DPS, Effect, Model, gyro_axes, with_temperature};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_bias_temperature",
    name: "the gyroscope's bias follows its temperature",
    equation: "rate_raw_i += c_i * (T - T_mean)",
    typical: "up to 0.24 deg/s/K: 30 deg/s over -40 to 85 degC (MPU-9250 sheet); commonly 0.01 to 0.05",
    shows: "rates at rest move with the temperature column",
    confounded: &["gyro_warm_up", "gyro_bias_random_walk"],
    separate_by: "warm the sensor and let it cool again: a bias that returns with the temperature is thermal",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    with_temperature(twin, || gyro_axes("dps/K", 0.05, |_, moment| DPS * moment.warmth_degc))
}
