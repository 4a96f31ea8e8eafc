//! The payload of format version 1. It mirrors the types of `calibration.rs` in plain arrays, so that these may change
//! without a stored byte moving. Never edit it: a change is a new version.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::{FirmwareVersion, Origin};
use crate::calibration::{Calibration, Fit, Frame, Triad, TriadEstimate};
use crate::sample::Ranges;
use crate::setup::{BoxFaces, Scheme, Setup, TurnStops};

/// `postcard` writes the fields in this order: `u32` and `u16` as varints, `u8` and `bool` as a byte, `f32` as four bytes
/// little-endian, arrays without a length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Payload {
    generation: u32,
    firmware: [u16; 3],
    whoami: u8,
    gyro_full_scale_dps: f32,
    accel_full_scale_g: f32,
    fenced: bool,
    square: bool,
    single: bool,
    frame_is_box: bool,
    temperature_degc: f32,
    /// `nis_per_dof`, gravity rms and maximum in m/s², turn closure rms in rad.
    fit: [f32; 4],
    accelerometer: TriadV1,
    gyroscope: TriadV1,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct TriadV1 {
    bias: [f32; 3],
    bias_sigma: [f32; 3],
    /// By rows.
    correction: [[f32; 3]; 3],
    correction_sigma: [[f32; 3]; 3],
    observable: [[bool; 3]; 3],
}

impl TriadV1 {
    fn new(estimate: &TriadEstimate) -> Self {
        Self {
            bias: estimate.triad.bias.into(),
            bias_sigma: estimate.bias_sigma.into(),
            correction: rows(&estimate.triad.correction),
            correction_sigma: rows(&estimate.correction_sigma),
            observable: estimate.observable,
        }
    }

    fn unpack(&self) -> TriadEstimate {
        TriadEstimate {
            triad: Triad { bias: Vector3::from(self.bias), correction: matrix(&self.correction) },
            bias_sigma: Vector3::from(self.bias_sigma),
            correction_sigma: matrix(&self.correction_sigma),
            observable: self.observable,
        }
    }
}

/// nalgebra stores by columns.
pub(super) fn rows(m: &Matrix3<f32>) -> [[f32; 3]; 3] {
    m.transpose().into()
}

pub(super) fn matrix(rows: &[[f32; 3]; 3]) -> Matrix3<f32> {
    Matrix3::from(*rows).transpose()
}

impl Payload {
    pub(super) fn new(origin: &Origin, calibration: &Calibration) -> Self {
        let FirmwareVersion { major, minor, patch } = origin.firmware;
        let Fit { nis_per_dof, gravity_rms_mps2, gravity_max_mps2, turn_closure_rms_rad } = calibration.fit;
        Self {
            generation: origin.generation,
            firmware: [major, minor, patch],
            whoami: origin.whoami,
            gyro_full_scale_dps: origin.ranges.gyro_full_scale_dps,
            accel_full_scale_g: origin.ranges.accel_full_scale_g,
            fenced: origin.setup.stops == TurnStops::Fenced,
            square: origin.setup.box_faces == BoxFaces::Square,
            single: origin.setup.scheme == Scheme::Single,
            frame_is_box: calibration.frame == Frame::Box,
            temperature_degc: calibration.temperature_degc,
            fit: [nis_per_dof, gravity_rms_mps2, gravity_max_mps2, turn_closure_rms_rad],
            accelerometer: TriadV1::new(&calibration.accelerometer),
            gyroscope: TriadV1::new(&calibration.gyroscope),
        }
    }

    pub(super) fn unpack(&self) -> (Origin, Calibration) {
        let [major, minor, patch] = self.firmware;
        let [nis_per_dof, gravity_rms_mps2, gravity_max_mps2, turn_closure_rms_rad] = self.fit;
        let setup = Setup {
            stops: if self.fenced { TurnStops::Fenced } else { TurnStops::ByHand },
            box_faces: if self.square { BoxFaces::Square } else { BoxFaces::Unknown },
            scheme: if self.single { Scheme::Single } else { Scheme::Double },
        };
        let origin = Origin {
            generation: self.generation,
            firmware: FirmwareVersion { major, minor, patch },
            whoami: self.whoami,
            ranges: Ranges {
                gyro_full_scale_dps: self.gyro_full_scale_dps,
                accel_full_scale_g: self.accel_full_scale_g,
            },
            setup,
        };
        let calibration = Calibration {
            accelerometer: self.accelerometer.unpack(),
            gyroscope: self.gyroscope.unpack(),
            g_sensitivity: None,
            frame: if self.frame_is_box { Frame::Box } else { Frame::Accelerometer },
            temperature_degc: self.temperature_degc,
            fit: Fit { nis_per_dof, gravity_rms_mps2, gravity_max_mps2, turn_closure_rms_rad },
        };
        (origin, calibration)
    }
}
