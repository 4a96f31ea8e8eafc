//! From recording to verdict.

use super::answer::{assemble, broken_down, without_physics};
use super::diagnosis::Verdict;
use super::exhibits;
use super::findings;
use super::intake::{Intake, intake, intake_without_moves};
use super::judge::judge;
use super::options::Options;
use super::outcome::Outcome;
use super::search::bench::Bench;
use super::search::select;
use super::search::unknown;
use super::second;
use crate::recording::Recording;

/// Found by gates, and yet no distortion of the samples: the physics is to be searched as ever.
const HARMLESS: [&str; 4] = ["vibration_line", "spin_axis_wobble", "incomplete_turn", "gyro_bias_step"];

/// Hears what is being done, and which share of all is done.
pub type Progress<'a> = dyn FnMut(&str, f32) + 'a;

/// Diagnoses a recording.
pub fn diagnose(recording: &Recording, options: &Options, progress: &mut Progress) -> Outcome {
    progress("reading", 0.0);
    let mut outcome = look(recording, intake(recording, options), options, progress);
    if second::is_due(recording, &outcome.diagnosis) {
        let again = look(recording, intake_without_moves(recording, options), options, progress);
        outcome = second::settle(recording, outcome, again);
    }
    let notices = recording.notices.iter().map(|notice| format!("Of the file: {notice}."));
    outcome.diagnosis.reasons.extend(notices);
    outcome
}

fn look(recording: &Recording, taken: Intake, options: &Options, progress: &mut Progress) -> Outcome {
    let origin_s = recording.origin_s();
    let Intake { gated, conditions, prepared, remarks } = taken;
    let prepared = match prepared {
        Ok(prepared) => prepared,
        Err(why) => return without_physics(&gated, why),
    };
    let mut without = options.without.clone();
    without.extend(gated.imitated.iter().cloned());
    let mut bench = Bench::new(prepared.twin, &without);
    let selection = select::select(&mut bench, options.seed, progress);
    if !selection.evidence.is_finite() {
        return broken_down(&bench, &gated, origin_s);
    }
    progress("what is left", 0.85);
    let leftover = unknown::left_over(&mut bench);
    let found = findings::findings(&mut bench, &selection, origin_s);
    let mut judged = judge(&mut bench, &selection, &leftover, found);
    if gated.found.iter().any(|found| !HARMLESS.contains(&found.id.as_str())) {
        judged.stand_beside_gates();
    }
    progress("report", 0.95);
    let exhibits = exhibits::exhibits(&bench, &selection, &judged.named, &leftover, origin_s);
    let mut diagnosis = assemble(&mut bench, &selection, &leftover, judged, gated, conditions, origin_s);
    // Beside an effect they would tell of the effect, which the estimator did not know.
    if diagnosis.verdict == Verdict::NothingMissing {
        diagnosis.reasons.extend(remarks);
    }
    Outcome { diagnosis, exhibits: Some(exhibits) }
}
