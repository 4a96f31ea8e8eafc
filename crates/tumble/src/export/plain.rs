//! Forms that take every number.

use nalgebra::Matrix3;
use serde_json::json;

use super::{ExportError, Parameters, Triad};

const MODEL: &str = "ideal = correction * (raw - bias)";

fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

fn bias(triad: &Triad) -> [f64; 3] {
    triad.bias.into()
}

/// SI. What is not determined is null, as in the input.
pub(super) fn json(parameters: &Parameters) -> Result<String, ExportError> {
    let Parameters { accelerometer, gyroscope, g_sensitivity, frame, temperature_degc } = parameters;
    let object = json!({
        "format": "tumble-parameters", "version": 1, "model": MODEL, "frame": frame, "temperature_degc": temperature_degc,
        "accelerometer": {"bias_mps2": bias(accelerometer), "correction": accelerometer.correction},
        "gyroscope": {"bias_rad_s": bias(gyroscope), "correction": gyroscope.correction,
                      "g_sensitivity_rad_s_per_mps2": g_sensitivity.as_ref().map(rows)},
    });
    Ok(format!("{object:#}\n"))
}

/// dpkoch/imu_calib, `accel_calib.cpp`: `corrected = SM·raw − bias`, nine and three numbers, so its bias is ours
/// after the correction. It has no such file for the gyroscope; further keys do not disturb it.
pub(super) fn ros(parameters: &Parameters) -> Result<String, ExportError> {
    let line = |triad: &Triad| -> Result<(String, String), ExportError> {
        let matrix = triad.matrix()?;
        let after: [f64; 3] = (matrix * triad.bias).into();
        Ok((format!("{:?}", rows(&matrix).concat()), format!("{after:?}")))
    };
    let (accel, accel_bias) = line(&parameters.accelerometer)?;
    let (gyro, gyro_bias) = line(&parameters.gyroscope)?;
    let felt = parameters.g_sensitivity.map_or(String::new(), |felt| {
        let rows = rows(&felt).concat();
        format!("# Take this times the corrected force (m/s^2) off the raw rate first.\ngyro_g_sensitivity: {rows:?}\n")
    });
    Ok(format!(
        "# For the ROS package imu_calib: corrected = SM * raw - bias, m/s^2.\nSM: {accel}\nbias: {accel_bias}\n\
         # The same for the gyroscope, rad/s; imu_calib does not read these.\ngyro_SM: {gyro}\ngyro_bias: {gyro_bias}\n{felt}"
    ))
}

/// A header without any dependency.
pub(super) fn c(parameters: &Parameters) -> Result<String, ExportError> {
    let array = |values: [f64; 3]| values.map(|v| format!("{v:.9e}f")).join(", ");
    let matrix = |name: &str, matrix: &Matrix3<f64>| {
        let rows = rows(matrix).map(array).map(|row| format!("    {{{row}}}")).join(",\n");
        format!("static const float tumble_{name}[3][3] = {{\n{rows}\n}};\n")
    };
    let sensor = |name: &str, unit: &str, triad: &Triad| -> Result<String, ExportError> {
        let correction = matrix(&format!("{name}_correction"), &triad.matrix()?);
        Ok(format!("static const float tumble_{name}_bias_{unit}[3] = {{{}}};\n{correction}", array(bias(triad))))
    };
    let felt = parameters.g_sensitivity.map_or(String::new(), |felt| {
        format!(
            "/* The gyroscope feels force: take this off its raw rate before tumble_compensate. */\n{}\
             static inline void tumble_unfelt(const float force_mps2[3], float raw_rad_s[3])\n{{\n    \
             for (int i = 0; i < 3; i++)\n        for (int j = 0; j < 3; j++)\n            \
             raw_rad_s[i] -= tumble_gyro_g_sensitivity[i][j] * force_mps2[j];\n}}\n\n",
            matrix("gyro_g_sensitivity", &felt)
        )
    });
    let frame = parameters.frame.as_deref().unwrap_or("not stated");
    Ok(format!(
        "/* Calibration by Tumble. {MODEL}, raw in the sensor's axes, ideal in the axes of: {frame}. */\n\
         #ifndef TUMBLE_CALIBRATION_H\n#define TUMBLE_CALIBRATION_H\n\n{}\n{}\n{felt}\
         static inline void tumble_compensate(const float correction[3][3], const float bias[3], const float raw[3], \
         float ideal[3])\n{{\n    const float d[3] = {{raw[0] - bias[0], raw[1] - bias[1], raw[2] - bias[2]}};\n    \
         for (int i = 0; i < 3; i++)\n        ideal[i] = correction[i][0] * d[0] + correction[i][1] * d[1] + \
         correction[i][2] * d[2];\n}}\n\n#endif\n",
        sensor("accel", "mps2", &parameters.accelerometer)?,
        sensor("gyro", "rad_s", &parameters.gyroscope)?,
    ))
}
