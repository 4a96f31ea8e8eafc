//! What a calibration leaves out although the recording shows it: the diagnosis, asked on the calibration's behalf.
//!
//! An effect that the model does not hold bends its numbers, and neither its residuals nor its sigmas tell: nine numbers of a matrix take a
//! cubic scale in, and the fit looks well. Scales that follow temperature were off by 79 sigma in sessions that fitted, cubic ones by 26, biases of
//! the accelerometer that jump or warm up by 16 to 90.

use tumble_core::estimate::Conditions;
use tumble_core::tape::Exclusion;

use crate::calibrate::{Outcome, why};
use crate::diagnose::carry::CARRIED;
use crate::diagnose::catalogue::STRUCTURAL;
use crate::diagnose::diagnosis::{Diagnosis, Found, Verdict};
use crate::diagnose::report::words::odds;
use crate::diagnose::{Options, diagnose};
use crate::recording::Recording;

/// Effects that the estimator has states or noise for: its numbers and their sigmas allow for them.
const HELD: [&str; 3] = ["accel_lever_arm", "earth_rotation", "incomplete_turn"];

/// Asks the diagnosis; `progress` hears what is done and which share of it.
pub fn ask(recording: &Recording, conditions: Conditions, mut progress: impl FnMut(&str, f32)) -> Diagnosis {
    let options = Options { without: Vec::new(), seed: 1, conditions: Some(conditions) };
    diagnose(recording, &options, &mut progress).diagnosis
}

/// Adds to the outcome's warnings what its numbers do not allow for; `carried` was taken out before.
pub fn tell(diagnosis: &Diagnosis, carried: &[String], outcome: &mut Outcome) {
    let carries_g = outcome.calibration.as_ref().is_some_and(|calibration| calibration.g_sensitivity.is_some());
    let jumped = outcome.segments.iter().any(|segment| segment.why == why(Exclusion::BiasJump));
    let held = |id: &str| {
        HELD.contains(&id)
            || carried.iter().any(|carried| carried == id)
            || (id == "gyro_g_sensitivity" && carries_g)
            || (id == "gyro_bias_step" && jumped)
    };
    let structural = |id: &str| STRUCTURAL.iter().any(|effect| effect.card.id == id);
    for found in diagnosis.effects.iter().filter(|found| structural(&found.id) && !held(&found.id)) {
        outcome.warn(sentence(found));
    }
    if diagnosis.verdict == Verdict::UnknownEffect {
        outcome.warn(
            "Something in this recording is in no model of mine, and the numbers may be off by more than their sigmas. `tumble diagnose` tells \
             where it shows and what it follows."
                .into(),
        );
    }
}

fn sentence(found: &Found) -> String {
    let remedy = if CARRIED.contains(&found.id.as_str()) {
        format!("`tumble calibrate --with {}` fits it and takes it out first", found.id)
    } else {
        format!("To do better: {}", found.separate_by)
    };
    format!(
        "Not in these numbers: {} ({}, {}). They may be off by more than their sigmas. {remedy}.",
        found.name,
        found.id,
        odds(found.evidence)
    )
}
