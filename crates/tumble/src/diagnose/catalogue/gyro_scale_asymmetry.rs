//! The gyroscope's scale differs between the two directions: `ω_raw,i += ½ a_i |ω_i|`.

use super::{Card, Effect, Model, gyro_axes};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "gyro_scale_asymmetry",
    name: "the gyroscope's scale differs between the two directions of turning",
    equation: "rate_raw_i += a_i/2 * |rate_i|",
    typical: "100 to 2000 ppm for consumer MEMS (IEEE Std 1554 names the term; few sheets give it)",
    shows: "a turn one way and its way back do not cancel, whatever the speed",
    confounded: &["gyro_scale_quadratic", "gyro_dead_zone"],
    separate_by: "turn both ways at two speeds: an asymmetry's share stays, a square's grows",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    let variant = gyro_axes("ppm", 1000.0, |axis, moment| 0.5e-6 * moment.smooth_rate[axis].abs());
    Model::Shift(vec![variant.at_every_sample()])
}
