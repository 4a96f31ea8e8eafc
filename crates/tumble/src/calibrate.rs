//! A recording through the board's own session code: the same types and the same `f32` arithmetic.

use nalgebra::SMatrix;
use tumble_core::calibration::{Calibration, Judgement, Reason, Verdict};
use tumble_core::estimate::{Conditions, Estimate, Estimator, PARAMETERS, Progress, judge};
use tumble_core::motion::MotionEvent;
use tumble_core::motion::segmenter::Segmenter;
use tumble_core::tape::{Exclusion, Kind, Segment, Tape};

use crate::output::SegmentReport;
use crate::recording::{Metadata, Reading};

/// Room for fifty minutes of motion (20 records a second), where the board has room for the session that it guides;
/// nothing else differs.
const RECORDS: usize = 60_000;
const SEGMENTS: usize = 1024;
/// Records walked between two signs of life.
const SLICE: usize = 64;

type HostTape = Tape<RECORDS, SEGMENTS>;

/// What is replayed.
pub struct Session<'a> {
    /// In order of time.
    pub readings: &'a [Reading],
    /// The recording's stamp at time 0 of the readings.
    pub origin_s: f64,
    /// Samples that never came.
    pub lost: u32,
    /// What is known of table and box.
    pub conditions: Conditions,
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

/// What the metadata say of table and box, and the cautious default where they are silent.
pub fn conditions(metadata: &Metadata) -> Conditions {
    Conditions {
        stops: metadata.turns.unwrap_or_default(),
        faces: metadata.box_faces.unwrap_or_default(),
        gravity_mps2: metadata.gravity_mps2.map_or(Conditions::CAUTIOUS.gravity_mps2, |g| g as f32),
    }
}

impl Session<'_> {
    /// Replays it; `progress` hears which share is done, 0 to 1.
    pub fn replay(&self, progress: &mut impl FnMut(f32)) -> Outcome {
        let mut tape = Box::new(HostTape::new());
        let full_s = self.fill(&mut tape);
        let estimate = estimate(&tape, self.conditions, progress);
        let judgement = match &estimate {
            Ok(estimate) => judge::judge(estimate, &tape, self.lost).0,
            Err(reason) => Judgement { verdict: Verdict::Rejected, reasons: [*reason].into_iter().collect() },
        };
        let mut outcome = Outcome {
            calibration: estimate.as_ref().ok().map(|estimate| estimate.calibration),
            verdict: judgement.verdict,
            reasons: judgement.reasons.iter().map(ToString::to_string).collect(),
            covariance: estimate.ok().map(|estimate| estimate.covariance),
            segments: tape.segments().iter().map(|segment| report(segment, self.origin_s)).collect(),
        };
        mark_excluded(&mut outcome.segments, &judgement);
        if let Some(full_s) = full_s {
            outcome.warn(format!("The session's memory was full at {full_s:.1} s: what came later was left out."));
        }
        outcome
    }

    /// Everything onto the tape; if it was full before the end, when.
    fn fill(&self, tape: &mut HostTape) -> Option<f64> {
        let mut segmenter = Segmenter::new(1.0);
        let mut full_s = None;
        for reading in self.readings {
            let events = segmenter.step(&reading.sample, reading.clipped, tape);
            tape.note_temperature(reading.sample.temperature_degc);
            if events.contains(&MotionEvent::TapeFull) {
                full_s = Some(seconds(reading.sample.t_us, self.origin_s));
            }
        }
        segmenter.finish(tape);
        full_s
    }
}

impl Outcome {
    fn warn(&mut self, reason: String) {
        self.reasons.push(reason);
        if self.verdict == Verdict::Accepted {
            self.verdict = Verdict::AcceptedWithWarnings;
        }
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

fn estimate(tape: &HostTape, conditions: Conditions, progress: &mut impl FnMut(f32)) -> Result<Estimate, Reason> {
    let mut estimator = Box::new(Estimator::new(tape, conditions));
    loop {
        match estimator.work(tape, SLICE).map_err(|breakdown| Reason::Arithmetic { place: breakdown.0 })? {
            Progress::Working(share) => progress(share.min(1.0)),
            Progress::Done(estimate) => return Ok(estimate),
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

fn why(exclusion: Exclusion) -> &'static str {
    match exclusion {
        Exclusion::None => "",
        Exclusion::Clipped => "a reading stands at the end of its range",
        Exclusion::Gap => "samples are missing",
        Exclusion::Redone => "the person asked for this face again",
        Exclusion::SteadyTurn => "it turned steadily: its rate disagrees with that of later rests",
        Exclusion::Outlier => "it does not fit the rest",
    }
}
