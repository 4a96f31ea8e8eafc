//! A recording through the board's own session code: the same types and the same `f32` arithmetic; and through the
//! references that it is held against.

use nalgebra::SMatrix;
use tumble_core::calibration::{Calibration, Judgement, Reason, Verdict};
use tumble_core::estimate::two_step;
use tumble_core::estimate::{Conditions, Estimate, PARAMETERS, judge};
use tumble_core::procedure::BoxFaces;
use tumble_core::tape::{Exclusion, Kind, Segment};

use crate::output::SegmentReport;
use crate::reference;
use crate::settle::{self, HostTape};
pub use crate::settle::{Session, conditions};

/// What computes the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The board's own, in its own arithmetic.
    Device,
    /// The same problem in one piece, `f64`, from the samples.
    Batch,
    /// Gravity over rests alone, after Tedaldi et al. 2014.
    Gravity,
    /// The paper's method in the board's arithmetic: as printed, corrected, or its comparison method.
    TwoStep(two_step::Variant),
}

/// What a session came to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// None where nothing could be computed.
    pub calibration: Option<Calibration>,
    /// May it be used?
    pub verdict: Verdict,
    /// One sentence each, the most important first.
    pub reasons: Vec<String>,
    /// Of the 24 numbers, in the order of [`crate::output::covariance_order`].
    pub covariance: Option<SMatrix<f32, PARAMETERS, PARAMETERS>>,
    /// What was found, by the recording's own stamps.
    pub segments: Vec<SegmentReport>,
}

impl Session<'_> {
    /// Replays it as the board would; `progress` hears which share is done, 0 to 1.
    pub fn replay(&self, progress: &mut impl FnMut(f32)) -> Outcome {
        self.run(Method::Device, progress)
    }

    /// Computes it with any method. A reference starts from the device's result and noise, and is judged by the same judge.
    pub fn run(&self, method: Method, progress: &mut impl FnMut(f32)) -> Outcome {
        let settled = self.settle(progress);
        let conditions = match method {
            Method::Gravity => Conditions { faces: BoxFaces::Unknown, ..self.conditions },
            Method::TwoStep(_) => Conditions { faces: BoxFaces::Square, ..self.conditions },
            Method::Device | Method::Batch => settled.conditions,
        };
        let tape = &settled.tape;
        let first = match conditions == settled.conditions {
            true => settled.estimate.clone(),
            false => settle::estimate(tape, conditions, progress),
        };
        let estimate = first.and_then(|(mut estimate, noise)| {
            let found = match method {
                Method::Device => return Ok(estimate),
                Method::Batch => reference::batch(tape, self.readings, &conditions, &estimate, &noise),
                Method::Gravity => reference::gravity(tape, self.readings, &conditions, &estimate),
                Method::TwoStep(variant) => {
                    let found = two_step::estimate::<f32, _, _>(tape, &conditions, variant);
                    let found = found.map_err(|breakdown| Reason::Arithmetic { place: breakdown.0 })?;
                    Some((found.calibration, estimate.covariance))
                }
            };
            (estimate.calibration, estimate.covariance) = found.ok_or(Reason::Arithmetic { place: "reference" })?;
            Ok(estimate)
        });
        let covariance = estimate.as_ref().ok().filter(|_| !matches!(method, Method::TwoStep(_))).map(|e| e.covariance);
        let mut outcome = self.judged(tape, estimate);
        outcome.covariance = covariance;
        if matches!(method, Method::Gravity) && outcome.verdict == Verdict::Rejected {
            outcome.reasons.insert(
                0,
                "This estimator goes by the size of gravity at rest alone, which on six faces shows no angle between the accelerometer's axes: rest in \
                 nine oblique poses or more, or leave `--estimator gravity` away."
                    .into(),
            );
        }
        if let Some(full_us) = settled.full_us {
            let full_s = seconds(full_us, self.origin_s);
            outcome.warn(format!("The session's memory was full at {full_s:.1} s: what came later was left out."));
        }
        let boxless = self.conditions.frame() != conditions.frame() && !matches!(method, Method::Gravity);
        if boxless && outcome.verdict != Verdict::Rejected {
            outcome.warn(
                "The box was called square, but fewer than three of its faces could be compared on the table: the numbers are given in the \
                 accelerometer's own axes. For the box's axes lay it on three faces or more without a break."
                    .into(),
            );
        }
        if settled.trembles() {
            let tolerance = settled.tolerance;
            outcome.warn(format!(
                "The rests tremble: they were found with limits {tolerance} times the board's. Put the sensor down and let go at each."
            ));
        }
        outcome
    }

    fn judged(&self, tape: &HostTape, estimate: Result<Estimate, Reason>) -> Outcome {
        let judgement = match &estimate {
            Ok(estimate) => judge::judge(estimate, tape, self.lost).0,
            Err(_) if !judge::missing(tape).is_empty() => judge::nothing_to_estimate(tape),
            Err(reason) => Judgement { verdict: Verdict::Rejected, reasons: [*reason].into_iter().collect() },
        };
        let mut outcome = Outcome {
            calibration: estimate.ok().map(|estimate| estimate.calibration),
            verdict: judgement.verdict,
            reasons: judgement.reasons.iter().map(in_words).collect(),
            covariance: None,
            segments: tape.segments().iter().map(|segment| report(segment, self.origin_s)).collect(),
        };
        mark_excluded(&mut outcome.segments, &judgement);
        outcome
    }
}

impl Outcome {
    /// Adds what a person should know.
    pub fn warn(&mut self, reason: String) {
        self.reasons.push(reason);
        if self.verdict == Verdict::Accepted {
            self.verdict = Verdict::AcceptedWithWarnings;
        }
    }
}

/// As the board says it; a recording can be asked further.
fn in_words(reason: &Reason) -> String {
    match reason {
        Reason::PoorFit { .. } => format!("{reason} `tumble diagnose` tells what it is that does not fit."),
        _ => reason.to_string(),
    }
}

/// What the estimator left out by itself stands among the reasons only.
fn mark_excluded(segments: &mut [SegmentReport], judgement: &Judgement) {
    for reason in &judgement.reasons {
        if let Reason::SegmentExcluded { segment, .. } = reason
            && let Some(segment) = segments.get_mut(usize::from(*segment))
        {
            segment.used = false;
            segment.why = why(Exclusion::Outlier).into();
        }
    }
}

fn report(segment: &Segment, origin_s: f64) -> SegmentReport {
    let (kind, angle_rad) = match segment.kind {
        Kind::Still { .. } => ("still", 0.0),
        Kind::OnTable { angle_rad, .. } => ("turn", angle_rad),
        Kind::Hand => ("move", 0.0),
    };
    let why = why(segment.exclusion);
    SegmentReport {
        kind: kind.into(),
        start_s: seconds(segment.start_us, origin_s),
        end_s: seconds(segment.end_us, origin_s),
        face: segment.face().map_or("other", |face| face.name()).into(),
        angle_deg: angle_rad.to_degrees(),
        used: why.is_empty(),
        why: why.into(),
    }
}

/// Back to the recording's own stamps, without digits that the microsecond does not bear.
fn seconds(t_us: u64, origin_s: f64) -> f64 {
    ((origin_s * 1e6).round() + t_us as f64) / 1e6
}

/// Why a segment is not used; nothing for one that is.
pub fn why(exclusion: Exclusion) -> &'static str {
    match exclusion {
        Exclusion::None => "",
        Exclusion::Clipped => "a reading stands at the end of its range",
        Exclusion::Gap => "samples are missing",
        Exclusion::Redone => "the person asked for this face again",
        Exclusion::SteadyTurn => "it turned steadily: its rate disagrees with that of later rests",
        Exclusion::BiasJump => "the gyroscope's bias jumped in it",
        Exclusion::Outlier => "it does not fit the rest",
    }
}
