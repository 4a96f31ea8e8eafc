//! The accelerometer's output has a term in the square of its force: `f_raw,i += k_i f_i²`.

use super::{Card, Effect, G, Model, accel_axes};
use crate::diagnose::twin::Twin;

const CARD: Card = Card {
    id: "accel_quadratic",
    name: "the accelerometer's output bends with the square of the force",
    equation: "f_raw_i += k_i * f_i^2",
    typical: "nonlinearity 0.5 % (sheet): 0.3 mg/g^2 at 16 g full scale, up to 5 mg/g^2 where it stands for 1 g",
    shows: "an axis has one bias where it is upright, another where it lies",
    confounded: &["accel_bias_step"],
    separate_by: "rest in oblique poses as well as on faces",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    Model::Shift(vec![accel_axes("mg/g^2", 3.0, |axis, moment| 1e-3 * G * (moment.force[axis] / G).powi(2))])
}
