//! A turn that should have been whole stopped short or went too far, by more than its stop allows.

use super::{Card, DPS, Effect, Model, Variant, parameter};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::influence::Influence;
use crate::diagnose::twin::visit::{Rested, Visit};

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
    let at = |turn: &Turn| Some(("at", twin.samples[turn.end - 1].t_s, "s"));
    let mut variants = Vec::new();
    let mut every = Vec::new();
    for visit in &visits {
        let mut missing = 0.0;
        for (k, turn) in visit.iter().enumerate() {
            // One stop off the mark: the next is not.
            variants.push(variant(at(turn), vec![(turn.last, turn.sign * DPS)]));
            // One turn short, and what follows on this face starts from where it ended.
            let after = visit[k..].iter().map(|later| (later.last, turn.sign * DPS)).collect::<Vec<_>>();
            if after.len() > 1 {
                variants.push(variant(at(turn), after));
            }
            missing += turn.sign * DPS;
            every.push((turn.last, missing));
        }
    }
    // Every turn short by the same.
    variants.push(variant(None, every));
    Model::Shift(variants)
}

/// A whole turn, in one go or in steps.
#[derive(Clone, Copy)]
struct Turn {
    /// Stretch of its last step.
    last: usize,
    /// Sample after it.
    end: usize,
    /// What is missing of a turn counter-clockwise leaves the heading behind, of one clockwise ahead.
    sign: f64,
}

/// Whole turns by the stops that they count from, as the twin closes them.
fn visits(twin: &Twin) -> Vec<Vec<Turn>> {
    let mut visits: Vec<Vec<Turn>> = vec![Vec::new()];
    let (mut visit, mut ended): (Option<Visit>, usize) = (None, 0);
    for stretch in &twin.stretches {
        let end = stretch.samples.end;
        if let Deed::Turn { angle_rad, .. } = stretch.deed
            && !stretch.excluded
        {
            visit.iter_mut().for_each(|visit| visit.turn(stretch.number, angle_rad));
            ended = end;
            continue;
        }
        let kept = visit.take();
        let Some(face) = stretch.face().filter(|_| stretch.is_rest()) else { continue };
        let attitude = twin.trajectory.moments[end - 1].attitude;
        let mut on = kept.filter(|visit| visit.face == face).unwrap_or_else(|| Visit::begin(face));
        match on.rest(&attitude, &(attitude * face.normal().cast::<f64>())) {
            Rested::Closed(_, sign) => {
                let turn = Turn { last: on.last_turn, end: ended, sign: -sign };
                visits.last_mut().into_iter().for_each(|turns| turns.push(turn));
            }
            Rested::Between => {}
            Rested::First => visits.push(Vec::new()),
        }
        visit = Some(on);
    }
    visits
}
