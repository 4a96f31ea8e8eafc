//! A turn that should have been whole stopped short or went too far, by more than its stop allows.

use super::{Card, DPS, Effect, Model, Variant, parameter};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::{Deed, Stretch};
use crate::diagnose::twin::influence::Influence;

const CARD: Card = Card {
    id: "incomplete_turn",
    name: "a turn did not end where it began",
    equation: "angle = 2*pi*n - d",
    typical: "below 0.1 deg against a fence, 2 deg by eye",
    shows: "one turn's angle disagrees with the others about the same axis",
    confounded: &["gyro_scale_asymmetry", "gyro_bias_step"],
    separate_by: "repeat the turn",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    let turns = || twin.stretches.iter().filter(|stretch| stretch.is_whole_turn());
    if turns().count() < 2 {
        return Model::Absent("fewer than two whole turns on the table");
    }
    // What is missing of a turn counter-clockwise leaves the heading behind, of one clockwise ahead.
    let sign = |turn: &Stretch| match turn.deed {
        Deed::Turn { angle_rad, .. } => -angle_rad.signum(),
        _ => 0.0,
    };
    let variant = |turn: &Stretch| Variant {
        setting: Some(("at", twin.samples[turn.samples.end - 1].t_s, "s")),
        parameters: vec![parameter("missing", "deg", 3.0)],
        influences: vec![Influence::Stop(vec![(turn.number, sign(turn) * DPS)])],
    };
    Model::Shift(turns().map(variant).collect())
}
