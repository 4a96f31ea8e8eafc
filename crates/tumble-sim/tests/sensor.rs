//! The sensor: noise of the stated density, exact frames, drifts that the truth follows.

use nalgebra::{Matrix3, Vector3};
use tumble_sim::rng::{Purpose, Rng};
use tumble_sim::sensor::{
    BiasDrift, Drift, Noise, PaperAngles, Quantisation, SensorTruth, ShapedNoise, Sheet, Thermal, Triad,
};
use tumble_sim::{Sample, SensorConfig, Truth, World, WorldConfig};

fn still_world(change: impl Fn(&mut SensorConfig)) -> World {
    let mut config = WorldConfig::nominal(3);
    change(&mut config.sensor);
    World::new(&config).unwrap()
}

fn record(world: &mut World, rate_hz: f64, seconds: f64) -> Vec<Sample> {
    (0..(rate_hz * seconds) as usize).map(|k| world.sample(k as f64 / rate_hz)).collect()
}

/// One-sided density near 0 Hz from the scatter of averages over `block` samples: `σ = N/√(2T)`.
fn density(values: &[f64], block: usize, rate_hz: f64) -> f64 {
    let means: Vec<f64> = values.chunks_exact(block).map(|c| c.iter().sum::<f64>() / block as f64).collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (means.len() - 1) as f64;
    (variance * 2.0 * block as f64 / rate_hz).sqrt()
}

#[test]
fn noise_has_the_sheets_density() {
    let mut world = still_world(|_| {});
    let samples = record(&mut world, 200.0, 600.0);
    let gyro: Vec<f64> = samples.iter().map(|s| s.angular_rate_rad_s.y.to_degrees()).collect();
    let accel: Vec<f64> = samples.iter().map(|s| s.specific_force_mps2.x / 9.80665 * 1e6).collect();
    // 1200 blocks of half a second: the estimate is good to 2 %, 1σ.
    let (gyro, accel) = (density(&gyro, 100, 200.0), density(&accel, 100, 200.0));
    assert!((gyro / 0.01 - 1.0).abs() < 0.07, "gyro {gyro} °/s/√Hz");
    assert!((accel / 300.0 - 1.0).abs() < 0.07, "accel {accel} µg/√Hz");
}

#[test]
fn the_density_depends_on_neither_rate_nor_bandwidth() {
    let mut rng = Rng::new(1, Purpose::Noise);
    for (rate_hz, bandwidth_hz) in [(200.0, None), (1000.0, Some(41.0)), (100.0, Some(92.0)), (50.0, Some(10.0))] {
        let mut noise = ShapedNoise::new(0.01, rate_hz, bandwidth_hz, &mut rng);
        let values: Vec<f64> = (0..(600.0 * rate_hz) as usize).map(|_| noise.step(&mut rng).x).collect();
        let found = density(&values, (0.5 * rate_hz) as usize, rate_hz);
        assert!((found / 0.01 - 1.0).abs() < 0.07, "{rate_hz} Hz, {bandwidth_hz:?}: {found}");
    }
}

#[test]
fn the_low_pass_leaves_its_own_bandwidth_of_noise() {
    let mut world = still_world(|_| {});
    let samples = record(&mut world, 200.0, 200.0);
    let values: Vec<f64> = samples.iter().map(|s| s.angular_rate_rad_s.z.to_degrees()).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let rms = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
    // Noise bandwidth of a second-order Butterworth is π/(2√2) = 1.11 cut-offs; warping at 200 Hz moves it a little.
    let expected = 0.01 * (41.0 * 1.11f64).sqrt();
    assert!((rms / expected - 1.0).abs() < 0.07, "rms {rms}, expected {expected} °/s");
}

#[test]
fn raw_is_the_exact_inverse_of_the_contracts_correction() {
    let truth = SensorTruth::draw(&Sheet::MPU9250, 9);
    let ideal = Vector3::new(0.3, -1.2, 2.0);
    let raw = truth.gyro.distort(&ideal);
    assert!((truth.gyro.correction().unwrap() * (raw - truth.gyro.bias) - ideal).norm() < 1e-14);
}

#[test]
fn draws_stay_within_the_sheet_and_use_it() {
    let mut widest = [0.0f64; 4];
    for seed in 0..200 {
        let truth = SensorTruth::draw(&Sheet::MPU9250, seed);
        let off = (truth.gyro.distortion - Matrix3::identity()).map(f64::abs);
        let seen = [
            truth.gyro.bias.amax().to_degrees() / 5.0,
            truth.accel.bias.z.abs() / (0.08 * 9.80665),
            off.diagonal().amax() / 0.03,
            off[(0, 1)] / 0.02,
        ];
        widest.iter_mut().zip(seen).for_each(|(w, s)| *w = w.max(s));
        assert!(truth.accel.bias.x.abs() <= 0.06 * 9.80665);
    }
    assert!(widest.iter().all(|w| (0.95..=1.0).contains(w)), "{widest:?}");
}

#[test]
fn the_papers_model_is_reproduced() {
    let truth = SensorTruth::paper_table_1(Triad::ideal());
    let a = PaperAngles { xy: -0.45, xz: 0.65, yx: -0.45, yz: 0.65, zx: -0.45, zy: 0.65 }.matrix();
    (0..3).for_each(|i| assert!((a.row(i).norm() - 1.0).abs() < 1e-15, "sensitive axes are unit vectors"));
    let (small, large) = (0.45f64.to_radians(), 0.65f64.to_radians());
    assert!((a[(0, 1)] - large.sin()).abs() < 1e-15 && (a[(0, 2)] - large.cos() * small.sin()).abs() < 1e-15);
    assert!((a[(1, 0)] + small.cos() * large.sin()).abs() < 1e-15 && (a[(1, 2)] + small.sin()).abs() < 1e-15);
    assert!((a[(2, 0)] - large.sin()).abs() < 1e-15 && (a[(2, 1)] - large.cos() * small.sin()).abs() < 1e-15);
    assert!((truth.gyro.bias.y.to_degrees() - 0.5 * 1.007_41).abs() < 1e-12);
    assert!((truth.gyro.distortion.row(2).norm() - 1.005_89).abs() < 1e-12);
}

#[test]
fn the_accelerometers_frame_is_a_pure_rotation_away() {
    for seed in 0..50 {
        let mut config = WorldConfig::nominal(seed);
        config.sensor.truth.gyro_g_sensitivity = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0) * 1e-5;
        let truth = World::new(&config).unwrap().truth().unwrap();
        let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
        let rotation = matrix(truth.rotation_accelerometer_from_box);
        let (b, a) = (truth.in_box, truth.in_accelerometer_frame);
        let accel = matrix(a.accelerometer.correction);
        assert!((rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-14 && rotation.determinant() > 0.0);
        assert_eq!([accel[(0, 1)], accel[(0, 2)], accel[(1, 2)]], [0.0; 3], "lower-triangular");
        assert!(accel.diagonal().min() > 0.9);
        // Round trip: back in the box frame everything is as it was.
        let back = |rows| rotation.transpose() * matrix(rows);
        assert!((back(a.accelerometer.correction) - matrix(b.accelerometer.correction)).norm() < 1e-14);
        assert!((back(a.gyroscope.correction) - matrix(b.gyroscope.correction)).norm() < 1e-14);
        let g = |frame: Option<[[f64; 3]; 3]>| matrix(frame.unwrap());
        let g_back = g(a.gyroscope.g_sensitivity_rad_s_per_mps2) * rotation;
        assert!((g_back - g(b.gyroscope.g_sensitivity_rad_s_per_mps2)).norm() < 1e-16);
        assert!((rotation * Vector3::from(b.lever_arm_m) - Vector3::from(a.lever_arm_m)).norm() < 1e-15);
        // x along the accelerometer's own x axis.
        let x_axis_b = config.sensor.truth.accel.distortion.row(0).transpose().normalize();
        assert!((rotation * x_axis_b - Vector3::x()).norm() < 1e-14);
    }
}

#[test]
fn truth_json_has_the_contracts_names() {
    let truth: Truth = still_world(|_| {}).truth().unwrap();
    let json = serde_json::to_value(&truth).unwrap();
    assert_eq!(json["format"], "tumble-truth");
    assert_eq!(json["model"], "ideal = correction * (raw - bias)");
    assert_eq!(json["frame"], "box");
    assert_eq!(json["accelerometer"]["bias_mps2"].as_array().unwrap().len(), 3);
    assert_eq!(json["gyroscope"]["correction"][2].as_array().unwrap().len(), 3);
    assert!(json["gyroscope"]["bias_rad_s"][0].is_f64());
    assert!(json["gyroscope"]["g_sensitivity_rad_s_per_mps2"].is_null());
    assert_eq!(json["in_accelerometer_frame"]["frame"], "accelerometer");
    assert_eq!(json["setting"]["up_normals"].as_array().unwrap().len(), 6);
    assert_eq!(json["lever_arm_m"], serde_json::json!([0.03, 0.02, 0.01]));
}

#[test]
fn the_truth_follows_ramps_and_random_walks() {
    let mut world = still_world(|sensor| {
        sensor.noise = Noise::NONE;
        sensor.truth = SensorTruth::ideal();
        sensor.drift = Drift {
            gyro: BiasDrift { ramp_per_s: Vector3::new(1e-5, 0.0, 0.0), random_walk_per_rts: 2e-5, instability: 1e-5 },
            accel: BiasDrift { random_walk_per_rts: 1e-4, ..BiasDrift::default() },
        };
        sensor.thermal = Thermal {
            ramp_degc_per_s: 0.01,
            gyro_bias_per_degc: Vector3::new(0.0, 1e-3, 0.0),
            gyro_scale_per_degc: Vector3::new(0.0, 0.0, 1e-3),
            ..Thermal::constant(25.0)
        };
    });
    let ideal = world.ideal(0.0);
    let samples = record(&mut world, 50.0, 200.0);
    let truth = world.truth().unwrap();
    let mean = |f: fn(&Sample) -> Vector3<f64>| samples.iter().map(f).sum::<Vector3<f64>>() / samples.len() as f64;
    let gyro = mean(|s| s.angular_rate_rad_s) - ideal.angular_rate_rad_s;
    let accel = mean(|s| s.specific_force_mps2) - ideal.specific_force_mps2;
    // The truth remembers the walk once a second; between, it moves by some 2e-5.
    assert!((gyro - Vector3::from(truth.in_box.gyroscope.bias_rad_s)).norm() < 1e-5, "{gyro}");
    assert!((accel - Vector3::from(truth.in_box.accelerometer.bias_mps2)).norm() < 5e-5);
    assert!((gyro.y - 1e-3).abs() < 3e-4, "1 °C on average at 1e-3 rad/s/°C");
    assert!((truth.in_box.gyroscope.correction[2][2] - 1.0 / 1.001).abs() < 1e-6);
    assert!((samples.last().unwrap().temperature_degc - 27.0).abs() < 0.01);
    let late = world.truth_between(190.0, 200.0).unwrap();
    assert!(late.in_box.gyroscope.bias_rad_s[1] > truth.in_box.gyroscope.bias_rad_s[1]);
}

#[test]
fn quantisation_rounds_and_clips() {
    let range = Quantisation { gyro_range_dps: 250.0, accel_range_g: 2.0 };
    let rate = range.gyro(&Vector3::new(0.011, 300.0, -300.0).map(f64::to_radians)).map(f64::to_degrees);
    assert!((rate - Vector3::new(1.0 / 131.0, 32767.0 / 131.0, -32768.0 / 131.0)).norm() < 1e-9, "{rate}");
    let force = range.accel(&Vector3::new(9.80665, 0.0, 30.0)) / 9.80665;
    assert!((force - Vector3::new(1.0, 0.0, 32767.0 / 16384.0)).norm() < 1e-12);
}

#[test]
fn the_delay_shows_the_motion_of_then() {
    use tumble_sim::{Direction, Primitive};
    let mut world = still_world(|sensor| {
        sensor.noise = Noise::NONE;
        sensor.truth = SensorTruth::ideal();
        sensor.delay.gyro_s = 0.1;
    });
    world.motion.push(0.0, Primitive::full_turn(Direction::Ccw, 8.0));
    let then = world.ideal(0.5).angular_rate_rad_s;
    assert!((world.sample(0.6).angular_rate_rad_s - then).norm() < 1e-15);
}

#[test]
fn bad_settings_are_named() {
    let mut config = WorldConfig::nominal(1);
    config.sensor.rate_hz = 0.0;
    assert!(World::new(&config).unwrap_err().to_string().contains("rate_hz"));
    let mut config = WorldConfig::nominal(1);
    config.sensor.truth.accel.distortion.fill_row(1, 0.0);
    assert!(World::new(&config).unwrap_err().to_string().contains("distortion"));
    let mut config = WorldConfig::nominal(1);
    config.sensor.noise.gyro_dps_rthz = f64::NAN;
    assert!(World::new(&config).is_err());
}
