//! Kalibr (ethz-asl/kalibr), `--imu-models scale-misalignment`: as `IccScaledMisalignedImu` in its `IccSensors.py` has it,
//! `accel = M·f_i + b` and `gyro = M·C_gyro_i·ω_i + A·f_i + b`, both M lower-triangular, axes `i` those of the accelerometer.

use nalgebra::Matrix3;

use super::parameters::Triad;
use super::{ExportError, Parameters};

/// MPU-9250 sheet: 300 µg/√Hz and 0.01 °/s/√Hz.
const ACCEL_DENSITY: f64 = 300e-6 * 9.806_65;
const GYRO_DENSITY: f64 = 0.01 * std::f64::consts::PI / 180.0;

pub(super) fn text(parameters: &Parameters) -> Result<String, ExportError> {
    let accel = inverse(&parameters.accelerometer, "accelerometer")?;
    let gyro = inverse(&parameters.gyroscope, "gyroscope")?;
    // raw = accel·f_b + bias, and accel = M·R_i_from_b whatever the frame b is.
    let (m_accel, rotation_i_from_b) = lower_times_rotation(&accel);
    let (m_gyro, c_gyro_i) = lower_times_rotation(&(gyro * rotation_i_from_b.transpose()));
    Ok(format!(
        "# IMU intrinsics for Kalibr, model scale-misalignment: accel = M*a + b, gyro = M*C_gyro_i*w + A*a + b.\n\
         # Biases at calibration: accelerometer {:?} m/s^2, gyroscope {:?} rad/s. Kalibr estimates its own.\n\
         # The noise densities are the MPU-9250 data sheet's. A calibration says nothing of the random walks: the two here\n\
         # are common guesses, to be replaced by those of an Allan deviation.\n\
         imu0:\n  T_i_b:\n{}  - [0.0, 0.0, 0.0, 1.0]\n  accelerometer_noise_density: {ACCEL_DENSITY:e}\n  \
         accelerometer_random_walk: 2.0e-04\n  accelerometers:\n    M:\n{}  gyroscope_noise_density: {GYRO_DENSITY:e}\n  \
         gyroscope_random_walk: 4.0e-06\n  gyroscopes:\n    A:\n{}    C_gyro_i:\n{}    M:\n{}  model: scale-misalignment\n  \
         rostopic: /imu0\n  time_offset: 0.0\n  update_rate: 200.0\n",
        array(&parameters.accelerometer),
        array(&parameters.gyroscope),
        rows(&rotation_i_from_b, "  ", ", 0.0"),
        rows(&m_accel, "    ", ""),
        // A·f_i = G·f_b.
        rows(&(parameters.g_sensitivity.unwrap_or_default() * rotation_i_from_b.transpose()), "    ", ""),
        rows(&c_gyro_i, "    ", ""),
        rows(&m_gyro, "    ", ""),
    ))
}

fn inverse(triad: &Triad, name: &'static str) -> Result<Matrix3<f64>, ExportError> {
    triad.matrix()?.try_inverse().ok_or(ExportError::Singular(name))
}

/// `A = L·Q`: the transposed QR decomposition of `Aᵀ`, with signs such that the diagonal of L is positive.
fn lower_times_rotation(matrix: &Matrix3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let qr = matrix.transpose().qr();
    let (mut lower, mut rotation) = (qr.r().transpose(), qr.q().transpose());
    for k in 0..3 {
        if lower[(k, k)] < 0.0 {
            lower.column_mut(k).neg_mut();
            rotation.row_mut(k).neg_mut();
        }
    }
    (lower, rotation)
}

fn array(triad: &Triad) -> [f64; 3] {
    triad.bias.into()
}

fn rows(matrix: &Matrix3<f64>, indent: &str, tail: &str) -> String {
    matrix.row_iter().map(|row| format!("{indent}- [{:?}, {:?}, {:?}{tail}]\n", row[0], row[1], row[2])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_near_the_identity_splits_into_lower_and_rotation() {
        let matrix = Matrix3::new(1.01, 0.02, -0.01, 0.005, 0.98, 0.015, -0.02, 0.01, 1.03);
        let (lower, rotation) = lower_times_rotation(&matrix);
        assert!((lower * rotation - matrix).norm() < 1e-12);
        assert!((rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-12);
        assert!((rotation.determinant() - 1.0).abs() < 1e-12, "no mirror");
        assert!(lower.upper_triangle().lower_triangle().diagonal().min() > 0.9);
        assert!(lower[(0, 1)].abs() + lower[(0, 2)].abs() + lower[(1, 2)].abs() < 1e-12);
    }
}
