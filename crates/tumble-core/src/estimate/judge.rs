//! The verdict: apart from the estimate, and the only way to a calibration that can be stored.

use heapless::Vec;
use nalgebra::Vector3;

use super::device::Estimate;
use super::noise;
use crate::DEGREE_RAD;
use crate::calibration::{AcceptedCalibration, Calibration, Judgement, Reason, Verdict};
use crate::face::{Face, FaceSet};
use crate::motion::means::{mean_force, mean_rate};
use crate::motion::path::whole_turns;
use crate::tape::{Exclusion, Kind, Segment, Tape};

/// A correction's diagonal is 1 within 3 % and its other elements 0 within 2 % (sheet), a chip sits askew by at most 3°;
/// beyond thrice that something else is wrong: a range, a unit, an axis.
const CORRECTION_LIMIT: f32 = 0.15;
/// Accelerometer bias, m/s²: 80 mg (sheet) twice over.
const ACCEL_BIAS_LIMIT: f32 = 1.6;
/// Gyroscope bias, rad/s: what the stillness test admits before it knows better.
const GYRO_BIAS_LIMIT: f32 = 10.0 * DEGREE_RAD;
/// A correction less sure than this is worth a warning: 0.3 % is a tenth of what an uncalibrated sensor may have.
const CORRECTION_SIGMA_LIMIT: f32 = 3e-3;
/// Likewise for the accelerometer's bias, m/s² (5 mg).
const ACCEL_BIAS_SIGMA_LIMIT: f32 = 0.05;
/// Motion whose residuals are this many times their expected square is worth a warning: five sigma where one is expected.
const MOTION_LIMIT: f32 = 25.0;
/// What still moves by more sigmas than this in the last pass is where nothing says that it is: a step of Gauss–Newton is the linear
/// part of what is left, and a sigma that this exceeds is not the error's.
const MOVED_LIMIT: f32 = 1.0;
/// A move down-weighted by more than this is reported as left out: its level error is 24 sigma, χ²₂ = 600.
const OUTLIER_LIMIT: f32 = 300.0;
/// A bias that moves by more than this within a session is worth a warning, rad/s.
const DRIFT_LIMIT: f32 = 0.1 * DEGREE_RAD;

/// Collects reasons and the worst verdict.
struct Bench {
    verdict: Verdict,
    reasons: Vec<Reason, 8>,
}

impl Bench {
    fn reject(&mut self, reason: Reason) {
        self.verdict = Verdict::Rejected;
        // What decides stands first; with eight reasons given, a ninth adds nothing.
        if self.reasons.is_full() {
            self.reasons.pop();
        }
        let _ = self.reasons.insert(0, reason);
    }

    /// What a person did or the sensor suffered stands before what follows from it number by number.
    fn causes_first(&mut self) {
        let follows = |reason: &Reason| matches!(reason, Reason::NotObservable { .. } | Reason::Uncertain { .. });
        let mut causes = 0;
        for at in 0..self.reasons.len() {
            if !follows(&self.reasons[at]) {
                self.reasons[causes..=at].rotate_right(1);
                causes += 1;
            }
        }
    }

    fn warn(&mut self, reason: Reason) {
        if self.verdict == Verdict::Accepted {
            self.verdict = Verdict::AcceptedWithWarnings;
        }
        let _ = self.reasons.push(reason);
    }
}

/// Judges an estimate made from `tape`; `lost` counts samples that never came. Only what is not rejected comes back.
pub fn judge<const R: usize, const S: usize>(
    estimate: &Estimate,
    tape: &Tape<R, S>,
    lost: u32,
) -> (Judgement, Option<AcceptedCalibration>) {
    let mut bench = Bench { verdict: Verdict::Accepted, reasons: Vec::new() };
    let calibration = &estimate.calibration;
    warn_of_the_session(estimate, tape, lost, &mut bench);
    warn_of_doubt(calibration, &mut bench);
    if estimate.moved > MOVED_LIMIT {
        bench.reject(Reason::Unsettled { sigmas: estimate.moved });
    }
    reject_the_impossible(calibration, &mut bench);
    reject_the_undetermined(calibration, tape, &mut bench);
    bench.causes_first();
    let accepted = (bench.verdict != Verdict::Rejected).then(|| AcceptedCalibration::new(*calibration));
    (Judgement { verdict: bench.verdict, reasons: bench.reasons }, accepted)
}

/// What a session lacks of six faces and of turns about three axes: what to say where it gave no estimate to judge. A rest of minutes on one
/// face alone, whose numbers nothing tells apart, is more than `f32` bears.
pub fn missing<const R: usize, const S: usize>(tape: &Tape<R, S>) -> Vec<Reason, 2> {
    let (held, turned) = done(tape);
    let mut reasons = Vec::new();
    if held != FaceSet::FULL {
        let _ = reasons.push(Reason::FacesMissing { missing: held.complement() });
    }
    if turned != 0b111 {
        let _ = reasons.push(Reason::TurnsMissing { axes: !turned & 0b111 });
    }
    reasons
}

fn warn_of_the_session<const R: usize, const S: usize>(
    estimate: &Estimate,
    tape: &Tape<R, S>,
    lost: u32,
    bench: &mut Bench,
) {
    if lost > 0 {
        bench.warn(Reason::SamplesLost { samples: lost });
    }
    if tape.bias_jumps.any() {
        let jump = tape.bias_jumps.largest_rad_s;
        let axis = jump.iamax();
        bench.warn(Reason::BiasJump { axis: axis as u8, jump_rad_s: jump[axis] });
    }
    let motion = estimate.noise.turn_scale.max(estimate.noise.hand_scale);
    if motion > MOTION_LIMIT {
        bench.warn(Reason::PoorFit { nis_per_dof: motion });
    } else if !estimate.converged && estimate.moved <= MOVED_LIMIT {
        bench.warn(Reason::Unsettled { sigmas: estimate.moved });
    }
    if let Some(facet_rad) = estimate.noise.crookedness_rad() {
        bench.warn(Reason::CrookedBox { facet_rad });
    }
    if let Some(lean_rad) = estimate.noise.lean_rad() {
        bench.warn(Reason::LooseContact { lean_rad });
    }
    for segment in tape.segments().iter().filter(|segment| segment.exclusion == Exclusion::Clipped) {
        let channel = segment.clipped.trailing_zeros() as u8;
        bench.warn(Reason::Clipped { channel, samples: u32::from(segment.clipped_samples) });
    }
    for (segment, scale) in estimate.outliers.iter() {
        if *scale > OUTLIER_LIMIT {
            bench.warn(Reason::SegmentExcluded { segment: *segment, nis_per_dof: *scale });
        }
    }
    let mut stills = tape
        .segments()
        .iter()
        .filter(|segment| segment.is_usable_still() && noise::is_solid(segment, estimate.noise.quiet_variance));
    if let Some(first) = stills.next() {
        let last = stills.next_back().unwrap_or(first);
        let [first, last] = [first, last].map(|still| resting_rate(tape, still, &estimate.calibration));
        let drift = last - first;
        let axis = drift.iamax();
        if libm::fabsf(drift[axis]) > DRIFT_LIMIT {
            bench.warn(Reason::BiasDrift { axis: axis as u8, drift_rad_s: drift[axis] });
        }
    }
}

/// A rest's mean raw rate less what force makes of it.
fn resting_rate<const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    still: &Segment,
    calibration: &Calibration,
) -> Vector3<f32> {
    let (first, end) = (usize::from(still.first), usize::from(still.end));
    let force = calibration.accelerometer.triad.compensate(&mean_force(tape, first, end));
    let felt = calibration.g_sensitivity.map_or(Vector3::zeros(), |felt| felt.matrix * force);
    mean_rate(tape, first, end) - felt
}

/// Numbers that are less sure than a user expects.
fn warn_of_doubt(calibration: &Calibration, bench: &mut Bench) {
    for parameter in calibration.parameters().filter(|parameter| parameter.observable) {
        let limit = match parameter.unit {
            "1" => CORRECTION_SIGMA_LIMIT,
            "m/s^2" => ACCEL_BIAS_SIGMA_LIMIT,
            _ => continue,
        };
        if let Some(sigma) = parameter.sigma.filter(|sigma| *sigma > limit) {
            bench.warn(Reason::Uncertain { name: parameter.name, sigma, limit });
        }
    }
}

fn reject_the_impossible(calibration: &Calibration, bench: &mut Bench) {
    for (index, parameter) in calibration.parameters().enumerate() {
        let (nominal, limit) = match parameter.unit {
            "1" if is_diagonal(index) => (1.0, CORRECTION_LIMIT),
            "1" => (0.0, CORRECTION_LIMIT),
            "m/s^2" => (0.0, ACCEL_BIAS_LIMIT),
            "rad/s" => (0.0, GYRO_BIAS_LIMIT),
            _ => continue,
        };
        if parameter.observable && libm::fabsf(parameter.value - nominal) > limit {
            bench.reject(Reason::OutOfRange { name: parameter.name, value: parameter.value, limit });
        }
    }
}

/// Elements 0, 4, 8 of the nine that follow three biases, twice.
fn is_diagonal(index: usize) -> bool {
    (index % 12).checked_sub(3).is_some_and(|element| element.is_multiple_of(4))
}

/// A scale or an accelerometer that the data do not determine makes a calibration useless; a gyroscope's other elements
/// are then worth a warning.
fn reject_the_undetermined<const R: usize, const S: usize>(
    calibration: &Calibration,
    tape: &Tape<R, S>,
    bench: &mut Bench,
) {
    let (held, turned) = done(tape);
    let [mut faces, mut turns] = [false, false];
    for (index, parameter) in calibration.parameters().enumerate().filter(|(_, parameter)| !parameter.observable) {
        let reason = Reason::NotObservable { name: parameter.name };
        // Where faces or turns are missing, that is the reason, and not what follows from it number by number.
        match index {
            0..12 if held != FaceSet::FULL => faces = true,
            0..12 => bench.reject(reason),
            _ if turned != 0b111 => turns = true,
            _ if is_diagonal(index) => bench.reject(reason),
            _ => bench.warn(reason),
        }
    }
    if turns {
        let hopeless = calibration.gyroscope.observable.iter().enumerate().any(|(axis, row)| !row[axis]);
        let reason = Reason::TurnsMissing { axes: !turned & 0b111 };
        if hopeless { bench.reject(reason) } else { bench.warn(reason) }
    }
    if faces {
        bench.reject(Reason::FacesMissing { missing: held.complement() });
    }
}

/// Faces held still, and axes with a whole turn.
fn done<const R: usize, const S: usize>(tape: &Tape<R, S>) -> (FaceSet, u8) {
    let (mut held, mut turned) = (FaceSet::EMPTY, 0);
    for segment in tape.segments().iter().filter(|segment| segment.exclusion == Exclusion::None) {
        match segment.kind {
            Kind::Still { face: Some(face), .. } => held = held.with(face),
            Kind::OnTable { face, angle_rad } if whole_turns(angle_rad).is_some_and(|turns| turns != 0) => {
                turned |= 1 << Face::axis(face);
            }
            _ => {}
        }
    }
    (held, turned)
}

/// A session with nothing to estimate from: rejected, with what is missing.
pub fn nothing_to_estimate<const R: usize, const S: usize>(tape: &Tape<R, S>) -> Judgement {
    Judgement { verdict: Verdict::Rejected, reasons: missing(tape).into_iter().collect() }
}
