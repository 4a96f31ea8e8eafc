//! The gyroscope's scale follows the die's temperature: `ω_raw,i += c_i (T − T̄) ω_i`.

use super::{Card, Effect, Model, gyro_axes, with_temperature};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_scale_temperature",
    name: "the gyroscope's scale follows its temperature",
    equation: "rate_raw_i += c_i * (T - T_mean) * rate_i",
    typical: "up to 0.04 %/K: 4 % over -40 to 85 degC (MPU-9250 sheet gives 4 %)",
    shows: "turns early and late in the warming want different scales",
    confounded: &["gyro_scale_cubic"],
    separate_by: "repeat the same turn at two temperatures at least 5 K apart",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    with_temperature(twin, || gyro_axes("%/K", 0.04, |axis, moment| 0.01 * moment.warmth_degc * moment.rate[axis]))
}
