//! From what gates, search and judge found to the contract's object.

use nalgebra::Vector3;
use tumble_core::estimate::Conditions;
use tumble_core::procedure::BoxFaces;

use super::diagnosis::{Diagnosis, Found, Unknown, Verdict};
use super::exhibits::{self, once};
use super::findings::{self, Finding};
use super::gates::Gated;
use super::judge::Judged;
use super::limits;
use super::outcome::Outcome;
use super::search::bench::Bench;
use super::search::select::Selection;
use super::search::unknown::Leftover;
use super::twin::Twin;

/// Rests must point in at least this many different directions for a verdict on a calibration.
const LEAST_POSES: usize = 4;
/// Directions of gravity less than this apart are one pose, rad (30°).
const POSE_RAD: f64 = 0.52;

/// The answer.
pub fn assemble(
    bench: &mut Bench,
    selection: &Selection,
    leftover: &Leftover,
    mut judged: Judged,
    gated: Gated,
    conditions: Conditions,
    origin_s: f64,
) -> Diagnosis {
    let limits =
        limits::one_each(limits::limits(bench, selection, judged.beside_gates).into_iter().chain(gated.limits));
    let effects = merged(gated.found, std::mem::take(&mut judged.named));
    let poses = poses(&bench.twin);
    let verdict = if judged.unknown {
        Verdict::UnknownEffect
    } else if !effects.is_empty() {
        Verdict::EffectFound
    } else if poses < LEAST_POSES {
        Verdict::NotTestable
    } else {
        Verdict::NothingMissing
    };
    let reasons = reasons(bench, &judged, poses, conditions);
    let unknown = judged.unknown.then(|| unknown(bench, selection, leftover, judged, &effects, origin_s));
    let fit = findings::fit_report(bench, selection);
    Diagnosis { effects, unknown, fit, detection_limits: limits, reasons, ..Diagnosis::new(verdict) }
}

/// What gates found stands alone where nothing could be fitted.
pub fn without_physics(gated: &Gated, why: String) -> Outcome {
    let verdict = if gated.found.is_empty() { Verdict::NotTestable } else { Verdict::EffectFound };
    let diagnosis = Diagnosis {
        effects: gated.found.clone(),
        detection_limits: gated.limits.clone(),
        reasons: vec![why],
        ..Diagnosis::new(verdict)
    };
    Outcome { diagnosis, exhibits: None }
}

/// Nothing could be fitted for the samples contradict each other. Unless a gate says why, something is there that nobody knows.
pub fn broken_down(bench: &Bench, gated: &Gated, origin_s: f64) -> Outcome {
    let why = "The fit broke down: the samples contradict each other by more than any noise.";
    let mut outcome = without_physics(gated, why.into());
    if gated.found.is_empty() {
        let place = findings::everywhere(bench, origin_s);
        outcome.diagnosis.verdict = Verdict::UnknownEffect;
        outcome.diagnosis.unknown =
            Some(Unknown { place, correlates_with: Vec::new(), resembles: Vec::new(), p_value: 0.0 });
    }
    outcome
}

/// What a gate and the twin both found is one effect: the stronger evidence stands. The strongest first.
fn merged(mut effects: Vec<Found>, named: Vec<Finding>) -> Vec<Found> {
    for Finding { found, .. } in named {
        match effects.iter_mut().find(|effect| effect.id == found.id) {
            Some(same) if same.evidence < found.evidence => *same = found,
            Some(_) => {}
            None => effects.push(found),
        }
    }
    effects.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    effects
}

/// What is there that has no name.
fn unknown(
    bench: &Bench,
    selection: &Selection,
    leftover: &Leftover,
    judged: Judged,
    effects: &[Found],
    origin_s: f64,
) -> Unknown {
    let mut correlates = judged.better;
    if leftover.is_real() {
        correlates.extend(exhibits::correlates(bench, leftover));
    }
    correlates.sort_by(|a, b| b.1.total_cmp(&a.1));
    let place = if leftover.is_real() || judged.restless.is_none() {
        findings::place(bench, &leftover.rows, &leftover.signal, origin_s)
    } else {
        findings::moves(bench, origin_s)
    };
    let fallen = judged.demoted.into_iter().map(|finding| finding.found.id);
    let gains = selection.first.iter().filter(|score| score.gain > selection.threshold);
    let alike = gains.map(|score| bench.candidates[score.candidate].effect.card.id.to_string());
    let alike = alike.filter(|id| !effects.iter().any(|effect| effect.id == *id)).take(3);
    Unknown {
        place,
        correlates_with: correlates.into_iter().map(|(shape, _)| shape).take(5).collect(),
        resembles: once(fallen.chain(alike)),
        p_value: judged.p_value,
    }
}

/// Sentences, the most important first.
fn reasons(bench: &Bench, judged: &Judged, poses: usize, conditions: Conditions) -> Vec<String> {
    let mut reasons = Vec::new();
    if poses < LEAST_POSES {
        reasons.push(format!(
            "The sensor rested in {poses} different pose(s): record rests on all six faces, with a full turn on each, so that \
             scale, axes and gravity's influence can show."
        ));
    }
    if judged.traces {
        reasons.push(
            "More is left over than noise explains. What was found in the samples themselves leaves such traces; record \
             again without it before looking further."
                .into(),
        );
        if !judged.faint.is_empty() {
            let names = once(judged.faint.iter().cloned()).join(", ");
            reasons.push(format!("It resembles {names}, but no more than such traces may."));
        }
    }
    if let Some(restless) = &judged.restless {
        reasons.push(format!(
            "The box did not end where it was measured to: {}. What shows in motion alone has limits as wide as that. Move it slower and \
             more smoothly: what goes by that was the speed or the rate of sampling.",
            restless.shape()
        ));
    }
    reasons.extend(
        judged.dropped.iter().map(|id| {
            format!("{id} would explain the data it is fitted to, but not the half left out or not beside the others: it is not named.")
        }),
    );
    if bench.twin.noise.facet_sigma_rad.is_none() && conditions.faces == BoxFaces::Unknown {
        reasons.push("The box is not stated to be square, so the table's angle was not tested.".into());
    }
    reasons
}

/// Directions of gravity at rest that differ.
fn poses(twin: &Twin) -> usize {
    let mut directions: Vec<Vector3<f64>> = Vec::new();
    for stretch in twin.stretches.iter().filter(|stretch| stretch.is_rest()) {
        let direction = twin.trajectory.moments[stretch.samples.start].force;
        if directions.iter().all(|other| other.angle(&direction) > POSE_RAD) {
            directions.push(direction);
        }
    }
    directions.len()
}
