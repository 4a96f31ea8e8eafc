//! The gyroscope's bias depends on the square of specific force: `ω_raw,i += Q_ij f_j²` (vibration rectification at rest).

use nalgebra::Vector3;

use super::{AXES, Card, DPS, Effect, G, Model, Variant, gyro_axes, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Push;

const CARD: Card = Card {
    id: "gyro_g_squared",
    name: "the gyroscope's bias depends on the square of the force along an axis",
    equation: "rate_raw_i += sum_j Q_ij * f_j^2",
    typical: "0.01 to 0.1 deg/s/g^2 for consumer MEMS (IEEE Std 1554 names the term; few sheets give it)",
    shows: "rates at rest are alike on opposite faces and differ between axes",
    confounded: &["gyro_bias_step", "gyro_warm_up", "gyro_bias_random_walk"],
    separate_by: "the order X, Y, -X, Z, -Y, -Z: opposite faces far apart in time separate a square from a drift",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    // Each axis by its own force; or all nine, of which a common change of a row is a bias and cannot show where forces
    // are gravity alone.
    let own = gyro_axes("dps/g^2", 0.05, |axis, moment| DPS * (moment.force[axis] / G).powi(2));
    let pairs = || (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let squared = |i: usize, j: usize| {
        reading(move |moment| Push::rate(Vector3::ith(i, DPS * ((moment.force[j] / G).powi(2) - 1.0 / 3.0))))
    };
    let all = Variant {
        setting: None,
        parameters: pairs()
            .map(|(i, j)| parameter(format!("{}_per_{}_squared", AXES[i], AXES[j]), "dps/g^2", 0.05))
            .collect(),
        influences: pairs().map(|(i, j)| squared(i, j)).collect(),
        own: None,
        at_size: None,
    };
    Model::Shift(vec![own, all])
}
