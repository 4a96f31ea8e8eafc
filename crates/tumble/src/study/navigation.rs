//! Pure inertial navigation over violent tumbling: what a calibration is worth to the one who uses it.
//!
//! The attitude begins level by the accelerometer's mean over the rest before, with the true heading, and is carried by the
//! compensated gyroscope alone; the Earth's rate is known. The level error is the angle between the estimated and the true
//! upward direction in the sensor's frame, which heading errors do not enter.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use tumble_core::calibration::{Calibration, Triad};
use tumble_sim::{Recording, Scheme, SchemeConfig, SimError};

use super::trial::Trial;
use super::truth::matrix;
use crate::integrate::rotation;

/// Length of the tumbling, s: the paper's.
pub const TUMBLE_S: f64 = 65.0;
/// Seeds of the tumbling lie apart from those of the sessions, whose noise it must not repeat.
const SEED_OFFSET: u64 = 1 << 32;

/// Level errors of one run, degrees.
#[derive(Clone, Copy, Debug)]
pub struct LevelError {
    /// After [`TUMBLE_S`].
    pub end_deg: f64,
    /// The largest on the way.
    pub max_deg: f64,
}

/// `ideal = correction · (raw − bias)`, `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Correction {
    /// SI.
    pub bias: Vector3<f64>,
    /// 1.
    pub matrix: Matrix3<f64>,
}

impl Correction {
    /// Compensates.
    pub fn apply(&self, raw: &Vector3<f64>) -> Vector3<f64> {
        self.matrix * (raw - self.bias)
    }
}

impl From<&Triad> for Correction {
    fn from(triad: &Triad) -> Self {
        Self { bias: triad.bias.cast(), matrix: triad.correction.cast() }
    }
}

/// Both triads, and the frame that they lead to.
#[derive(Clone, Copy, Debug)]
pub struct Compensation {
    /// rad/s.
    pub gyro: Correction,
    /// m/s².
    pub accel: Correction,
    /// `R_f_from_b`.
    pub rotation_f_from_b: Matrix3<f64>,
}

impl Compensation {
    /// What was estimated.
    pub fn estimated(trial: &Trial) -> Self {
        Self::of(&trial.calibration, trial.rotation_f_from_b)
    }

    /// A calibration and where its frame stands in the box.
    pub fn of(calibration: &Calibration, rotation_f_from_b: Matrix3<f64>) -> Self {
        Self {
            gyro: (&calibration.gyroscope.triad).into(),
            accel: (&calibration.accelerometer.triad).into(),
            rotation_f_from_b,
        }
    }

    /// The truth: noise alone remains.
    pub fn perfect(trial: &Trial) -> Self {
        let (gyro, accel) = (&trial.truth.gyroscope, &trial.truth.accelerometer);
        Self {
            gyro: Correction { bias: gyro.bias_rad_s.into(), matrix: matrix(&gyro.correction) },
            accel: Correction { bias: accel.bias_mps2.into(), matrix: matrix(&accel.correction) },
            rotation_f_from_b: trial.rotation_f_from_b,
        }
    }

    /// A gyroscope of which only the bias is known; the accelerometer as [`Self::perfect`], so that the start is level.
    pub fn bias_alone(trial: &Trial) -> Self {
        let perfect = Self::perfect(trial);
        let gyro = Correction { matrix: perfect.rotation_f_from_b, ..perfect.gyro };
        Self { gyro, ..perfect }
    }
}

/// The tumbling of a session's own sensor.
///
/// # Errors
/// If the simulation refuses its settings.
pub fn tumbling(session: &SchemeConfig) -> Result<Recording, SimError> {
    let scheme = Scheme::Tumble { duration_s: TUMBLE_S, violence: 1.0 };
    let mut config = SchemeConfig::new(scheme, session.world.seed + SEED_OFFSET);
    config.world.sensor = session.world.sensor.clone();
    config.record()
}

/// Navigates over it.
pub fn level_error(recording: &Recording, compensation: &Compensation) -> LevelError {
    let levels = level_errors(recording, compensation);
    LevelError {
        end_deg: levels.last().map_or(0.0, |level| level.1),
        max_deg: levels.iter().fold(0.0, |most, level| most.max(level.1)),
    }
}

/// Time since the tumbling began (s) and level error then (degrees), sample by sample.
pub fn level_errors(recording: &Recording, compensation: &Compensation) -> Vec<(f64, f64)> {
    let (start_s, end_s) = tumbled(recording);
    let true_up = |t_s: f64| {
        compensation.rotation_f_from_b * recording.world.true_attitude(t_s).inverse_transform_vector(&Vector3::z())
    };
    let earth = recording.world.earth_rate_n();
    let mut attitude = start(recording, compensation, start_s);
    let mut levels = Vec::new();
    for pair in recording.samples.windows(2).filter(|pair| pair[0].t_s >= start_s && pair[1].t_s <= end_s) {
        let dt = pair[1].t_s - pair[0].t_s;
        let [a, b] = [0, 1].map(|i| compensation.gyro.apply(&pair[i].angular_rate_rad_s));
        let earth = UnitQuaternion::from_scaled_axis(earth * -dt);
        attitude =
            UnitQuaternion::new_normalize((earth * attitude * rotation(&a, &b, &Vector3::zeros(), dt)).into_inner());
        let up = attitude.inverse_transform_vector(&Vector3::z());
        let truth = true_up(pair[1].t_s);
        levels.push((pair[1].t_s - start_s, up.cross(&truth).norm().atan2(up.dot(&truth)).to_degrees()));
    }
    levels
}

/// When it is tumbled, s.
fn tumbled(recording: &Recording) -> (f64, f64) {
    use tumble_sim::motion::Kind;
    let segments = recording.world.motion.segments();
    let tumble = segments.iter().find(|segment| segment.kind() == Kind::Tumble);
    tumble.map_or((0.0, 0.0), |segment| (segment.start_s, segment.end_s()))
}

/// Level by the rest before `start_s`, heading as it is.
fn start(recording: &Recording, compensation: &Compensation, start_s: f64) -> UnitQuaternion<f64> {
    let rotation_b_from_f = compensation.rotation_f_from_b.transpose();
    let truth = recording.world.true_attitude(start_s)
        * UnitQuaternion::from_matrix_eps(&rotation_b_from_f, 1e-12, 100, UnitQuaternion::identity());
    let rest = recording.samples.iter().filter(|sample| sample.t_s < start_s);
    let force: Vector3<f64> = rest.map(|sample| compensation.accel.apply(&sample.specific_force_mps2)).sum();
    let level = UnitQuaternion::rotation_between(&(truth * force), &Vector3::z());
    level.unwrap_or_default() * truth
}
