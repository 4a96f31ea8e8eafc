//! The gyroscope's scale differs between the two directions: `ω_raw,i += ½ a_i |ω_i|`.

use super::{Card, Effect, Model, gyro_axes};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::trajectory::Moment;

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

/// Sigmas by which a sample stands out of its own noise.
const STANDS_OUT: f64 = 6.0;

/// By samples: a rate that trembles about zero is rectified. Means over a sixth of a second, and none where they did not stand
/// out of a hand's tremor, left out a tenth of every move, and asymmetries came out too large by 5 %. `|ω|` is even, so that
/// noise, which is in the residual as well, does not pass for it.
fn model(twin: &Twin) -> Model {
    let noise = twin.trajectory.rate_variance.map(|variance| STANDS_OUT * variance.sqrt());
    let size = move |axis: usize, moment: &Moment| {
        let rate = moment.rate[axis].abs();
        if rate > noise[axis] { rate } else { moment.smooth_rate[axis].abs() }
    };
    Model::Shift(vec![gyro_axes("ppm", 1000.0, move |axis, moment| 0.5e-6 * size(axis, moment)).at_every_sample()])
}
