//! The gyroscope's output has a term in the square of its rate: `ω_raw,i += k_i ω_i²`.

use super::{Card, DPS, Effect, Model, gyro_axes};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_scale_quadratic",
    name: "the gyroscope's output bends with the square of its rate",
    equation: "rate_raw_i += k_i * rate_i^2",
    typical: "nonlinearity 0.1 % of full scale (sheet): 0.5 ppm of scale per deg/s at 2000 deg/s, 4 at 250",
    shows: "turns in opposite directions at unequal speed miss by amounts that grow with the speed",
    confounded: &["gyro_scale_asymmetry", "gyro_scale_cubic"],
    separate_by: "turn at two speeds, one three times the other, both ways",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    let variant = gyro_axes("ppm/dps", 5.0, |axis, moment| 1e-6 / DPS * moment.rate[axis].powi(2));
    Model::Shift(vec![variant.at_every_sample()])
}
