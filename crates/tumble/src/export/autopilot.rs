//! Autopilots, which know a bias and, for the accelerometer, a scale an axis: `(raw − offset)·scale`.
//!
//! Each hands an MPU-9250's readings on in axes of its own before it applies the offsets:
//!
//! - PX4 (`drivers/imu/invensense`): x, −y, −z of the chip; `lib/sensor_calibration`: accelerometer
//!   `(raw − OFF)∘SCALE` in m/s², gyroscope `raw − OFF` in rad/s.
//! - ArduPilot (`AP_InertialSensor_Invensense::_accumulate`): y, x, −z of the chip;
//!   `AP_InertialSensor_Backend`: `(accel − ACCOFFS)∘ACCSCAL` in m/s², `gyro − GYROFFS` in rad/s.
//! - INAV (`drivers/accgyro/accgyro_mpu9250.c`, `sensors/acceleration.c`): the chip's axes in counts, 2048 a g at ±16 g
//!   and 16.4 per °/s; `(raw − acczero)·accgain/4096`.
//!
//! Where the chip is mounted turned, the autopilot turns the readings first, and the axes here must be turned with them.

use std::fmt::Write;

use super::{ExportError, Parameters, Triad};

/// For each axis of the autopilot: the chip's axis, and its sign.
type Axes = [(usize, f64); 3];

const PX4: Axes = [(0, 1.0), (1, -1.0), (2, -1.0)];
const ARDUPILOT: Axes = [(1, 1.0), (0, 1.0), (2, -1.0)];
const INAV: Axes = [(0, 1.0), (1, 1.0), (2, 1.0)];

/// In the autopilot's axes.
struct Fitted {
    accel_offset: [f64; 3],
    accel_scale: [f64; 3],
    gyro_offset: [f64; 3],
}

fn fitted(parameters: &Parameters, axes: Axes) -> Result<Fitted, ExportError> {
    let scale = parameters.accelerometer.scale()?;
    let offset = |triad: &Triad| axes.map(|(axis, sign)| sign * triad.bias[axis]);
    Ok(Fitted {
        accel_offset: offset(&parameters.accelerometer),
        accel_scale: axes.map(|(axis, _)| scale[axis]),
        gyro_offset: offset(&parameters.gyroscope),
    })
}

/// What these programs have no parameter for.
fn left_out(parameters: &Parameters) -> Result<String, ExportError> {
    let gyro_scale = (parameters.gyroscope.scale()?.map(|v| v - 1.0)).amax();
    let felt = parameters.g_sensitivity.map_or(String::new(), |felt| {
        let largest = felt.amax().to_degrees() * crate::recording::STANDARD_GRAVITY_MPS2;
        format!("# And the gyroscope's sensitivity to force (up to {largest:.3} deg/s a g).\n")
    });
    Ok(format!(
        "# Left out, for want of a parameter: gyroscope scale (up to {:.2} %), cross-axis of accelerometer (up to {:.4}) and\n\
         # gyroscope (up to {:.4}).\n{felt}",
        100.0 * gyro_scale,
        parameters.accelerometer.largest_cross(),
        parameters.gyroscope.largest_cross()
    ))
}

const MOUNTING: &str = "# For a chip that is mounted as the autopilot expects (no rotation of the sensor).\n";

/// QGroundControl's parameter file: vehicle, component, name, value, type (9 is a float), separated by tabs.
pub(super) fn px4(parameters: &Parameters) -> Result<String, ExportError> {
    let fitted = fitted(parameters, PX4)?;
    let mut text = format!(
        "# PX4 sensor calibration, sensor 0. Check that CAL_ACC0_ID and CAL_GYRO0_ID are this chip's.\n{MOUNTING}{}",
        left_out(parameters)?
    );
    for (i, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
        for (name, value) in [
            (format!("CAL_ACC0_{axis}OFF"), fitted.accel_offset[i]),
            (format!("CAL_ACC0_{axis}SCALE"), fitted.accel_scale[i]),
            (format!("CAL_GYRO0_{axis}OFF"), fitted.gyro_offset[i]),
        ] {
            let _ = writeln!(text, "1\t1\t{name}\t{value:.9}\t9");
        }
    }
    Ok(text)
}

/// `NAME,VALUE` a line.
pub(super) fn ardupilot(parameters: &Parameters) -> Result<String, ExportError> {
    let fitted = fitted(parameters, ARDUPILOT)?;
    let mut text = format!(
        "# ArduPilot sensor calibration, first IMU. Set INS_GYR_CAL,0 to keep the gyroscope offsets at start.\n{MOUNTING}{}",
        left_out(parameters)?
    );
    for (i, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
        let _ = writeln!(text, "INS_ACCOFFS_{axis},{:.9}", fitted.accel_offset[i]);
        let _ = writeln!(text, "INS_ACCSCAL_{axis},{:.9}", fitted.accel_scale[i]);
        let _ = writeln!(text, "INS_GYROFFS_{axis},{:.9}", fitted.gyro_offset[i]);
    }
    Ok(text)
}

/// Counts: 2048 a g, 4096 for a gain of 1, 16.4 per °/s.
pub(super) fn inav(parameters: &Parameters) -> Result<String, ExportError> {
    let fitted = fitted(parameters, INAV)?;
    let mut text = format!(
        "# INAV sensor calibration for an MPU-9250; paste into the command line.\n{MOUNTING}{}set init_gyro_cal = OFF\n",
        left_out(parameters)?
    );
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let zero = fitted.accel_offset[i] / crate::recording::STANDARD_GRAVITY_MPS2 * 2048.0;
        let gyro = fitted.gyro_offset[i].to_degrees() * 16.4;
        let _ = writeln!(text, "set acczero_{axis} = {}", zero.round() as i64);
        let _ = writeln!(text, "set accgain_{axis} = {}", (fitted.accel_scale[i] * 4096.0).round() as i64);
        let _ = writeln!(text, "set gyro_zero_{axis} = {}", gyro.round() as i64);
    }
    text.push_str("save\n");
    Ok(text)
}
