//! The object that `tumble calibrate --json` prints, field for field as in the contract.

use serde::{Deserialize, Serialize};
use tumble_core::calibration::{Calibration, Frame, TriadEstimate, Verdict};
use tumble_core::{DEGREE_RAD, STANDARD_GRAVITY_MPS2};

use crate::calibrate::Outcome;
use crate::diagnose::carry::{Carried, g_sensitivity};

/// x, y, z.
pub type Vector = [f32; 3];
/// Row by row; an element that the recording does not determine is null, never the prior's number.
pub type Matrix = [[Option<f32>; 3]; 3];

/// The whole object. A rejected calibration carries no numbers that could be used by mistake.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// `tumble-calibration`.
    pub format: String,
    /// 1.
    pub version: u32,
    /// `accepted`, `accepted_with_warnings` or `rejected`.
    pub verdict: String,
    /// One sentence each, the most important first.
    pub reasons: Vec<String>,
    /// How to apply the numbers.
    pub model: String,
    /// `box` or `accelerometer`; null when rejected.
    pub frame: Option<String>,
    /// m/s².
    pub accelerometer: Option<TriadReport>,
    /// rad/s.
    pub gyroscope: Option<GyroscopeReport>,
    /// Of all 24 numbers.
    pub covariance: Option<Covariance>,
    /// What was found in the recording, in order of time.
    pub segments: Vec<SegmentReport>,
    /// Residuals; null when there was nothing to fit.
    pub fit: Option<FitReport>,
    /// Mean die temperature of the session, °C; null where the recording has none.
    pub temperature_degc: Option<f32>,
    /// Effects that the calibration carries besides, to be taken off the raw readings first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub with: Vec<Carried>,
}

impl Report {
    /// The same with effects that were taken out of the readings before; a rejected calibration gets none.
    #[must_use]
    pub fn carrying(mut self, carried: Vec<Carried>) -> Self {
        if let Some(gyroscope) = &mut self.gyroscope {
            if let Some([felt, sigma]) = g_sensitivity(&carried) {
                gyroscope.g_sensitivity_rad_s_per_mps2 = Some(felt);
                gyroscope.g_sensitivity_sigma_rad_s_per_mps2 = Some(sigma);
            }
            self.with = carried;
        }
        self
    }
}

/// The accelerometer's numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriadReport {
    /// Bias.
    pub bias_mps2: Vector,
    /// Its one sigma.
    pub bias_sigma_mps2: Vector,
    /// Raw to ideal, SI.
    pub correction: Matrix,
    /// Its one sigma.
    pub correction_sigma: Matrix,
    /// What the recording determines.
    pub observable: [[bool; 3]; 3],
}

/// The gyroscope's numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GyroscopeReport {
    /// Bias.
    pub bias_rad_s: Vector,
    /// Its one sigma.
    pub bias_sigma_rad_s: Vector,
    /// Raw to ideal, SI.
    pub correction: Matrix,
    /// Its one sigma.
    pub correction_sigma: Matrix,
    /// What the recording determines.
    pub observable: [[bool; 3]; 3],
    /// `ideal = correction · (raw − bias − this · compensated force)`, where the recording certainly shows it, else null.
    pub g_sensitivity_rad_s_per_mps2: Option<[[f32; 3]; 3]>,
    /// Its one sigma; with `--with gyro_g_sensitivity` it stands in `with`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub g_sensitivity_sigma_rad_s_per_mps2: Option<[[f32; 3]; 3]>,
}

/// Covariance with the names of its rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Covariance {
    /// Names as in `docs/protocol.md`.
    pub order: Vec<String>,
    /// Row by row, SI.
    pub matrix: Vec<Vec<f32>>,
}

/// One thing the person did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SegmentReport {
    /// `still`, `turn` or `move`.
    pub kind: String,
    /// By the recording's own stamps.
    pub start_s: f64,
    /// By the recording's own stamps.
    pub end_s: f64,
    /// The axis that points up, or `other`.
    pub face: String,
    /// Heading change of a turn by the raw gyroscope, counter-clockwise from above; 0 for stills and moves.
    pub angle_deg: f32,
    /// Did it enter the estimate?
    pub used: bool,
    /// If not, why.
    pub why: String,
}

/// Residuals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitReport {
    /// 1 when the noise is what it is assumed to be.
    pub nis_per_dof: f32,
    /// |compensated specific force| − g over the stills.
    pub gravity_rms_mg: f32,
    /// The largest such.
    pub gravity_max_mg: f32,
    /// TurnStops against whole revolutions.
    pub turn_closure_rms_deg: f32,
}

impl Report {
    /// What a session came to.
    pub fn of(outcome: &Outcome) -> Self {
        let verdict = outcome.verdict;
        let usable = outcome.calibration.as_ref().filter(|_| verdict != Verdict::Rejected);
        Self {
            verdict: verdict_name(verdict).into(),
            reasons: outcome.reasons.clone(),
            frame: usable.map(|c| frame_name(c.frame).into()),
            accelerometer: usable.map(|c| triad(&c.accelerometer)),
            gyroscope: usable.map(gyroscope),
            covariance: usable.and(outcome.covariance.as_ref()).map(|matrix| Covariance {
                order: covariance_order(),
                matrix: matrix.row_iter().map(|row| row.iter().copied().collect()).collect(),
            }),
            segments: outcome.segments.clone(),
            fit: outcome.calibration.as_ref().and_then(fit),
            temperature_degc: usable.map(|c| c.temperature_degc).filter(|t| t.is_finite()),
            with: Vec::new(),
            ..Self::refused(Vec::new())
        }
    }

    /// For an input that never came to a session.
    pub fn refused(reasons: Vec<String>) -> Self {
        Self {
            format: "tumble-calibration".into(),
            version: 1,
            verdict: verdict_name(Verdict::Rejected).into(),
            reasons,
            model: "ideal = correction * (raw - bias)".into(),
            frame: None,
            accelerometer: None,
            gyroscope: None,
            covariance: None,
            segments: Vec::new(),
            fit: None,
            temperature_degc: None,
            with: Vec::new(),
        }
    }

    /// May its numbers be used?
    pub fn is_accepted(&self) -> bool {
        self.accelerometer.is_some() && self.gyroscope.is_some()
    }
}

fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Accepted => "accepted",
        Verdict::AcceptedWithWarnings => "accepted_with_warnings",
        Verdict::Rejected => "rejected",
    }
}

fn frame_name(frame: Frame) -> &'static str {
    match frame {
        Frame::Box => "box",
        Frame::Accelerometer => "accelerometer",
    }
}

fn triad(estimate: &TriadEstimate) -> TriadReport {
    TriadReport {
        bias_mps2: estimate.triad.bias.into(),
        bias_sigma_mps2: estimate.bias_sigma.into(),
        correction: observed(estimate, &estimate.triad.correction),
        correction_sigma: observed(estimate, &estimate.correction_sigma),
        observable: estimate.observable,
    }
}

fn gyroscope(calibration: &Calibration) -> GyroscopeReport {
    let TriadReport { bias_mps2, bias_sigma_mps2, correction, correction_sigma, observable } =
        triad(&calibration.gyroscope);
    let rows = |matrix: nalgebra::Matrix3<f32>| matrix.transpose().into();
    GyroscopeReport {
        bias_rad_s: bias_mps2,
        bias_sigma_rad_s: bias_sigma_mps2,
        correction,
        correction_sigma,
        observable,
        g_sensitivity_rad_s_per_mps2: calibration.g_sensitivity.map(|felt| rows(felt.matrix)),
        g_sensitivity_sigma_rad_s_per_mps2: calibration.g_sensitivity.map(|felt| rows(felt.sigma)),
    }
}

fn observed(estimate: &TriadEstimate, matrix: &nalgebra::Matrix3<f32>) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| estimate.observable[i][j].then_some(matrix[(i, j)])))
}

/// None when a residual is not a number, which JSON could not say.
fn fit(calibration: &Calibration) -> Option<FitReport> {
    let fit = &calibration.fit;
    let mg = |mps2: f32| mps2 / STANDARD_GRAVITY_MPS2 * 1000.0;
    let report = FitReport {
        nis_per_dof: fit.nis_per_dof,
        gravity_rms_mg: mg(fit.gravity_rms_mps2),
        gravity_max_mg: mg(fit.gravity_max_mps2),
        turn_closure_rms_deg: fit.turn_closure_rms_rad / DEGREE_RAD,
    };
    let all = [report.nis_per_dof, report.gravity_rms_mg, report.gravity_max_mg, report.turn_closure_rms_deg];
    all.iter().all(|v| v.is_finite()).then_some(report)
}

/// Names of the covariance's 24 rows: accelerometer bias and correction, gyroscope bias and correction.
pub fn covariance_order() -> Vec<String> {
    let axes = ["x", "y", "z"];
    let mut names = Vec::with_capacity(24);
    for sensor in ["accel", "gyro"] {
        names.extend(axes.iter().map(|i| format!("{sensor}_bias_{i}")));
        for i in axes {
            names.extend(axes.iter().map(|j| format!("{sensor}_correction_{i}{j}")));
        }
    }
    names
}
