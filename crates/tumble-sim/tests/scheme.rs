//! The schemes: lengths, content, determinism, imperfections.

use nalgebra::Vector3;
use std::f64::consts::TAU;
use tumble_sim::motion::{Kind, Stops};
use tumble_sim::scheme::{Imperfection, Stamps, TurnOrder};
use tumble_sim::sensor::Noise;
use tumble_sim::{Scheme, SchemeConfig};

const ALL: [Scheme; 5] = [
    Scheme::Single,
    Scheme::Double,
    Scheme::MultiPose { poses: 17 },
    Scheme::Quarter,
    Scheme::Tumble { duration_s: 65.0, violence: 1.0 },
];

#[test]
fn lengths_are_as_stated() {
    for scheme in ALL {
        let config = SchemeConfig::new(scheme, 1);
        let recording = config.record().unwrap();
        let last = recording.samples.last().unwrap().t_s;
        assert!((last - config.duration_s()).abs() < 0.6, "{}: {last} s", scheme.name());
        assert!(Scheme::parse(scheme.name()) == Some(scheme));
        assert!(recording.samples.iter().all(|s| s.specific_force_mps2.norm().is_finite()));
    }
    assert_eq!(SchemeConfig::new(Scheme::Single, 1).duration_s(), 200.0);
    assert_eq!(SchemeConfig::new(Scheme::Double, 1).duration_s(), 194.0);
    assert!(Scheme::parse("triple").is_none());
}

#[test]
fn the_same_seed_gives_the_same_recording() {
    let mut config = SchemeConfig::new(Scheme::Quarter, 42);
    let first = config.record().unwrap();
    assert_eq!(first.samples, config.record().unwrap().samples);
    config.world.seed = 43;
    assert_ne!(first.samples, config.record().unwrap().samples);
}

#[test]
fn single_turns_follow_the_paper_or_the_view_from_above() {
    let signs = |order: TurnOrder| {
        let mut config = SchemeConfig::new(Scheme::Single, 1);
        config.turns = order;
        let world = config.record().unwrap().world;
        let turns = world.motion.segments().iter().filter(|s| s.kind() == Kind::Turn);
        turns.map(|s| s.turned_rad().signum()).collect::<Vec<_>>()
    };
    assert_eq!(signs(TurnOrder::Paper), [1.0, -1.0, 1.0, -1.0, 1.0, -1.0]);
    assert_eq!(signs(TurnOrder::SameFromAbove), [1.0; 6]);
}

/// Integrates what the sensor says over each turn, with its true parameters taken out.
#[test]
fn corrected_raw_data_integrate_to_the_turns() {
    let mut config = SchemeConfig::new(Scheme::Double, 3);
    config.world.sensor.noise = Noise::NONE;
    let recording = config.record().unwrap();
    let truth = recording.truth.in_box;
    let correction = nalgebra::Matrix3::from_fn(|i, j| truth.gyroscope.correction[i][j]);
    let mut turns = 0;
    for segment in recording.world.motion.segments().iter().filter(|s| s.kind() == Kind::Turn) {
        let within = recording.samples.iter().filter(|s| s.t_s >= segment.start_s && s.t_s < segment.end_s());
        let bias = Vector3::from(truth.gyroscope.bias_rad_s);
        let sum: Vector3<f64> = within.map(|s| correction * (s.angular_rate_rad_s - bias) / 200.0).sum();
        // The Earth adds at most 10 s · 7.3e-5 rad/s.
        assert!((sum.norm() - segment.turned_rad().abs()).abs() < 1e-3, "{} against {}", sum.norm(), TAU);
        turns += 1;
    }
    assert_eq!(turns, 12);
}

#[test]
fn imperfections_arrive() {
    let mut config = SchemeConfig::new(Scheme::Double, 5);
    for imperfection in Imperfection::ALL {
        config = config.with(imperfection);
    }
    let motion = &config.world.motion;
    assert_eq!(motion.hands.wobble_deg, 1.0);
    assert!((motion.shape.lever_b_m.norm() - 0.05).abs() < 1e-12);
    assert!(matches!(motion.hands.stops, Stops::ByHand { .. }) && config.turns_word() == "by-hand");
    let lean = motion.shape.up_normals_b[0].angle(&Vector3::x()).to_degrees();
    assert!(lean > 0.0 && lean < 0.5 * 2f64.sqrt());
    let drift = config.world.sensor.drift.gyro.ramp_per_s * config.duration_s();
    assert!(drift.iter().all(|d| (d.abs().to_degrees() - 0.03).abs() < 1e-12));
    let samples = config.record().unwrap().samples;
    let spacing = samples[1000].t_s - samples[0].t_s;
    assert!((spacing * 202.0 - 1000.0).abs() < 1e-6, "1 % faster, truly stamped");
    config.clock.stamps = Stamps::Nominal;
    let samples = config.record().unwrap().samples;
    assert!((samples[1000].t_s - 5.0).abs() < 1e-12);
    assert_eq!(Imperfection::parse("wobble", Some(2.0)), Some(Imperfection::Wobble(2.0)));
    assert_eq!(Imperfection::parse("nonsense", None), None);
}

#[test]
fn the_papers_recording_has_its_truth() {
    let recording = SchemeConfig::paper(1).record().unwrap();
    let truth = recording.truth;
    assert!((truth.in_box.gyroscope.bias_rad_s[0].to_degrees() - 0.5 * 0.993_91).abs() < 1e-9);
    assert_eq!(truth.setting.tilt_deg, 1.5);
    assert_eq!(truth.in_box.lever_arm_m, [0.0; 3]);
    assert_eq!(recording.samples.len(), 40_001);
}

#[test]
fn bad_times_are_named() {
    let mut config = SchemeConfig::new(Scheme::Single, 1);
    config.timing.still_s = f64::NAN;
    assert!(config.record().unwrap_err().to_string().contains("still_s"));
    let config = SchemeConfig::new(Scheme::Tumble { duration_s: 1e9, violence: 1.0 }, 1);
    assert!(config.record().unwrap_err().to_string().contains("tumble.duration_s"));
}
