//! Sensors far quieter and far noisier than the MPU9250's sheet: the arithmetic holds, the session is accepted, sigmas are true.

use host_tests::sim::session;
use nalgebra::{DMatrix, DVector};
use tumble::study::summary::chi_square_over_dof;
use tumble_core::calibration::Verdict;
use tumble_core::estimate::{PARAMETERS, judge};
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_sim::scheme::Imperfection;
use tumble_sim::sensor::Quantisation;
use tumble_sim::{Scheme, SchemeConfig};

/// Of the sheet's noise.
const NOISE: [f64; 5] = [0.01, 0.05, 0.2, 1.0, 10.0];
/// Other seeds than those of `estimator.rs`.
const SEEDS: std::ops::Range<u64> = 2001..2007;
/// Standard normal quantile of a false alarm in ten thousand, five cells of noise and five sessions being tried.
const QUANTILE: f64 = 3.72;

/// `eᵀ P⁻¹ e` and its degrees of freedom. What the frame defines has no variance.
fn squares(config: &SchemeConfig, stops: TurnStops, faces: BoxFaces) -> (f64, f64) {
    let session = session(config, stops, faces);
    let (judgement, _) = judge::judge(&session.estimate, &session.tape, 0);
    assert_ne!(judgement.verdict, Verdict::Rejected, "seed {}: {:?}", config.world.seed, judgement.reasons);
    let covariance = session.estimate.covariance.cast::<f64>();
    let known: Vec<usize> = (0..PARAMETERS).filter(|&i| covariance[(i, i)] > 0.0).collect();
    let sigma: Vec<f64> = known.iter().map(|&i| covariance[(i, i)].sqrt()).collect();
    let count = known.len();
    let correlation = DMatrix::from_fn(count, count, |i, j| covariance[(known[i], known[j])] / (sigma[i] * sigma[j]));
    let errors = session.errors();
    let error = DVector::from_fn(count, |i, _| errors[known[i]] / sigma[i]);
    let solved = correlation.cholesky().expect("a positive definite covariance").solve(&error);
    (error.dot(&solved), count as f64)
}

/// χ²_ν/ν over all seeds. Above, the chi-square's own limit. Below, sigmas may be too wide by `widened`: the tape's rounding is
/// taken for white noise, and stops, wobble and faces have priors that a quiet sensor does not narrow further.
fn assert_true(name: &str, noise: f64, widened: f64, run: impl Fn(&SchemeConfig) -> (f64, f64), scheme: Scheme) {
    let (mut sum, mut dof) = (0.0, 0.0);
    for seed in SEEDS {
        let mut config = SchemeConfig::new(scheme, seed);
        config.world.sensor.noise.gyro_dps_rthz *= noise;
        config.world.sensor.noise.accel_ug_rthz *= noise;
        let (squares, own) = run(&config);
        sum += squares;
        dof += own;
    }
    let mean = sum / dof;
    println!("{name}, noise x {noise}: {mean:.2}");
    let (least, most) = (chi_square_over_dof(dof, -QUANTILE), chi_square_over_dof(dof, QUANTILE));
    assert!(mean < most, "{name}, noise x {noise}: {mean:.2} > {most:.2}");
    assert!(mean > least / (widened * widened), "{name}, noise x {noise}: {mean:.2} is too small");
}

fn over_the_grid(name: &str, scheme: Scheme, stops: TurnStops, faces: BoxFaces, change: Option<Imperfection>) {
    for noise in NOISE {
        let widened = if noise < 1.0 { 2.0 } else { 1.3 };
        let run = |config: &SchemeConfig| {
            let config = config.clone();
            squares(&change.map_or(config.clone(), |change| config.with(change)), stops, faces)
        };
        assert_true(name, noise, widened, run, scheme);
    }
}

#[test]
fn single_turns_in_a_square_box() {
    over_the_grid("single", Scheme::Single, TurnStops::Fenced, BoxFaces::Square, None);
}

#[test]
fn both_directions_in_a_square_box() {
    over_the_grid("double", Scheme::Double, TurnStops::Fenced, BoxFaces::Square, None);
}

#[test]
fn turns_by_hand_in_a_square_box() {
    let by_hand = Some(Imperfection::ByHand(2.0));
    over_the_grid("by hand", Scheme::Double, TurnStops::ByHand, BoxFaces::Square, by_hand);
}

#[test]
fn both_directions_without_a_box() {
    over_the_grid("unknown", Scheme::Double, TurnStops::Fenced, BoxFaces::Unknown, None);
}

#[test]
fn generic_poses() {
    let scheme = Scheme::MultiPose { poses: 17 };
    over_the_grid("poses", scheme, TurnStops::ByHand, BoxFaces::Unknown, None);
}

/// Noise over step of 0.06 and 0.25 (1/20 and 1/5 of the sheet's noise at ±2000 °/s): the mean of a rest is off by a good part of a step,
/// and the bias's sigma says so. It was 16 and 20 times too small.
#[test]
fn a_sensor_coarser_than_its_noise_knows_its_bias_no_better_than_that() {
    for noise in [0.05, 0.2] {
        let (mut sum, mut dof) = (0.0, 0.0);
        for seed in SEEDS {
            let mut config = SchemeConfig::new(Scheme::Single, seed);
            config.world.sensor.noise.gyro_dps_rthz *= noise;
            config.world.sensor.noise.accel_ug_rthz *= noise;
            config.world.sensor.quantisation = Some(Quantisation { gyro_range_dps: 2000.0, accel_range_g: 16.0 });
            let session = session(&config, TurnStops::Fenced, BoxFaces::Square);
            for deviation in session.deviations().iter().filter(|deviation| deviation.name.starts_with("gyro_bias")) {
                sum += (deviation.error / deviation.sigma).powi(2);
                dof += 1.0;
            }
        }
        let (mean, most) = (sum / dof, chi_square_over_dof(dof, QUANTILE));
        println!("bias of a coarse sensor, noise x {noise}: {mean:.2} of {dof} numbers");
        assert!(mean > 0.1 && mean < most, "noise x {noise}: {mean:.2}, at most {most:.2}");
    }
}
