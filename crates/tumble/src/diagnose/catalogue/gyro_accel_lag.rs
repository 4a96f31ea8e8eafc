//! The accelerometer reports later than the gyroscope: `f_raw(t) = f(t − τ)`, to first order `−τ ḟ`.

use super::{Card, Effect, Model, Variant, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Push;

const CARD: Card = Card {
    id: "gyro_accel_lag",
    name: "gyroscope and accelerometer report different instants",
    equation: "f_raw(t) = f(t - tau)",
    typical: "-1 to 6 ms: the MPU-9250's filters delay by 5.9 ms (rate) and 4.88 or 11.8 ms (force) at 41 Hz (sheet)",
    shows: "gravity in turns lags behind by an angle in proportion to the rate",
    confounded: &["accel_lever_arm"],
    separate_by: "tilt the table by some degrees, or turn about a horizontal axis in the hand, slowly and fast",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    Model::Shift(vec![Variant {
        setting: None,
        parameters: vec![parameter("accelerometer_after_gyroscope", "ms", 5.0)],
        influences: vec![reading(|moment| Push::force(moment.jerk * -1e-3))],
        own: None,
        at_size: None,
    }])
}
