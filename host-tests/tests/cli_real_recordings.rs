//! `tumble calibrate` on real recordings, against what their authors published (`../shared/recordings/README.md`).

use host_tests::recording;
use tumble::calibrate::{Outcome, Session, conditions};
use tumble::recording::{Inference, Recording, STANDARD_GRAVITY_MPS2, as_board_reads};
use tumble_core::calibration::Calibration;
use tumble_core::sample::Ranges;

fn calibrate(name: &str, board_counts: bool) -> Option<Outcome> {
    let path = recording(name)?;
    let recording = Recording::read(&path).unwrap_or_else(|error| panic!("{error}"));
    let inference = Inference::of(&recording);
    let mut readings = recording.samples(&inference);
    if board_counts {
        readings.iter_mut().for_each(|reading| *reading = as_board_reads(reading, &Ranges::WIDEST));
    }
    let session = Session {
        readings: &readings,
        origin_s: recording.origin_s(),
        lost: inference.missing(),
        conditions: conditions(&recording.metadata),
    };
    Some(session.replay(&mut |_| {}))
}

fn numbers(outcome: Outcome) -> Calibration {
    outcome.calibration.expect("these recordings can be computed")
}

/// Scale factors of raw over ideal to first order: the inverse of the correction's diagonal.
fn gyro_scale(calibration: &Calibration) -> [f32; 3] {
    let correction = calibration.gyroscope.triad.correction;
    [0, 1, 2].map(|i| 1.0 / correction[(i, i)])
}

/// Six faces and one full turn about each axis in quarter steps; raw integrals of −369.97, −353.69 and −359.33°.
#[test]
fn imucal_ferraris_session_gives_the_scale_of_its_known_turns() {
    let Some(outcome) = calibrate("imucal_ferraris_session.csv", false) else { return };
    let correction = numbers(outcome).gyroscope.triad.correction;
    for (i, truth) in [0.9730, 1.0178, 1.0019].into_iter().enumerate() {
        let found = correction[(i, i)];
        assert!((found / truth - 1.0).abs() < 0.005, "axis {i}: {found} for {truth}");
    }
}

/// Generic poses and hand rotations, published by the author.
#[test]
fn mikoff_imu0_gives_the_published_scale_and_bias() {
    let Some(outcome) = calibrate("mikoff_mpu9150_imu0.csv", false) else { return };
    let calibration = numbers(outcome);
    for (i, percent) in [0.04, 0.46, 0.83].into_iter().enumerate() {
        let found = (gyro_scale(&calibration)[i] - 1.0) * 100.0;
        assert!((found - percent).abs() < 0.15, "gyroscope axis {i}: {found} % for {percent} %");
    }
    for (i, mps2) in [0.103, 0.097, 0.344].into_iter().enumerate() {
        let found = calibration.accelerometer.triad.bias[i];
        let off_mg = (found - mps2).abs() / STANDARD_GRAVITY_MPS2 as f32 * 1000.0;
        assert!(off_mg < 2.0, "accelerometer axis {i}: {found} m/s² for {mps2}, {off_mg} mg off");
    }
}

/// What a replay on the emulated board reads is rounded to its counts. This recording's accelerometer readings lie on
/// another grid and move by up to half a count (0.24 mg). Its moves err by far more than noise, so that what they weigh is
/// estimated, and follows: its scale factors may move by what their sigmas say, and no more.
#[test]
fn the_board_s_counts_leave_the_scale_factors_within_their_sigmas() {
    let name = "imucal_ferraris_session.csv";
    let (Some(exact), Some(counts)) = (calibrate(name, false), calibrate(name, true)) else { return };
    let [exact, counts] = [exact, counts].map(|outcome| {
        let gyroscope = numbers(outcome).gyroscope;
        [0, 1, 2].map(|i| (gyroscope.triad.correction[(i, i)], gyroscope.correction_sigma[(i, i)]))
    });
    for (axis, (exact, counts)) in exact.iter().zip(counts).enumerate() {
        let allowed = 2.0 * exact.1.hypot(counts.1);
        assert!((exact.0 - counts.0).abs() < allowed, "axis {axis}: {exact:?} and {counts:?}");
        assert!(allowed < 0.01, "axis {axis}: a sigma of {allowed} says nothing");
    }
}

/// Whatever a recording lacks: no panic, no number that is not one.
#[test]
fn every_recording_ends_in_numbers_or_a_reason() {
    for name in [
        "broad_05_slow_rotation_with_breaks_b.csv",
        "mimu4444_exp1_imu1.csv",
        "mimu4444_exp1_imu5.csv",
        "mikoff_mpu9150_imu1.csv",
        "mikoff_mpu9150_imu3.csv",
        "sunsided_mpu6050_s1_rotate_360ccw_x_forward.csv",
        "sunsided_mpu6050_s1_rotate_360ccw_y_left.csv",
        "sunsided_mpu6050_s1_rotate_360ccw_z_up.csv",
        "sunsided_mpu6050_s1_unmoved_x_forward.csv",
        "tomisuarez_mpu6050_multipos.csv",
        "tomisuarez_mpu6050_static450s.csv",
    ] {
        let Some(outcome) = calibrate(name, false) else { continue };
        match &outcome.calibration {
            Some(calibration) => {
                let finite = |t: &tumble_core::calibration::TriadEstimate| {
                    t.triad.bias.iter().chain(t.triad.correction.iter()).all(|v| v.is_finite())
                };
                assert!(finite(&calibration.accelerometer) && finite(&calibration.gyroscope), "{name}");
            }
            None => assert!(!outcome.reasons.is_empty(), "{name} gives neither"),
        }
        println!("{name}: {:?}, {} segments", outcome.verdict, outcome.segments.len());
    }
}
