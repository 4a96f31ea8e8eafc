//! Small rates read as zero: `ω_raw = sign(ω) max(|ω| − d, 0)`, so larger ones lose d.

use super::{Card, DPS, Effect, Model, gyro_axes};
use crate::diagnose::twin::Twin;

/// Width over which the sign turns, rad/s: above the noise of a sixth of a second.
const SOFT: f64 = 0.1 * DPS;

const CARD: Card = Card {
    id: "gyro_dead_zone",
    name: "the gyroscope reads nothing below a least rate",
    equation: "rate_raw = sign(rate) * max(|rate| - d, 0)",
    typical: "none in a healthy MEMS gyroscope; firmware that zeroes small rates uses 0.05 to 1 deg/s",
    shows: "turns miss by an angle that grows with their duration and has the sign of the turn; rests read exactly zero",
    confounded: &["gyro_scale_asymmetry", "gyro_coarse_quantization"],
    separate_by: "turn at two speeds: what is lost per second stays the same",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    // By the smoothed rate: a sample's own noise in the regressor would pass for an effect that takes noise away.
    let sign = |rate: f64| (rate / SOFT).tanh();
    // The zone may lie about the sensor's own zero, or, where a driver takes the bias off first, about rest.
    let about_zero =
        gyro_axes("dps", 0.2, move |axis, moment| -DPS * sign(moment.zero[axis] + moment.smooth_rate[axis]));
    let about_rest = gyro_axes("dps", 0.2, move |axis, moment| -DPS * sign(moment.smooth_rate[axis]));
    Model::Shift(vec![about_zero, about_rest])
}
