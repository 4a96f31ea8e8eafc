//! A recording on the board's tape: under the stillness limits that it needs, with the estimate that settled the question.

use tumble_core::calibration::{Reason, Verdict};
use tumble_core::estimate::sums::SegmentNoise;
use tumble_core::estimate::{Conditions, Estimate, Estimator, Progress, judge};
use tumble_core::motion::MotionEvent;
use tumble_core::motion::segmenter::Segmenter;
use tumble_core::setup::BoxFaces;
use tumble_core::tape::Tape;

use crate::recording::{Metadata, Reading};

/// Room for fifty minutes of motion (20 records a second), where the board has room for the session that it guides;
/// nothing else differs.
const RECORDS: usize = 60_000;
const SEGMENTS: usize = 1024;
/// Stillness limits, in units of the board's, tried until a session gives a result. The board's admit a trembling of three
/// times the sensor's noise (0.3 °/s) and tell a person to let go; a recording cannot be told, and a hand's tremor of
/// 0.05° at 8–12 Hz (Elble & Koller 1990) is 3 °/s. Four times is where slow motion begins to pass for rest.
const TOLERANCES: [f32; 3] = [1.0, 2.0, 4.0];
/// Nobody calls a box square whose faces err by so much (one sigma), rad: 1.5°. Poses that are taken for faces on a table lie within 6° of
/// each other (`estimate/facets.rs`), which is 2.4° in the mean square if they lie anywhere in there.
const NO_BOX: f32 = 0.026;
/// Records walked between two signs of life.
const SLICE: usize = 64;

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

/// The tape of a host.
pub type HostTape = Tape<RECORDS, SEGMENTS>;

/// The device's estimate, with what it found of each segment's noise.
pub type Estimated = Result<(Estimate, Vec<SegmentNoise>), Reason>;

/// What a recording settled into.
pub struct Settled {
    /// Everything, by segments.
    pub tape: Box<HostTape>,
    /// The stamp at which the tape was full, if it was, µs.
    pub full_us: Option<u64>,
    /// Stillness limits in units of the board's.
    pub tolerance: f32,
    /// What the estimate was made under: the session's own conditions, but that a box of which nothing is seen is not known to be square.
    pub conditions: Conditions,
    /// Under these.
    pub estimate: Estimated,
}

/// What the metadata say of table and box, and the cautious default where they are silent.
pub fn conditions(metadata: &Metadata) -> Conditions {
    Conditions {
        stops: metadata.turns.unwrap_or_default(),
        faces: metadata.box_faces.unwrap_or_default(),
        gravity_mps2: metadata.gravity_mps2.map_or(Conditions::CAUTIOUS.gravity_mps2, |g| g as f32),
    }
}

/// What a person should know who says where on Earth the recording was made and not how strong gravity is there. The contract's g is the
/// standard one; who simulates at a latitude may well have kept it, so that it is not replaced behind anyone's back.
pub fn unstated_gravity(metadata: &Metadata) -> Option<String> {
    let latitude_deg = metadata.latitude_deg.filter(|_| metadata.gravity_mps2.is_none())?;
    let normal = normal_gravity_mps2(latitude_deg);
    let share = 100.0 * (normal / f64::from(Conditions::CAUTIOUS.gravity_mps2) - 1.0);
    Some(format!(
        "Gravity is taken as 9.80665 m/s²: 'gravity_mps2' is not stated. At latitude {latitude_deg}° and sea level it is {normal:.4}, which would change the \
         accelerometer's scale by {share:+.3} %. State it if that matters."
    ))
}

/// At sea level, by the geodetic latitude: the series of the GRS 1980 ellipsoid. From the standard value it differs by up to 0.27 %, which is
/// 90 sigma of an accelerometer's scale.
fn normal_gravity_mps2(latitude_deg: f64) -> f64 {
    let (once, twice) = (latitude_deg.to_radians().sin(), (2.0 * latitude_deg).to_radians().sin());
    9.780_327 * (1.0 + 0.005_302_4 * once * once - 0.000_005_8 * twice * twice)
}

impl Settled {
    /// Had the limits to be widened?
    pub fn trembles(&self) -> bool {
        self.tolerance > TOLERANCES[0]
    }
}

impl Session<'_> {
    /// Under the narrowest stillness limits with which nothing is said for want of rests; else the narrowest with a result
    /// that the judge does not reject; else the board's own. `progress` hears which share of an estimate is done, 0 to 1.
    pub fn settle(&self, progress: &mut impl FnMut(f32)) -> Settled {
        let (mut first, mut usable) = (None, None);
        for tolerance in TOLERANCES {
            let settled = self.settle_at(tolerance, progress);
            let Ok((estimate, _)) = &settled.estimate else {
                first.get_or_insert(settled);
                continue;
            };
            let judgement = judge::judge(estimate, &settled.tape, self.lost).0;
            let accepted = judgement.verdict != Verdict::Rejected;
            let content = !judgement.reasons.iter().any(wants_rest);
            if content && accepted {
                return settled;
            }
            let kept = if accepted { &mut usable } else { &mut first };
            kept.get_or_insert(settled);
            if content {
                break;
            }
        }
        // At the board's own limits one of the two was filled.
        usable.or(first).unwrap_or_else(|| self.settle_at(TOLERANCES[0], progress))
    }

    /// With the stillness limits at `tolerance` times the usual.
    pub fn settle_at(&self, tolerance: f32, progress: &mut impl FnMut(f32)) -> Settled {
        let mut tape = Box::new(HostTape::new());
        let full_us = record(self.readings, tolerance, &mut tape);
        let settled = |conditions, tape, estimate| Settled { tape, full_us, tolerance, conditions, estimate };
        let boxed = estimate(&tape, self.conditions, progress);
        if self.conditions.faces != BoxFaces::Square || boxed.as_ref().is_ok_and(|(estimate, _)| shows_box(estimate)) {
            return settled(self.conditions, tape, boxed);
        }
        let boxless = Conditions { faces: BoxFaces::Unknown, ..self.conditions };
        let estimate = estimate(&tape, boxless, progress);
        settled(boxless, tape, estimate)
    }
}

/// Did the faces of a box called square say where its axes are? Not where fewer than three lay on the table, which could not contradict
/// each other, nor where they err by more than `NO_BOX`: these are poses at random that happen to lie near faces.
fn shows_box(estimate: &Estimate) -> bool {
    estimate.plated && estimate.noise.facet_sigma_rad.is_none_or(|sigma| sigma < NO_BOX)
}

/// Puts readings on a tape with the stillness limits at `tolerance` times the usual; if it was full before the end, the stamp
/// when, µs.
pub fn record<const R: usize, const S: usize>(
    readings: &[Reading],
    tolerance: f32,
    tape: &mut Tape<R, S>,
) -> Option<u64> {
    let mut segmenter = Segmenter::new(tolerance);
    let mut full_us = None;
    for reading in readings {
        let events = segmenter.step(&reading.sample, reading.clipped, tape);
        tape.note_temperature(reading.sample.temperature_degc);
        if events.contains(&MotionEvent::TapeFull) {
            full_us = Some(reading.sample.t_us);
        }
    }
    segmenter.finish(tape);
    full_us
}

/// The device's estimate over a tape.
///
/// # Errors
/// If the arithmetic breaks down.
pub fn estimate<const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    conditions: Conditions,
    progress: &mut impl FnMut(f32),
) -> Estimated {
    let mut place = Box::new(None);
    let estimator = Estimator::begin(&mut place, tape, conditions);
    loop {
        match estimator.work(tape, SLICE).map_err(|breakdown| Reason::Arithmetic { place: breakdown.0 })? {
            Progress::Working(share) => progress(share.min(1.0)),
            Progress::Done(estimate) => return Ok((estimate, estimator.segment_noise().to_vec())),
        }
    }
}

/// Reasons that rests not recognised as such bring about.
const fn wants_rest(reason: &Reason) -> bool {
    matches!(
        reason,
        Reason::FacesMissing { .. }
            | Reason::TurnsMissing { .. }
            | Reason::NotObservable { .. }
            | Reason::Uncertain { .. }
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_is_what_is_stated_and_a_latitude_says_what_it_might_be() {
        let stated = |latitude_deg, gravity_mps2| Metadata { latitude_deg, gravity_mps2, ..Metadata::default() };
        let at = |latitude_deg, gravity_mps2| conditions(&stated(latitude_deg, gravity_mps2)).gravity_mps2;
        assert_eq!(at(Some(0.0), None), tumble_core::STANDARD_GRAVITY_MPS2);
        // Equator, 45° and pole of the ellipsoid.
        for (latitude_deg, gravity) in [(0.0, "9.7803"), (45.0, "9.8062"), (-90.0, "9.8322")] {
            let said = unstated_gravity(&stated(Some(latitude_deg), None)).expect("a remark");
            assert!(said.contains(gravity), "{said}");
        }
        assert_eq!(unstated_gravity(&stated(Some(0.0), Some(9.78))), None);
        assert_eq!((at(Some(0.0), Some(9.81)), at(None, None)), (9.81, tumble_core::STANDARD_GRAVITY_MPS2));
    }
}
