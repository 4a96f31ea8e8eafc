//! The accelerometer's output has a term in the cube of its force: `f_raw,i += k_i f_i³`.

use super::{Card, Effect, G, Model, accel_axes};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_cubic",
    name: "the accelerometer's scale changes with the size of the force",
    equation: "f_raw_i += k_i * f_i^3",
    typical: "nonlinearity 0.5 % (sheet): up to 5 mg/g^3",
    shows: "oblique poses want another scale than faces; on faces alone it is a scale",
    confounded: &["accel_quadratic"],
    separate_by: "rest in ten oblique poses: with faces alone an axis sees only 0 and 1 g",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    Model::Shift(vec![accel_axes("mg/g^3", 3.0, |axis, moment| 1e-3 * G * (moment.force[axis] / G).powi(3))])
}
