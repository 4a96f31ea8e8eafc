//! The Earth's rotation, or a turning platform's, in the rates: `ω += Rᵀ Ω`.

use super::{AXES, Card, DPS, Effect, Model, Variant, parameter};
use crate::diagnose::diagnosis::{Found, Value};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Influence;

const CARD: Card = Card {
    id: "earth_rotation",
    name: "the ground itself turns",
    equation: "rate += R^T * W",
    typical: "15.04 deg/h for the Earth; more on a ship or a turntable",
    shows: "rates at rest depend on the attitude towards north and up, as a fixed vector does",
    confounded: &["gyro_g_sensitivity"],
    separate_by: "rest on the same face in four headings; far from motors and iron, what was a magnetic field is gone",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

/// The sidereal rate, deg/h.
const EARTH_DEGPH: f64 = 15.04;

/// The shape that this is tied with where it is faster than the Earth for certain (three sigma): on a table nothing is, and a field of the
/// room that the gyroscope sees alike with all axes would be the very same signal.
pub fn tied_with(found: &Found) -> Option<String> {
    let squares = |of: fn(&Value) -> f64| found.parameters.iter().map(|value| of(value).powi(2)).sum::<f64>();
    let turning = squares(|value| value.value).sqrt();
    let sigma = squares(|value| value.value * value.sigma).sqrt() / turning;
    let is_faster = found.id == CARD.id && turning - 3.0 * sigma > EARTH_DEGPH;
    is_faster.then(|| "a field of the room: north, east, up, alike on all axes (gyroscope)".into())
}

fn model(_: &Twin) -> Model {
    Model::Shift(vec![Variant {
        setting: None,
        parameters: AXES.iter().map(|axis| parameter(format!("n_{axis}"), "deg/h", 60.0)).collect(),
        influences: (0..3).map(|axis| Influence::Earth(axis, DPS / 3600.0)).collect(),
        own: None,
        at_size: None,
    }])
}
