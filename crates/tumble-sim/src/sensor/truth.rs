//! The truth in the contract's convention: `ideal = correction · (raw − bias)`, SI, in the box's and in the accelerometer's frame.

use super::config::SensorTruth;
use super::drawn::EffectTruth;
use crate::error::SimError;
use crate::motion::MotionConfig;
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

/// A matrix as JSON: rows of numbers.
type Rows = [[f64; 3]; 3];

/// The accelerometer's true calibration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AccelTruth {
    /// m/s².
    pub bias_mps2: [f64; 3],
    /// `ideal = correction · (raw − bias)`.
    pub correction: Rows,
}

/// The gyro's true calibration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GyroTruth {
    /// rad/s.
    pub bias_rad_s: [f64; 3],
    /// `ideal = correction · (raw − bias − g_sensitivity · force)`.
    pub correction: Rows,
    /// `G` of `raw = … + G · force`, with the force in this frame; absent if there is none.
    pub g_sensitivity_rad_s_per_mps2: Option<Rows>,
}

/// Both triads and the lever arm in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameTruth {
    /// `box` or `accelerometer`.
    pub frame: &'static str,
    /// The accelerometer.
    pub accelerometer: AccelTruth,
    /// The gyro.
    pub gyroscope: GyroTruth,
    /// From the spin axis to the sensor, m.
    pub lever_arm_m: [f64; 3],
}

/// Where and on what it was recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SettingTruth {
    /// Between plate normal and up.
    pub tilt_deg: f64,
    /// Where the normal leans to, counter-clockwise from east.
    pub azimuth_deg: f64,
    /// For each face (`+x -x +y -y +z -z`), what is square to the plate when it is up, in the box frame.
    pub up_normals: Vec<[f64; 3]>,
    /// m/s².
    pub gravity_mps2: f64,
    /// degrees.
    pub latitude_deg: f64,
}

/// The whole truth, as it is written beside a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Truth {
    /// `tumble-truth`.
    pub format: &'static str,
    /// 1.
    pub version: u32,
    /// The contract's model.
    pub model: &'static str,
    /// What it was drawn from.
    pub seed: u64,
    /// In the box frame; its fields stand at the top, as in a calibration.
    #[serde(flatten)]
    pub in_box: FrameTruth,
    /// The same in the accelerometer's frame.
    pub in_accelerometer_frame: FrameTruth,
    /// `R_a_from_b`.
    pub rotation_accelerometer_from_box: Rows,
    /// Table, box and place.
    pub setting: SettingTruth,
    /// What was added to the nominal world. The parameters above are those without it, but for what it set itself.
    pub effects: Vec<EffectTruth>,
}

impl Truth {
    /// The truth of a sensor in a setting.
    ///
    /// # Errors
    /// If a triad's axes do not span space.
    pub fn new(
        sensor: &SensorTruth,
        motion: &MotionConfig,
        gravity_mps2: f64,
        latitude_deg: f64,
        seed: u64,
    ) -> Result<Self, SimError> {
        let rotation_a_from_b = sensor.accel.own_frame()?;
        let lever = &motion.shape.lever_b_m;
        Ok(Self {
            format: "tumble-truth",
            version: 1,
            model: "ideal = correction * (raw - bias)",
            seed,
            in_box: FrameTruth::rotated("box", sensor, lever, &Matrix3::identity())?,
            in_accelerometer_frame: FrameTruth::rotated("accelerometer", sensor, lever, &rotation_a_from_b)?,
            rotation_accelerometer_from_box: rows(&rotation_a_from_b),
            setting: SettingTruth {
                tilt_deg: motion.table.tilt_deg,
                azimuth_deg: motion.table.azimuth_deg,
                up_normals: motion.shape.up_normals_b.iter().map(|normal| (*normal).into()).collect(),
                gravity_mps2,
                latitude_deg,
            },
            effects: Vec::new(),
        })
    }
}

impl FrameTruth {
    /// The truth in a frame `f` with `R_f_from_b`: corrections become `R·C`, `G` becomes `G·Rᵀ`, biases are of the raw
    /// axes and stay.
    fn rotated(
        frame: &'static str,
        sensor: &SensorTruth,
        lever_b_m: &Vector3<f64>,
        rotation: &Matrix3<f64>,
    ) -> Result<Self, SimError> {
        let g_sensitivity = sensor.gyro_g_sensitivity * rotation.transpose();
        let mut accel = rotation * sensor.accel.correction()?;
        if frame == "accelerometer" {
            // Zero by construction up to rounding: say so exactly.
            accel.fill_upper_triangle(0.0, 1);
        }
        Ok(Self {
            frame,
            accelerometer: AccelTruth { bias_mps2: sensor.accel.bias.into(), correction: rows(&accel) },
            gyroscope: GyroTruth {
                bias_rad_s: sensor.gyro.bias.into(),
                correction: rows(&(rotation * sensor.gyro.correction()?)),
                g_sensitivity_rad_s_per_mps2: (g_sensitivity.norm() > 0.0).then(|| rows(&g_sensitivity)),
            },
            lever_arm_m: (rotation * lever_b_m).into(),
        })
    }
}

/// A matrix by rows.
fn rows(matrix: &Matrix3<f64>) -> Rows {
    core::array::from_fn(|i| core::array::from_fn(|j| matrix[(i, j)]))
}
