//! What other programs are told is what the calibration says.

use nalgebra::{Matrix3, Vector3};
use tumble::export::{ExportError, Format, Parameters, export};
use tumble::output::{GyroscopeReport, Report, TriadReport};

const ACCEL: [[f32; 3]; 3] = [[1.01, 0.002, -0.003], [0.004, 0.99, 0.005], [-0.006, 0.007, 1.02]];
const GYRO: [[f32; 3]; 3] = [[0.98, 0.01, 0.02], [-0.01, 1.03, 0.015], [0.005, -0.02, 1.0]];
const ACCEL_BIAS: [f32; 3] = [0.5, -0.25, 0.125];
const GYRO_BIAS: [f32; 3] = [0.01, 0.02, -0.03];
const FELT: [[f32; 3]; 3] = [[1e-4, -2e-4, 3e-5], [4e-5, 1.5e-4, -6e-5], [7e-5, -8e-5, 9e-5]];

fn report() -> Report {
    let some = |m: [[f32; 3]; 3]| m.map(|row| row.map(Some));
    Report {
        verdict: "accepted".into(),
        frame: Some("box".into()),
        accelerometer: Some(TriadReport {
            bias_mps2: ACCEL_BIAS,
            bias_sigma_mps2: [0.001; 3],
            correction: some(ACCEL),
            correction_sigma: some([[1e-4; 3]; 3]),
            observable: [[true; 3]; 3],
        }),
        gyroscope: Some(GyroscopeReport {
            bias_rad_s: GYRO_BIAS,
            bias_sigma_rad_s: [1e-5; 3],
            correction: some(GYRO),
            correction_sigma: some([[1e-4; 3]; 3]),
            observable: [[true; 3]; 3],
            g_sensitivity_rad_s_per_mps2: Some(FELT),
            g_sensitivity_sigma_rad_s_per_mps2: None,
        }),
        ..Report::refused(Vec::new())
    }
}

fn parameters() -> Parameters {
    Parameters::parse(&serde_json::to_string(&report()).expect("plain data")).expect("our own format")
}

fn text(format: Format) -> String {
    export(&parameters(), format).expect("nothing is missing")
}

/// All numbers of the `count` lines below the one that ends with `heading`.
fn numbers(text: &str, heading: &str, count: usize) -> Vec<f64> {
    let lines = text.lines().skip_while(|line| line.trim() != heading).skip(1).take(count);
    lines.flat_map(|line| line.split(['[', ',', ']']).filter_map(|word| word.trim().parse().ok())).collect()
}

#[test]
fn kalibr_s_model_gives_the_raw_reading_back() {
    let text = text(Format::Kalibr);
    let (accel, gyro) = text.split_once("gyroscope_noise_density").expect("both");
    let matrix = |text, heading| Matrix3::from_row_slice(&numbers(text, heading, 3));
    let pose = numbers(accel, "T_i_b:", 3);
    let rotation = Matrix3::from_fn(|i, j| pose[4 * i + j]);
    let (m_accel, m_gyro, c_gyro) = (matrix(accel, "M:"), matrix(gyro, "M:"), matrix(gyro, "C_gyro_i:"));
    let wanted = |m: [[f32; 3]; 3]| Matrix3::from_fn(|i, j| f64::from(m[i][j])).try_inverse().expect("regular");
    assert!((m_accel * rotation - wanted(ACCEL)).norm() < 1e-9, "{text}");
    assert!((m_gyro * c_gyro * rotation - wanted(GYRO)).norm() < 1e-9, "{text}");
    let felt = Matrix3::from_fn(|i, j| f64::from(FELT[i][j]));
    assert!((matrix(gyro, "A:") * rotation - felt).norm() < 1e-12, "of the force in the box's axes: {text}");
    assert_eq!((m_accel[(0, 1)].abs() < 1e-12, m_gyro[(0, 2)].abs() < 1e-12), (true, true), "lower-triangular");
}

#[test]
fn imu_calib_subtracts_its_bias_after_the_matrix() {
    let text = text(Format::Ros);
    let line = |key: &str| -> Vec<f64> {
        let line = text.lines().find_map(|line| line.strip_prefix(key)).expect("the key");
        line.split(['[', ',', ']']).filter_map(|word| word.trim().parse().ok()).collect()
    };
    let (matrix, bias) = (Matrix3::from_row_slice(&line("SM: ")), Vector3::from_vec(line("bias: ")));
    let raw = Vector3::new(1.0, -2.0, 9.0);
    let ideal = Matrix3::from_fn(|i, j| f64::from(ACCEL[i][j])) * (raw - Vector3::from(ACCEL_BIAS.map(f64::from)));
    assert!((matrix * raw - bias - ideal).norm() < 1e-9);
}

#[test]
fn autopilots_get_their_own_axes() {
    let px4 = text(Format::Px4);
    for line in ["1\t1\tCAL_ACC0_XOFF\t0.500000000\t9", "CAL_ACC0_YOFF\t0.250000000", "CAL_GYRO0_ZOFF\t0.029999999"] {
        assert!(px4.contains(line), "{line} is not in\n{px4}");
    }
    let ardupilot = text(Format::Ardupilot);
    for line in [
        "INS_ACCOFFS_X,-0.250000000",
        "INS_ACCOFFS_Y,0.500000000",
        "INS_ACCSCAL_X,0.990000010",
        "INS_GYROFFS_Z,0.029999999",
    ] {
        assert!(ardupilot.contains(line), "{line} is not in\n{ardupilot}");
    }
    let inav = text(Format::Inav);
    // 0.5 m/s² of 2048 counts a g; 1.01 of 4096; 0.02 rad/s of 16.4 counts per °/s.
    for line in ["set acczero_x = 104\n", "set accgain_x = 4137\n", "set gyro_zero_y = 19\n"] {
        assert!(inav.contains(line), "{line} is not in\n{inav}");
    }
    for text in [px4, ardupilot, inav] {
        assert!(text.contains("Left out") && text.contains("3.00 %") && text.contains("0.112 deg/s a g"), "{text}");
    }
}

#[test]
fn json_and_c_carry_every_number() {
    let object: serde_json::Value = serde_json::from_str(&text(Format::Json)).expect("JSON");
    assert_eq!(object["gyroscope"]["correction"][2][1].as_f64().map(|v| v as f32), Some(GYRO[2][1]));
    let c = text(Format::C);
    let felt = &object["gyroscope"]["g_sensitivity_rad_s_per_mps2"];
    assert_eq!(felt[2][1].as_f64().map(|v| v as f32), Some(FELT[2][1]));
    assert!(c.contains("tumble_gyro_g_sensitivity[3][3]") && c.contains("tumble_unfelt("), "{c}");
    assert!(c.contains("tumble_gyro_correction[3][3]") && c.contains("static inline void tumble_compensate"), "{c}");
}

#[test]
fn the_board_s_lines_say_the_same_as_the_tool_s_json() {
    let mut lines = String::from("Calibration number 3:\r\n");
    let axes = ["x", "y", "z"];
    for (sensor, bias, matrix) in [("accel", ACCEL_BIAS, ACCEL), ("gyro", GYRO_BIAS, GYRO)] {
        for i in 0..3 {
            lines += &format!(
                "@param name={sensor}_bias_{} value={} sigma=0.1 unit=m/s^2 observable=yes\r\n",
                axes[i], bias[i]
            );
            for j in 0..3 {
                let name = format!("{sensor}_correction_{}{}", axes[i], axes[j]);
                lines += &format!("@param name={name} value={} sigma=0.1 unit=1 observable=yes\r\n", matrix[i][j]);
            }
        }
    }
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let (row, column) = (axes[i], axes[j]);
        let value = FELT[i][j];
        let line = format!(
            "name=gyro_g_sensitivity_{row}{column} value={value:e} sigma=1e-6 unit=(rad/s)/(m/s^2) observable=yes"
        );
        lines += &format!("@param {line}\r\n");
    }
    let board = Parameters::parse(&lines).expect("the protocol's lines");
    let felt = |parameters: &Parameters| parameters.g_sensitivity.map(|felt| felt.map(|value| value as f32));
    assert_eq!(felt(&board), felt(&parameters()));
    let close = |a: &str, b: &str| (a.parse::<f64>().ok(), b.parse::<f64>().ok());
    let (from_board, from_tool) = (export(&board, Format::Px4).expect("all there"), text(Format::Px4));
    for (a, b) in from_board.split_whitespace().zip(from_tool.split_whitespace()) {
        if let (Some(a), Some(b)) = close(a, b) {
            assert!((a - b).abs() < 1e-7, "{a} {b}");
        }
    }
    let missing = lines.replace("name=gyro_correction_zz", "name=other");
    assert_eq!(Parameters::parse(&missing), Err(ExportError::Missing("gyro_correction_zz".into())));
    let unseen = lines.replace("0.015 sigma=0.1 unit=1 observable=yes", "- sigma=- unit=1 observable=no");
    let unseen = Parameters::parse(&unseen).expect("an honest calibration");
    assert_eq!(export(&unseen, Format::C), Err(ExportError::NotObservable("gyro_correction_yz".into())));
    assert!(export(&unseen, Format::Json).expect("it can say so").contains("null"));
}

#[test]
fn what_is_no_calibration_is_refused() {
    assert_eq!(Parameters::parse("hello"), Err(ExportError::NotParameters));
    let rejected = serde_json::to_string(&Report::refused(vec!["too few faces".into()])).expect("plain data");
    assert_eq!(Parameters::parse(&rejected), Err(ExportError::Rejected("too few faces".into())));
}
