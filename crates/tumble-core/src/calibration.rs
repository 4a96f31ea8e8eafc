//! The result: two triads of errors, how sure each number is, and the verdict, which alone lets it be stored.

use heapless::Vec;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::sample::Sample;

mod parameter;

pub use parameter::Parameter;

/// A three-axis sensor's deterministic errors: `ideal = correction · (raw − bias)`, SI, raw in `s`, ideal in `b`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Triad {
    /// In the sensor's unit (m/s² or rad/s), sensor axes.
    pub bias: Vector3<f32>,
    /// Dimensionless 3×3: scale, non-orthogonality and the rotation `b` from `s`.
    pub correction: Matrix3<f32>,
}

impl Triad {
    /// No error at all.
    pub fn identity() -> Self {
        Self { bias: Vector3::zeros(), correction: Matrix3::identity() }
    }

    /// `correction · (raw − bias)`.
    pub fn compensate(&self, raw: &Vector3<f32>) -> Vector3<f32> {
        self.correction * (raw - self.bias)
    }

    /// What this sensor would say of `ideal`: the exact inverse of [`Self::compensate`], solved and not inverted.
    /// None if `correction` is singular, which no accepted calibration is.
    pub fn distort(&self, ideal: &Vector3<f32>) -> Option<Vector3<f32>> {
        self.correction.lu().solve(ideal).map(|raw| raw + self.bias)
    }
}

/// A triad with its one-sigma uncertainties.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriadEstimate {
    /// The numbers.
    pub triad: Triad,
    /// One sigma of `triad.bias`.
    pub bias_sigma: Vector3<f32>,
    /// One sigma of `triad.correction`, element by element.
    pub correction_sigma: Matrix3<f32>,
    /// False where the data do not determine the element; its number is then the prior's, to be shown to nobody.
    pub observable: [[bool; 3]; 3],
}

/// How a gyroscope's reading follows the specific force: `ω = M (ω_raw − b − G f)`, f compensated, frame b.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GSensitivity {
    /// G, (rad/s)/(m/s²), row the gyroscope's axis.
    pub matrix: Matrix3<f32>,
    /// One sigma, element by element.
    pub sigma: Matrix3<f32>,
}

/// The axes `b` that compensated data are given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Frame {
    /// The box's face normals, taken as square.
    Box,
    /// x along the accelerometer's x axis, y in its x–y plane: the accelerometer's correction is lower-triangular.
    Accelerometer,
}

/// How well the model explains the session.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Normalised innovation squared per degree of freedom, 1 when the noise is what it is assumed to be.
    pub nis_per_dof: f32,
    /// Root mean square of |compensated specific force| − g over the stills, m/s².
    pub gravity_rms_mps2: f32,
    /// The largest such, m/s².
    pub gravity_max_mps2: f32,
    /// Root mean square of a turn's heading against whole revolutions, rad.
    pub turn_closure_rms_rad: f32,
}

/// Everything estimated in one session.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// m/s².
    pub accelerometer: TriadEstimate,
    /// rad/s.
    pub gyroscope: TriadEstimate,
    /// Where the gyroscope certainly feels force.
    pub g_sensitivity: Option<GSensitivity>,
    /// Axes of the compensated data.
    pub frame: Frame,
    /// Mean die temperature of the session, °C.
    pub temperature_degc: f32,
    /// Residuals.
    pub fit: Fit,
}

impl GSensitivity {
    /// Adds what a bias that walks makes of it, `walked` being its variance over the session by g²: about its own straight line a
    /// walk has a fifteenth of that, and an element is half the difference of two opposite faces.
    pub(crate) fn widen(&mut self, walked: f32) {
        self.sigma = self.sigma.map(|sigma| libm::sqrtf(sigma * sigma + walked / 30.0));
    }
}

impl Calibration {
    /// A raw sample compensated: `f = A (f_raw − a)`, `ω = M (ω_raw − b − G f)`.
    pub fn compensate(&self, raw: &Sample) -> Sample {
        let specific_force_mps2 = self.accelerometer.triad.compensate(&raw.specific_force_mps2);
        let felt = self.g_sensitivity.map_or(Vector3::zeros(), |felt| felt.matrix * specific_force_mps2);
        let angular_rate_rad_s = self.gyroscope.triad.compensate(&(raw.angular_rate_rad_s - felt));
        Sample { angular_rate_rad_s, specific_force_mps2, ..*raw }
    }
}

/// What the judge says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Verdict {
    /// Good.
    Accepted,
    /// Usable; the reasons say what to know.
    AcceptedWithWarnings,
    /// Not to be used.
    Rejected,
}

/// Why a calibration is rejected, or accepted with warnings. Each names the thing, by how much, and has a remedy in
/// [`crate::message`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// Too few faces held still.
    FacesMissing {
        /// Which.
        missing: crate::face::FaceSet,
    },
    /// No full turn about these axes (bits 0, 1, 2 for x, y, z).
    TurnsMissing {
        /// Which.
        axes: u8,
    },
    /// A reading stood at the end of its range during a move that matters.
    Clipped {
        /// 0–2 gyroscope x–z, 3–5 accelerometer x–z.
        channel: u8,
        /// How many samples.
        samples: u32,
    },
    /// A parameter lies outside what any healthy sensor of this kind has.
    OutOfRange {
        /// Name as in `docs/protocol.md`.
        name: &'static str,
        /// Its value.
        value: f32,
        /// The bound.
        limit: f32,
    },
    /// The residuals are larger than the noise by this factor (squared, per degree of freedom).
    PoorFit {
        /// Normalised innovation squared per degree of freedom.
        nis_per_dof: f32,
    },
    /// The estimate had not come to rest when its time was up.
    Unsettled {
        /// The most that a parameter moved by in the last pass, sigmas.
        sigmas: f32,
    },
    /// A parameter is not determined by this session.
    NotObservable {
        /// Name as in `docs/protocol.md`.
        name: &'static str,
    },
    /// A parameter is determined too loosely to be of use.
    Uncertain {
        /// Name.
        name: &'static str,
        /// Its sigma.
        sigma: f32,
        /// The bound.
        limit: f32,
    },
    /// A bias moved between the first and last still.
    BiasDrift {
        /// 0–2.
        axis: u8,
        /// rad/s.
        drift_rad_s: f32,
    },
    /// The gyroscope's bias jumped within the session.
    BiasJump {
        /// 0–2, where it jumped most.
        axis: u8,
        /// rad/s.
        jump_rad_s: f32,
    },
    /// The box was called square, and its faces are not.
    CrookedBox {
        /// How far a face is from square, one sigma over the faces, rad.
        facet_rad: f32,
    },
    /// The box leaned differently from rest to rest on one face.
    LooseContact {
        /// By how much, one sigma, rad.
        lean_rad: f32,
    },
    /// A segment was left out because it does not fit the rest.
    SegmentExcluded {
        /// Index as in the segment list.
        segment: u16,
        /// Its normalised innovation squared per degree of freedom.
        nis_per_dof: f32,
    },
    /// Some samples never came or were unreadable.
    SamplesLost {
        /// How many.
        samples: u32,
    },
    /// The arithmetic broke down (not a number, or a matrix that should be positive definite is not).
    Arithmetic {
        /// Where.
        place: &'static str,
    },
}

/// The verdict with its reasons.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// In one word.
    pub verdict: Verdict,
    /// The most important first; at most eight are kept.
    pub reasons: Vec<Reason, 8>,
}

/// A calibration that was judged fit for use: the only kind [`crate::record`] can store. Made by the judge alone, or
/// read back from a record, whose bytes it once passed through the judge to become.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceptedCalibration(Calibration);

impl AcceptedCalibration {
    pub(crate) fn new(calibration: Calibration) -> Self {
        Self(calibration)
    }

    /// The numbers.
    pub fn calibration(&self) -> &Calibration {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distort_undoes_compensate() {
        let triad = Triad {
            bias: Vector3::new(0.1, -0.2, 0.3),
            correction: Matrix3::new(1.01, 0.02, -0.01, 0.005, 0.98, 0.015, -0.02, 0.01, 1.03),
        };
        let raw = Vector3::new(1.0, -2.0, 9.5);
        let back = triad.distort(&triad.compensate(&raw)).expect("not singular");
        assert!((back - raw).norm() < 2e-6 * raw.norm(), "{back} {raw}");
        assert!(Triad { correction: Matrix3::zeros(), ..triad }.distort(&raw).is_none());
    }
}
