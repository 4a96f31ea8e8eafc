//! From recording to verdict.

use nalgebra::Vector3;
use tumble_core::estimate::Conditions;
use tumble_core::procedure::BoxFaces;

use super::diagnosis::{Diagnosis, FitReport, Unknown, Verdict};
use super::exhibits;
use super::findings::{self, Finding};
use super::gates::Gated;
use super::intake::{Intake, intake, intake_without_moves};
use super::judge::{Judged, judge};
use super::limits;
use super::outcome::Outcome;
use super::search::bench::Bench;
use super::search::select::{self, Selection};
use super::search::unknown::{self, Leftover};
use super::second;
use super::twin::Twin;
use crate::recording::Recording;

/// Rests must point in at least this many different directions for a verdict on a calibration.
const LEAST_POSES: usize = 4;
/// Directions of gravity less than this apart are one pose, rad (30°).
const POSE_RAD: f64 = 0.52;

/// Found by gates, and yet no distortion of the samples: the physics is to be searched as ever.
const HARMLESS: [&str; 3] = ["vibration_line", "spin_axis_wobble", "incomplete_turn"];

/// What may be asked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Effects that the search is not to know.
    pub without: Vec<String>,
    /// Of the draws that set thresholds.
    pub seed: u64,
    /// Table and box, instead of what the recording states.
    pub conditions: Option<Conditions>,
}

/// Hears what is being done, and which share of all is done.
pub type Progress<'a> = dyn FnMut(&str, f32) + 'a;

/// Diagnoses a recording.
pub fn diagnose(recording: &Recording, options: &Options, progress: &mut Progress) -> Outcome {
    progress("reading", 0.0);
    let first = look(recording, intake(recording, options.conditions), options, progress);
    if !second::is_due(recording, &first.diagnosis) {
        return first;
    }
    let again = look(recording, intake_without_moves(recording, options.conditions), options, progress);
    second::settle(recording, first, again)
}

fn look(recording: &Recording, taken: Intake, options: &Options, progress: &mut Progress) -> Outcome {
    let origin_s = recording.origin_s();
    let Intake { gated, conditions, prepared } = taken;
    let prepared = match prepared {
        Ok(prepared) => prepared,
        Err(why) => return without_physics(&gated, why),
    };
    let mut without = options.without.clone();
    without.extend(gated.imitated.iter().cloned());
    let mut bench = Bench::new(prepared.twin, &without);
    let selection = select::select(&mut bench, options.seed, progress);
    if !selection.evidence.is_finite() {
        return without_physics(
            &gated,
            "The fit broke down: the samples contradict each other by more than any noise.".into(),
        );
    }
    progress("what is left", 0.85);
    let leftover = unknown::weigh(&mut bench, &[]);
    let found = findings::findings(&mut bench, &selection, origin_s);
    let mut judged = judge(&mut bench, &selection, &leftover, found);
    if gated.found.iter().any(|found| !HARMLESS.contains(&found.id.as_str())) {
        judged.beside_gates();
    }
    progress("report", 0.95);
    let exhibits = exhibits::exhibits(&bench, &selection, &judged.named, &leftover, origin_s);
    let diagnosis = assemble(&mut bench, &selection, &leftover, judged, gated, conditions, origin_s);
    Outcome { diagnosis, exhibits: Some(exhibits) }
}

fn assemble(
    bench: &mut Bench,
    selection: &Selection,
    leftover: &Leftover,
    judged: Judged,
    gated: Gated,
    conditions: Conditions,
    origin_s: f64,
) -> Diagnosis {
    let limits = limits::one_each(limits::limits(bench, selection).into_iter().chain(gated.limits));
    let mut effects = gated.found;
    for Finding { found, .. } in judged.named {
        // What a gate and the twin both found is one effect: the stronger evidence stands.
        match effects.iter_mut().find(|effect| effect.id == found.id) {
            Some(same) if same.evidence < found.evidence => *same = found,
            Some(_) => {}
            None => effects.push(found),
        }
    }
    effects.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    let unknown = judged.unknown.then(|| {
        let mut correlates = judged.better;
        if leftover.is_real() {
            correlates.extend(exhibits::correlates(bench, leftover));
        }
        correlates.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut resembles: Vec<String> = judged.demoted.iter().map(|finding| finding.found.id.clone()).collect();
        let gains = selection.first.iter().filter(|score| score.gain > selection.threshold);
        let alike = gains.map(|score| bench.candidates[score.candidate].effect.card.id.to_string());
        resembles.extend(alike.filter(|id| !effects.iter().any(|effect| effect.id == *id)).take(3));
        let mut said = std::collections::BTreeSet::new();
        resembles.retain(|id| said.insert(id.clone()));
        Unknown {
            place: findings::place(bench, &leftover.rows, &leftover.signal, origin_s),
            correlates_with: correlates.into_iter().map(|(shape, _)| shape).take(5).collect(),
            resembles,
            p_value: judged.p_value,
        }
    });
    let poses = poses(&bench.twin);
    let (dropped, traces) = (judged.dropped, judged.traces);
    let mut reasons = Vec::new();
    let verdict = match (&unknown, effects.is_empty()) {
        (Some(_), _) => Verdict::UnknownEffect,
        (None, false) => Verdict::EffectFound,
        (None, true) if poses < LEAST_POSES => Verdict::NotTestable,
        (None, true) => Verdict::NothingMissing,
    };
    if poses < LEAST_POSES {
        reasons.push(format!(
            "The sensor rested in {poses} different pose(s): record rests on all six faces, with a full turn on each, so that \
             scale, axes and gravity's influence can show."
        ));
    }
    if traces {
        reasons.push(
            "More is left over than noise explains. What was found in the samples themselves leaves such traces; record \
             again without it before looking further."
                .into(),
        );
    }
    reasons.extend(
        dropped.iter().map(|id| {
            format!("{id} would explain the data it is fitted to, but not the half left out: it is not named.")
        }),
    );
    if bench.twin.noise.facet_sigma_rad.is_none() && conditions.faces == BoxFaces::Unknown {
        reasons.push("The box is not stated to be square, so the table's angle was not tested.".into());
    }
    let fit = findings::fit_report(bench, selection);
    Diagnosis {
        format: "tumble-diagnosis",
        version: 1,
        verdict,
        effects,
        unknown,
        fit,
        detection_limits: limits,
        reasons,
    }
}

fn without_physics(gated: &Gated, why: String) -> Outcome {
    let verdict = if gated.found.is_empty() { Verdict::NotTestable } else { Verdict::EffectFound };
    let diagnosis = Diagnosis {
        format: "tumble-diagnosis",
        version: 1,
        verdict,
        effects: gated.found.clone(),
        unknown: None,
        fit: FitReport::default(),
        detection_limits: gated.limits.clone(),
        reasons: vec![why],
    };
    Outcome { diagnosis, exhibits: None }
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
