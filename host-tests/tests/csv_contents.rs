//! What is read, written, inferred, and seen in real recordings.

use host_tests::recording;
use tumble::recording::{Basis, BoxFaces, Inference, Metadata, Recording, Row, TurnStops, as_board_reads};
use tumble_core::sample::Ranges;

fn row(i: u32, gyro_dps: [f64; 3], accel_g: [f64; 3]) -> Row {
    Row { t_s: 100.0 + f64::from(i) * 0.005, gyro_dps, accel_g, temp_c: Some(25.0 + f64::from(i) / 3.0) }
}

fn sample_recording() -> Recording {
    let metadata = Metadata {
        sensor: Some("MPU-9250".into()),
        gyro_range_dps: Some(2000.0),
        accel_range_g: Some(16.0),
        rate_hz: Some(200.0),
        gravity_mps2: Some(9.81),
        latitude_deg: Some(-31.3),
        turns: Some(TurnStops::Fenced),
        box_faces: Some(BoxFaces::Square),
    };
    let rows =
        (0..50).map(|i| row(i, [f64::from(i) / 7.0, -1e-9, 1500.0 - f64::from(i)], [1.0 / 3.0, 0.9, -0.1])).collect();
    Recording { metadata, rows, notices: Vec::new(), stamps_s: Vec::new() }
}

#[test]
fn what_is_written_reads_back_exactly() {
    let written = sample_recording();
    let mut bytes = Vec::new();
    written.write(&mut bytes).expect("memory takes it");
    assert_eq!(Recording::from_bytes(&bytes, "rec.csv").expect("our own format"), written);

    let without = Recording {
        rows: written.rows.iter().map(|row| Row { temp_c: None, ..*row }).collect(),
        metadata: Metadata::default(),
        notices: Vec::new(),
        stamps_s: Vec::new(),
    };
    let mut bytes = Vec::new();
    without.write(&mut bytes).expect("memory takes it");
    assert_eq!(Recording::from_bytes(&bytes, "rec.csv").expect("our own format"), without);
}

#[test]
fn any_column_order_unknown_columns_marks_and_spaces() {
    let text = "\u{feff}# note\n# turns: by-hand\nname, az_g ,ay_g,ax_g,temp_c,gz_dps,gy_dps,gx_dps,t_s,extra\n\
                a,1,0.5,0.25,nan,3,2,1,0.0,nan\n b , 1 , 0.5,0.25,21.5,3,2,1e0,0.01,\n";
    let recording = Recording::from_bytes(text.as_bytes(), "rec.csv").expect("allowed by the contract");
    assert_eq!(recording.metadata.turns, Some(TurnStops::ByHand));
    assert_eq!(recording.rows.len(), 2);
    assert_eq!(recording.rows[0].channels(), [1.0, 2.0, 3.0, 0.25, 0.5, 1.0]);
    assert_eq!(recording.rows.iter().map(|row| row.temp_c).collect::<Vec<_>>(), [None, Some(21.5)]);
}

#[test]
fn samples_are_si_from_the_first_stamp_on() {
    let recording = sample_recording();
    let readings = recording.samples(&Inference::of(&recording));
    assert_eq!((readings[0].sample.t_us, readings[3].sample.t_us), (0, 15_000));
    let sample = readings[7].sample;
    assert_eq!(sample.angular_rate_rad_s.x, 1.0_f64.to_radians() as f32);
    assert_eq!(sample.specific_force_mps2.x, (9.80665 / 3.0) as f32);
}

/// A rest with noise of a few counts, quantised.
fn quantised(gyro_step: f64, accel_step: f64) -> Recording {
    let noise = |i: u32, k: u32| f64::from((i.wrapping_mul(2_654_435_761 + 97 * k) >> 13) % 9) - 4.0;
    let rows = (0..2000)
        .map(|i| {
            let gyro = [0, 1, 2].map(|k| noise(i, k) * gyro_step);
            let accel =
                [3, 4, 5].map(|k| (noise(i, k) + if k == 5 { (1.0 / accel_step).round() } else { 0.0 }) * accel_step);
            row(i, gyro, accel)
        })
        .collect();
    Recording { metadata: Metadata::default(), rows, notices: Vec::new(), stamps_s: Vec::new() }
}

#[test]
fn ranges_come_from_the_least_step() {
    for (gyro, accel) in [(250.0, 2.0), (500.0, 4.0), (1000.0, 8.0), (2000.0, 16.0)] {
        let inference = Inference::of(&quantised(gyro / 32768.0, accel / 32768.0));
        assert_eq!((inference.gyro_range_dps.value, inference.gyro_range_dps.basis), (gyro, Basis::Step));
        assert_eq!((inference.accel_range_g.value, inference.accel_range_g.basis), (accel, Basis::Step));
        assert!((inference.rate_hz - 200.0).abs() < 1e-6);
    }
}

#[test]
fn clipping_gaps_and_a_stated_range() {
    let mut recording = quantised(250.0 / 32768.0, 2.0 / 32768.0);
    for row in &mut recording.rows[100..110] {
        row.gyro_dps[1] = -250.0;
    }
    for row in &mut recording.rows[1500..] {
        row.t_s += 0.05;
    }
    let inference = Inference::of(&recording);
    assert_eq!(inference.clipped_counts(&recording.rows), [0, 10, 0, 0, 0, 0]);
    let readings = recording.samples(&inference);
    assert_eq!(readings.iter().position(|r| r.clipped == 0b10), Some(100));
    assert_eq!(inference.gaps.len(), 1);
    assert_eq!((inference.gaps[0].missing, (inference.rate_hz - 200.0).abs() < 1e-6), (10, true));
    recording.metadata.gyro_range_dps = Some(500.0);
    assert_eq!(Inference::of(&recording).gyro_range_dps.basis, Basis::Stated);
}

#[test]
fn a_flat_top_below_the_usual_ranges_is_clipping_too() {
    let mut recording = quantised(1.0 / 14.375, 0.004);
    for (i, row) in recording.rows[200..300].iter_mut().enumerate() {
        row.gyro_dps[0] = (i as f64 * 40.0).min((99.0 - i as f64) * 40.0).min(1834.7);
    }
    let inference = Inference::of(&recording);
    assert!(inference.clipped_counts(&recording.rows)[0] >= 3);
}

#[test]
fn as_the_board_reads_is_within_half_a_count_and_saturates() {
    let mut recording = sample_recording();
    recording.rows[0].gyro_dps[0] = 5000.0;
    let inference = Inference::of(&recording);
    let readings = recording.samples(&inference);
    let board: Vec<_> = readings.iter().map(|r| as_board_reads(r, &Ranges::WIDEST)).collect();
    assert_eq!((board[0].clipped, board[1].clipped), (1, 0));
    for (exact, read) in readings.iter().zip(&board).skip(1) {
        let gyro = (exact.sample.angular_rate_rad_s - read.sample.angular_rate_rad_s).amax();
        let accel = (exact.sample.specific_force_mps2 - read.sample.specific_force_mps2).amax();
        assert!(gyro <= 0.501 * Ranges::WIDEST.gyro_count_rad_s(), "{gyro}");
        assert!(accel <= 0.501 * Ranges::WIDEST.accel_count_mps2(), "{accel}");
        let again = as_board_reads(read, &Ranges::WIDEST).sample;
        assert_eq!(again.angular_rate_rad_s, read.sample.angular_rate_rad_s, "counts stay what they are");
    }
}

#[test]
fn real_recordings_are_read_and_understood() {
    // File, gyroscope range, accelerometer range, rate, clipped channels. The MPU-6050 files are said to be at ±2 g, but
    // their least step is 1/4096 g, one count of ±8 g: the step is what a recording shows.
    let known = [
        ("mikoff_mpu9150_imu0.csv", 2000.0, 16.0, 100.0, false),
        ("mikoff_mpu9150_imu1.csv", 2000.0, 16.0, 100.0, false),
        ("mikoff_mpu9150_imu3.csv", 2000.0, 16.0, 100.0, false),
        ("imucal_ferraris_session.csv", 2000.0, 16.0, 102.4, false),
        ("tomisuarez_mpu6050_multipos.csv", 250.0, 8.0, 100.0, true),
        ("tomisuarez_mpu6050_static450s.csv", 250.0, 8.0, 100.0, false),
        ("mimu4444_exp1_imu1.csv", 2000.0, 16.0, 62.5, true),
        ("mimu4444_exp1_imu5.csv", 2000.0, 16.0, 62.5, true),
        ("sunsided_mpu6050_s1_unmoved_x_forward.csv", 250.0, 8.0, 100.0, false),
        ("sunsided_mpu6050_s1_rotate_360ccw_z_up.csv", 250.0, 8.0, 100.0, false),
    ];
    for (name, gyro, accel, rate_hz, clips) in known {
        let Some(path) = recording(name) else { continue };
        let recording = Recording::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let inference = Inference::of(&recording);
        println!("{name}: {inference:?} clipped {:?}", inference.clipped_counts(&recording.rows));
        assert_eq!(inference.gyro_range_dps.value, gyro, "{name}");
        assert_eq!(inference.accel_range_g.value, accel, "{name}");
        assert!((inference.rate_hz / rate_hz - 1.0).abs() < 0.02, "{name}: {}", inference.rate_hz);
        assert_eq!(inference.clipped_counts(&recording.rows).iter().any(|&n| n > 0), clips, "{name}");
    }
}
