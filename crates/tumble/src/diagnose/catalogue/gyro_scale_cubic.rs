//! The gyroscope's scale depends on the square of its rate: `ω_raw,i += k_i ω_i³`.

use super::{Card, DPS, Effect, Model, gyro_axes};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_scale_cubic",
    name: "the gyroscope's scale changes with the size of its rate",
    equation: "rate_raw_i += k_i * rate_i^3",
    typical: "nonlinearity 0.1 % of full scale (sheet): 2.5e-4 ppm/dps^2 at 2000 deg/s, 0.016 at 250",
    shows: "fast and slow turns want different scales, in both directions alike",
    confounded: &["gyro_scale_quadratic", "gyro_saturation", "undersampling"],
    separate_by: "turn at two speeds, one three times the other, both ways",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    let variant = gyro_axes("ppm/dps^2", 0.03, |axis, moment| 1e-6 / (DPS * DPS) * moment.rate[axis].powi(3));
    Model::Shift(vec![variant.at_every_sample()])
}
