//! Is the calibration in force right? Checked on fresh poses, against what its own sigmas promise.
//!
//! Two questions, neither of which the calibration was fitted to: is the specific force at rest one gravity long, and does
//! the gyroscope, moved by hand from one rest to the next, carry the direction of gravity to where the accelerometer then
//! finds it? [`limits`] derives how far off a true calibration may be.

pub mod limits;
pub mod propagate;
#[cfg(test)]
mod tests;

use heapless::Vec;
use nalgebra::Vector3;

use crate::STANDARD_GRAVITY_MPS2;
use crate::calibration::Calibration;
use crate::motion::MotionEvent;
use crate::sample::Sample;
use limits::Limits;
use propagate::Propagation;

/// How many fresh poses a check takes.
pub const POSES: u8 = 6;

/// How long a pose has to rest, s: 300 µg/√Hz (sheet) averages to 150 µg, at the level of the sensor's own instability.
pub const POSE_S: f32 = 2.0;

/// A pose nearer to an earlier one than this, 20°, tells nothing new.
const FRESH_COS: f32 = crate::face::Face::CONE_COS;

/// Away from the calibration's temperature by more than this, °C, temperature is the first suspect: at the sheet's
/// ±1.5 mg/°C it moves the accelerometer by 7.5 mg.
const TEMPERATURE_SUSPECT_DEGC: f32 = 5.0;

/// One pose, judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseCheck {
    /// Counts fresh poses from 1.
    pub number: u8,
    /// False if it repeats an earlier pose of this check: it does not count, and the rest says nothing.
    pub fresh: bool,
    /// |mean compensated specific force| − standard gravity, m/s².
    pub gravity_error_mps2: f32,
    /// The largest that a true calibration shows, m/s².
    pub gravity_limit_mps2: f32,
    /// Angle between gravity as the gyroscope carried it here and as the accelerometer finds it, rad; none for the first pose
    /// and where samples were lost on the way.
    pub level_error_rad: Option<f32>,
    /// The largest that a true calibration shows after this move, rad.
    pub level_limit_rad: f32,
}

impl PoseCheck {
    /// Within both limits? What is not a number is not.
    pub fn ok(&self) -> bool {
        self.gravity_error_mps2.abs() <= self.gravity_limit_mps2
            && self.level_error_rad.is_none_or(|error| error <= self.level_limit_rad)
    }
}

/// The verdict over all poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verification {
    /// Every pose within its limits?
    pub pass: bool,
    /// How many.
    pub poses: u8,
    /// Root mean square of the gravity errors, m/s².
    pub gravity_rms_mps2: f32,
    /// Largest level error, rad.
    pub level_max_rad: f32,
    /// Mean die temperature now, less that of the calibration, °C; none where the source has none.
    pub temperature_change_degc: Option<f32>,
}

impl Verification {
    /// Is it so much warmer or colder than at the calibration that this alone may explain a failure?
    pub fn is_temperature_suspect(&self) -> bool {
        self.temperature_change_degc.is_some_and(|change| change.abs() > TEMPERATURE_SUSPECT_DEGC)
    }
}

/// The mean of specific force over a rest, in blocks from one [`MotionEvent::StillHeld`] to the next: the block in which the
/// rest ended holds the beginning of a motion and is never counted. Sums are of deviations from the first sample, which
/// keeps `f32` exact enough however long it rests.
#[derive(Clone, Debug, Default)]
struct Rest {
    origin: Option<Vector3<f32>>,
    counted: Vector3<f32>,
    counted_n: f32,
    counted_s: f32,
    block: Vector3<f32>,
    block_n: f32,
    block_s: f32,
}

impl Rest {
    fn add(&mut self, force: &Vector3<f32>, dt_s: f32) {
        let origin = self.origin.get_or_insert(*force);
        self.block += force - *origin;
        self.block_n += 1.0;
        self.block_s += dt_s;
    }

    fn count_block(&mut self) {
        self.counted += self.block;
        self.counted_n += self.block_n;
        self.counted_s += self.block_s;
        (self.block, self.block_n, self.block_s) = (Vector3::zeros(), 0.0, 0.0);
    }

    fn mean(&self) -> Option<Vector3<f32>> {
        self.origin.filter(|_| self.counted_n > 0.0).map(|origin| origin + self.counted / self.counted_n)
    }
}

/// A check in progress. Give it every compensated sample and every motion event, in order.
#[derive(Clone, Debug)]
pub struct Verifier {
    limits: Limits,
    calibration_degc: f32,
    rest: Option<Rest>,
    judged: bool,
    propagation: Propagation,
    poses: Vec<Vector3<f32>, { POSES as usize }>,
    pass: bool,
    gravity_square_sum: f32,
    level_max_rad: f32,
    temperature_sum_degc: f32,
    temperature_n: f32,
}

impl Verifier {
    /// A fresh check of `calibration`.
    pub fn new(calibration: &Calibration) -> Self {
        Self {
            limits: Limits::new(calibration),
            calibration_degc: calibration.temperature_degc,
            rest: None,
            judged: false,
            propagation: Propagation::default(),
            poses: Vec::new(),
            pass: true,
            gravity_square_sum: 0.0,
            level_max_rad: 0.0,
            temperature_sum_degc: 0.0,
            temperature_n: 0.0,
        }
    }

    /// Takes a sample compensated by the calibration under check.
    pub fn sample(&mut self, sample: &Sample) {
        let dt_s = self.propagation.step(sample);
        if let Some(rest) = &mut self.rest {
            rest.add(&sample.specific_force_mps2, dt_s);
        }
        if sample.temperature_degc.is_finite() {
            self.temperature_sum_degc += sample.temperature_degc - self.calibration_degc;
            self.temperature_n += 1.0;
        }
    }

    /// Takes a motion event; says so when it completes a pose.
    pub fn event(&mut self, event: &MotionEvent) -> Option<PoseCheck> {
        match event {
            MotionEvent::StillBegan { .. } => {
                self.rest = Some(Rest::default());
                self.judged = false;
                None
            }
            MotionEvent::StillHeld { .. } => self.held(),
            MotionEvent::StillEnded { .. } => {
                self.rest = None;
                None
            }
            _ => None,
        }
    }

    /// The verdict, once there are [`POSES`] poses.
    pub fn verdict(&self) -> Option<Verification> {
        let poses = u8::try_from(self.poses.len()).ok().filter(|poses| *poses >= POSES)?;
        let change = self.temperature_sum_degc / self.temperature_n;
        Some(Verification {
            pass: self.pass,
            poses,
            gravity_rms_mps2: libm::sqrtf(self.gravity_square_sum / f32::from(poses)),
            level_max_rad: self.level_max_rad,
            temperature_change_degc: Some(change).filter(|change| change.is_finite()),
        })
    }

    fn held(&mut self) -> Option<PoseCheck> {
        let rest = self.rest.get_or_insert_default();
        rest.count_block();
        let (mean, rest_s) = (rest.mean()?, rest.counted_s);
        // Block lengths are those of samples: 2 s may come out a sample short.
        if rest_s < POSE_S - 0.05 {
            return None;
        }
        let up = mean / mean.norm();
        let check = (!self.judged).then(|| self.judge(&mean, &up, rest_s));
        self.judged = true;
        self.propagation.restart(up, self.limits.tilt_variance(&up, rest_s));
        check
    }

    fn judge(&mut self, mean: &Vector3<f32>, up: &Vector3<f32>, rest_s: f32) -> PoseCheck {
        let limits = &self.limits;
        let tilt_variance = limits.tilt_variance(up, rest_s);
        let check = PoseCheck {
            number: u8::try_from(self.poses.len() + 1).unwrap_or(u8::MAX),
            fresh: self.poses.iter().all(|earlier| earlier.dot(up) < FRESH_COS) && !self.poses.is_full(),
            gravity_error_mps2: mean.norm() - STANDARD_GRAVITY_MPS2,
            gravity_limit_mps2: limits.gravity(up, rest_s),
            level_error_rad: self.propagation.angle_to(up),
            level_limit_rad: limits.level(&self.propagation, tilt_variance),
        };
        if check.fresh {
            let _ = self.poses.push(*up);
            self.pass &= check.ok();
            self.gravity_square_sum += check.gravity_error_mps2 * check.gravity_error_mps2;
            self.level_max_rad = self.level_max_rad.max(check.level_error_rad.unwrap_or(0.0));
        }
        check
    }
}
