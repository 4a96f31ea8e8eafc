//! One simulated session: the estimate, the truth in the same frame, and the bound.

use nalgebra::{Matrix3, SMatrix, SVector};
use thiserror::Error;
use tumble_core::calibration::{Calibration, Verdict};
use tumble_core::estimate::two_step::Variant;
use tumble_core::estimate::{Conditions, PARAMETERS};
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_core::sample::Sample;
use tumble_sim::motion::Stops;
use tumble_sim::sensor::FrameTruth;
use tumble_sim::{SchemeConfig, SimError};

use super::bound::{Knowledge, bound_knowing};
use super::truth::matrix;
use crate::calibrate::{Method, Session};
use crate::recording::Reading;

/// A lever measured to 10 µm is known.
const KNOWN_LEVER_M: f64 = 1e-5;

/// The 24 parameters.
pub type Parameters = SVector<f64, PARAMETERS>;

/// A session that could not be studied.
#[derive(Debug, Error)]
pub enum TrialError {
    /// The simulation refused its settings.
    #[error(transparent)]
    Simulation(#[from] SimError),
    /// The estimator gave no numbers.
    #[error("seed {seed}: no estimate: {reason}")]
    NoEstimate {
        /// Of the session.
        seed: u64,
        /// The judge's first.
        reason: String,
    },
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Estimate less truth.
    pub error: Parameters,
    /// The estimator's own.
    pub covariance: SMatrix<f64, PARAMETERS, PARAMETERS>,
    /// Sigmas that no estimator can undercut; zero for what the frame fixes.
    pub bound: Parameters,
    /// The same for one who knows the lever arm.
    pub bound_lever_known: Parameters,
    /// The same for one who does not know that a box turns about its face's normal.
    pub bound_axis_free: Parameters,
    /// What other estimators erred by, each against the truth in its own frame.
    pub others: Vec<(&'static str, Parameters)>,
    /// The estimate.
    pub calibration: Calibration,
    /// By the paper's two-step method, corrected; where a square box gives its frame.
    pub two_step: Option<Calibration>,
    /// Was it accepted?
    pub accepted: bool,
    /// The truth in the estimate's frame.
    pub truth: FrameTruth,
    /// `R_f_from_b`: of the estimate's frame.
    pub rotation_f_from_b: Matrix3<f64>,
}

impl Trial {
    /// Simulates, estimates as the device does, and compares.
    ///
    /// # Errors
    /// If there are no numbers to compare.
    pub fn run(config: &SchemeConfig, faces: BoxFaces) -> Result<Self, TrialError> {
        Self::run_with(config, faces, false)
    }

    /// The same; `references` adds gravity and batch to [`Self::others`].
    ///
    /// # Errors
    /// If there are no numbers to compare.
    pub fn run_with(config: &SchemeConfig, faces: BoxFaces, references: bool) -> Result<Self, TrialError> {
        let recording = config.record()?;
        let readings = readings(&recording.samples);
        let conditions = Conditions { stops: stops(config), faces, gravity_mps2: config.world.gravity_mps2 as f32 };
        let session = Session { readings: &readings, origin_s: 0.0, lost: 0, conditions };
        let outcome = session.replay(&mut |_| {});
        let two_step = match faces {
            BoxFaces::Square => session.run(Method::TwoStep(Variant::Corrected), &mut |_| {}).calibration,
            BoxFaces::Unknown => None,
        };
        let (Some(calibration), Some(covariance)) = (outcome.calibration, outcome.covariance) else {
            let reason = outcome.reasons.into_iter().next().unwrap_or_default();
            return Err(TrialError::NoEstimate { seed: config.world.seed, reason });
        };
        let usual = Knowledge::default();
        let [bound, bound_lever_known, bound_axis_free] =
            [usual, Knowledge { lever_sigma_m: KNOWN_LEVER_M, ..usual }, Knowledge { axis: false, ..usual }].map(
                |knowledge| {
                    let variances = bound_knowing(config, &recording, faces, knowledge).diagonal();
                    variances.map(|variance| variance.max(0.0).sqrt())
                },
            );
        let truth = recording.truth;
        let others = others(&session, &truth, two_step.as_ref(), references);
        let (truth, rotation_f_from_b) = match faces {
            BoxFaces::Square => (truth.in_box, Matrix3::identity()),
            BoxFaces::Unknown => (truth.in_accelerometer_frame, matrix(&truth.rotation_accelerometer_from_box)),
        };
        Ok(Self {
            error: estimated(&calibration) - true_parameters(&truth),
            covariance: covariance.cast(),
            bound,
            bound_lever_known,
            bound_axis_free,
            others,
            calibration,
            two_step,
            accepted: outcome.verdict != Verdict::Rejected,
            truth,
            rotation_f_from_b,
        })
    }
}

/// Errors of the other estimators.
fn others(
    session: &Session,
    truth: &tumble_sim::sensor::Truth,
    two_step: Option<&Calibration>,
    references: bool,
) -> Vec<(&'static str, Parameters)> {
    let own = if session.conditions.faces == BoxFaces::Square { &truth.in_box } else { &truth.in_accelerometer_frame };
    let methods = [("batch", Method::Batch, own), ("gravity", Method::Gravity, &truth.in_accelerometer_frame)];
    let found = methods.into_iter().filter(|_| references).filter_map(|(name, method, truth)| {
        let calibration = session.run(method, &mut |_| {}).calibration?;
        Some((name, estimated(&calibration) - true_parameters(truth)))
    });
    let two_step = two_step.map(|found| ("two-step", estimated(found) - true_parameters(&truth.in_box)));
    found.chain(two_step).collect()
}

/// Simulated samples as the core takes them.
pub fn readings(samples: &[tumble_sim::Sample]) -> Vec<Reading> {
    let reading = |sample: &tumble_sim::Sample| Sample {
        t_us: (sample.t_s * 1e6).round() as u64,
        angular_rate_rad_s: sample.angular_rate_rad_s.cast(),
        specific_force_mps2: sample.specific_force_mps2.cast(),
        temperature_degc: sample.temperature_degc as f32,
    };
    samples.iter().map(|sample| Reading { sample: reading(sample), clipped: 0 }).collect()
}

fn stops(config: &SchemeConfig) -> TurnStops {
    match config.world.motion.hands.stops {
        Stops::ByHand { .. } => TurnStops::ByHand,
        Stops::Exact | Stops::Fenced { .. } => TurnStops::Fenced,
    }
}

/// In the order of [`PARAMETERS`].
pub fn true_parameters(truth: &FrameTruth) -> Parameters {
    let (accel, gyro) = (&truth.accelerometer, &truth.gyroscope);
    let accel = accel.bias_mps2.iter().chain(accel.correction.iter().flatten());
    let gyro = gyro.bias_rad_s.iter().chain(gyro.correction.iter().flatten());
    Parameters::from_iterator(accel.chain(gyro).copied())
}

/// Likewise.
pub fn estimated(calibration: &Calibration) -> Parameters {
    Parameters::from_iterator(calibration.parameters().take(PARAMETERS).map(|parameter| f64::from(parameter.value)))
}
