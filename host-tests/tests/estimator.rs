//! The estimator over simulated sessions: how large its errors are, and whether its sigmas are true.
//!
//! Limits are about 1.5 times what was measured over 100 seeds (docs/method.md); seeds are fixed, so nothing here is chance.

use host_tests::sim::{Deviation, is_gyro_cross, is_gyro_scale, session, spread};
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_sim::motion::Stops;
use tumble_sim::scheme::Imperfection;
use tumble_sim::{Scheme, SchemeConfig};

const SEEDS: std::ops::Range<u64> = 0..12;

fn deviations(
    scheme: Scheme,
    stops: TurnStops,
    faces: BoxFaces,
    change: impl Fn(SchemeConfig) -> SchemeConfig,
) -> Vec<Deviation> {
    SEEDS.flat_map(|seed| session(&change(SchemeConfig::new(scheme, seed)), stops, faces).deviations()).collect()
}

/// Sigmas are true if squares over sigma squared are 1 on average and 95 % lie within two sigma; parameters of a session are
/// correlated, so the bands are wider than those of independent draws.
fn assert_honest(deviations: &[Deviation]) {
    let within = deviations.iter().filter(|d| d.error.abs() < 2.0 * d.sigma).count() as f64 / deviations.len() as f64;
    assert!((0.90..=0.995).contains(&within), "{:.1} % within 2 sigma", within * 100.0);
    let (_, normalised) = spread(deviations, |_| true);
    assert!((0.5..=1.5).contains(&normalised), "mean square over sigma square {normalised:.2}");
    let worst = deviations.iter().max_by(|a, b| (a.error / a.sigma).abs().total_cmp(&(b.error / b.sigma).abs()));
    let worst = worst.expect("not empty");
    assert!((worst.error / worst.sigma).abs() < 5.0, "{worst:?}");
}

fn assert_gyro(deviations: &[Deviation], scale_ppm: f64, cross_urad: f64) {
    let (scale, _) = spread(deviations, is_gyro_scale);
    let (cross, _) = spread(deviations, is_gyro_cross);
    println!("scale {:.0} ppm, cross-axis {:.0} urad", scale * 1e6, cross * 1e6);
    assert!(scale * 1e6 < scale_ppm, "scale {:.0} ppm", scale * 1e6);
    assert!(cross * 1e6 < cross_urad, "cross-axis {:.0} urad", cross * 1e6);
}

#[test]
fn both_directions_against_a_fence_in_a_square_box() {
    let deviations = deviations(Scheme::Double, TurnStops::Fenced, BoxFaces::Square, |config| config);
    assert_gyro(&deviations, 120.0, 100.0);
    assert_honest(&deviations);
}

#[test]
fn exact_turns_reach_scale_far_below_what_a_fence_allows() {
    let deviations = deviations(Scheme::Double, TurnStops::Fenced, BoxFaces::Square, |mut config| {
        config.world.motion.hands.stops = Stops::Exact;
        config
    });
    assert_gyro(&deviations, 55.0, 95.0);
    assert_honest(&deviations);
}

#[test]
fn turns_by_hand_carry_their_own_sigma() {
    let by_hand = |config: SchemeConfig| config.with(Imperfection::ByHand(2.0));
    let deviations = deviations(Scheme::Double, TurnStops::ByHand, BoxFaces::Square, by_hand);
    assert_gyro(&deviations, 250.0, 110.0);
    assert_honest(&deviations);
}

#[test]
fn without_a_box_the_accelerometer_gives_the_frame() {
    let deviations = deviations(Scheme::Double, TurnStops::Fenced, BoxFaces::Unknown, |config| config);
    assert_gyro(&deviations, 140.0, 190.0);
    assert_honest(&deviations);
}

#[test]
fn generic_poses_without_any_turn_calibrate_too() {
    let deviations = deviations(Scheme::MultiPose { poses: 17 }, TurnStops::ByHand, BoxFaces::Unknown, |config| config);
    assert_gyro(&deviations, 170.0, 220.0);
    assert_honest(&deviations);
}

#[test]
fn single_turns_are_the_papers_scheme() {
    let deviations = deviations(Scheme::Single, TurnStops::Fenced, BoxFaces::Square, |config| config);
    assert_gyro(&deviations, 150.0, 130.0);
    assert_honest(&deviations);
}

#[test]
fn the_same_session_gives_the_same_numbers() {
    let config = SchemeConfig::new(Scheme::Double, 3);
    let [a, b] = [(); 2].map(|()| session(&config, TurnStops::Fenced, BoxFaces::Square).estimate);
    assert_eq!(a.calibration, b.calibration);
}
