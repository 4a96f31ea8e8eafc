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
    let visits = visits(twin);
    if visits.iter().map(Vec::len).sum::<usize>() < 2 {
        return Model::Absent("fewer than two whole turns on the table");
    }
    let variant = |setting, turns: Vec<(usize, f64)>| Variant {
        setting,
        parameters: vec![parameter("missing", "deg", 3.0)],
        influences: vec![Influence::Stop(turns)],
        own: None,
        at_size: None,
    };
    let at = |turn: &Stretch| Some(("at", twin.samples[turn.samples.end - 1].t_s, "s"));
    let mut variants = Vec::new();
    let mut every = Vec::new();
    for visit in &visits {
        let mut missing = 0.0;
        for (k, turn) in visit.iter().enumerate() {
            // One stop off the mark: the next is not.
            variants.push(variant(at(turn), vec![(turn.number, sign(turn) * DPS)]));
            // One turn short, and what follows on this face starts from where it ended.
            let after = visit[k..].iter().map(|later| (later.number, sign(turn) * DPS)).collect::<Vec<_>>();
            if after.len() > 1 {
                variants.push(variant(at(turn), after));
            }
            missing += sign(turn) * DPS;
            every.push((turn.number, missing));
        }
    }
    // Every turn short by the same.
    variants.push(variant(None, every));
    Model::Shift(variants)
}

/// What is missing of a turn counter-clockwise leaves the heading behind, of one clockwise ahead.
fn sign(turn: &Stretch) -> f64 {
    match turn.deed {
        Deed::Turn { angle_rad, .. } => -angle_rad.signum(),
        _ => 0.0,
    }
}

/// Whole turns by stays on a face.
fn visits(twin: &Twin) -> Vec<Vec<&Stretch>> {
    let mut visits: Vec<Vec<&Stretch>> = vec![Vec::new()];
    for stretch in &twin.stretches {
        match stretch.deed {
            Deed::Move => visits.push(Vec::new()),
            _ if stretch.is_whole_turn() => {
                if let Some(visit) = visits.last_mut() {
                    visit.push(stretch);
                }
            }
            _ => {}
        }
    }
    visits
}
