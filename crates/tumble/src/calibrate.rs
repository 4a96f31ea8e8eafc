//! A recording through the board's own session code: the same types and the same `f32` arithmetic.

use nalgebra::SMatrix;
use tumble_core::calibration::{Calibration, Judgement, Reason, Verdict};
use tumble_core::estimate::{Conditions, Estimate, Estimator, PARAMETERS, Progress};
use tumble_core::motion::segmenter::Segmenter;
use tumble_core::tape::{Exclusion, Kind, Segment, Tape};

use crate::output::SegmentReport;
use crate::recording::{Metadata, Reading};

/// Room for one hour, where the board has room for the session that it guides; nothing else differs.
const RECORDS: usize = 65_536;
const SEGMENTS: usize = 1024;

/// What a session came to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// None where nothing could be computed.
    pub calibration: Option<Calibration>,
    /// May it be used?
    pub judgement: Judgement,
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

/// Replays `readings`; `progress` hears which share is done, 0 to 1.
pub fn replay(readings: &[Reading], origin_s: f64, conditions: Conditions, progress: &mut impl FnMut(f32)) -> Outcome {
    let mut tape = Box::new(Tape::<RECORDS, SEGMENTS>::new());
    let mut segmenter = Segmenter::new(1.0);
    for reading in readings {
        segmenter.step(&reading.sample, reading.clipped, &mut tape);
        tape.note_temperature(reading.sample.temperature_degc);
    }
    segmenter.finish(&mut tape);
    let estimate = estimate(&tape, conditions, progress);
    let segments = tape.segments().iter().map(|segment| report(segment, origin_s)).collect();
    match estimate {
        Ok(estimate) => Outcome {
            judgement: Judgement { verdict: Verdict::Accepted, reasons: Default::default() },
            calibration: Some(estimate.calibration),
            covariance: Some(estimate.covariance),
            segments,
        },
        Err(reason) => Outcome {
            calibration: None,
            judgement: Judgement { verdict: Verdict::Rejected, reasons: [reason].into_iter().collect() },
            covariance: None,
            segments,
        },
    }
}

fn estimate(
    tape: &Tape<RECORDS, SEGMENTS>,
    conditions: Conditions,
    progress: &mut impl FnMut(f32),
) -> Result<Estimate, Reason> {
    let mut estimator = Box::new(Estimator::new(tape, conditions));
    loop {
        match estimator.work(tape, 64).map_err(|breakdown| Reason::Arithmetic { place: breakdown.0 })? {
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
