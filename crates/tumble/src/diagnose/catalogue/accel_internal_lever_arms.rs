//! The accelerometer's three axes sense at different points of the chip: `f_i += (ω × (ω × l_i) + ω̇ × l_i)_i`.
//!
//! What the three places have in common is a lever arm, which every recording has and which the filter carries with a prior of
//! its own: of the nine numbers six are this effect's. Reported is each place less the mean of the three, `l_i − l̄`.

use nalgebra::{DMatrix, Vector3};

use super::{AXES, Card, Effect, Model, Variant, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Push;

const CARD: Card = Card {
    id: "accel_internal_lever_arms",
    name: "the accelerometer's axes sense at different points",
    equation: "f_i += (rate x (rate x l_i) + d(rate)/dt x l_i)_i",
    typical: "0.1 to 3 mm within a package, centimetres between single-axis parts (IEEE Std 1554: size effect)",
    shows: "forces in turns that no common lever arm explains",
    confounded: &["accel_lever_arm"],
    separate_by: "turn fast about all three axes: a common lever arm has three numbers, this has nine",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(_: &Twin) -> Model {
    let pairs = || (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let push = |i: usize, j: usize| {
        reading(move |moment| {
            let arm = Vector3::ith(j, 1e-3);
            let force = moment.rate.cross(&moment.rate.cross(&arm)) + moment.acceleration.cross(&arm);
            Push::force(Vector3::ith(i, force[i]))
        })
    };
    Model::Shift(vec![Variant {
        setting: None,
        parameters: pairs().map(|(i, j)| parameter(format!("{}_at_{}", AXES[i], AXES[j]), "mm", 3.0)).collect(),
        influences: pairs().map(|(i, j)| push(i, j)).collect(),
        own: Some(less_the_mean()),
        at_size: None,
    }])
}

/// `l_i − l̄`, for numbers in the order xx, xy, xz, yx, …
fn less_the_mean() -> DMatrix<f64> {
    DMatrix::from_fn(9, 9, |a, b| {
        let own = if a == b { 1.0 } else { 0.0 };
        own - if a % 3 == b % 3 { 1.0 / 3.0 } else { 0.0 }
    })
}
