//! What counts as rest: noise does, a steady turn never, and a still holds nothing of the motion beside it.

use nalgebra::Vector3;
use tumble_core::motion::means::mean_rate;
use tumble_core::motion::segmenter::Segmenter;
use tumble_core::sample::Sample;
use tumble_core::tape::{Exclusion, Kind, Segment, Tape};
use tumble_sim::rng::{Purpose, Rng};

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// One sample's noise of an MPU9250 in 41 Hz: 0.08 °/s and 2.4 mg.
const RATE_NOISE: f64 = 0.08 * DEGREE;
const FORCE_NOISE: f64 = 2.4e-3 * 9.80665;

type Memory = Tape<30_000, 400>;

/// Feeds samples at 200 Hz whose rate and specific force (ideal, °/s and m/s²) are functions of time.
fn segments(seconds: f64, scale: f64, seed: u64, motion: impl Fn(f64) -> (Vector3<f64>, Vector3<f64>)) -> Box<Memory> {
    let mut tape = Box::new(Memory::new());
    let mut segmenter = Segmenter::new(1.0);
    let mut rng = Rng::new(seed, Purpose::Noise);
    for k in 0..(seconds * 200.0) as u64 {
        let (rate_dps, force) = motion(k as f64 * 0.005);
        let noise = |rng: &mut Rng, sigma: f64| Vector3::from_fn(|_, _| rng.normal() * sigma * scale);
        let sample = Sample {
            t_us: 1000 + k * 5000,
            angular_rate_rad_s: (rate_dps * DEGREE + noise(&mut rng, RATE_NOISE)).cast(),
            specific_force_mps2: (force + noise(&mut rng, FORCE_NOISE)).cast(),
            temperature_degc: 25.0,
        };
        segmenter.step(&sample, 0, &mut tape);
    }
    segmenter.finish(&mut tape);
    tape
}

fn up() -> Vector3<f64> {
    Vector3::new(0.1, -0.2, 9.8)
}

fn stills(tape: &Memory) -> Vec<&Segment> {
    tape.segments().iter().filter(|segment| matches!(segment.kind, Kind::Still { .. })).collect()
}

#[test]
fn an_hour_of_noise_is_one_still() {
    // 14 400 blocks at a false-alarm rate of 1e-6 each, and four tests a block: one interruption in 17 runs.
    let tape = segments(3600.0, 1.0, 1, |_| (Vector3::new(3.0, -2.0, 1.0), up()));
    assert_eq!(stills(&tape).len(), 1, "{:?}", tape.segments());
    assert!(stills(&tape)[0].duration_s() > 3598.0);
}

#[test]
fn a_steady_turn_is_never_still() {
    for (seed, rate) in [0.8, 1.5, 3.0, 6.0, 12.0, 36.0, 90.0].into_iter().enumerate() {
        let tape = segments(60.0, 1.0, seed as u64, |t| {
            let turning = if t > 5.0 { rate } else { 0.0 };
            (Vector3::new(1.0, -0.5, 2.0 + turning), up())
        });
        let stills = stills(&tape);
        assert_eq!(stills.len(), 1, "{rate} deg/s: {:?}", tape.segments());
        assert!(stills[0].end_us < 5_100_000, "{rate} deg/s");
    }
}

#[test]
fn a_steady_turn_before_any_rest_is_struck_out_once_a_rest_disproves_it() {
    for rate in [4.0, 8.0, 15.0] {
        let tape = segments(40.0, 1.0, 7, |t| (Vector3::new(0.5, 0.2, if t < 20.0 { rate } else { 0.3 }), up()));
        let usable: Vec<_> = stills(&tape).into_iter().filter(|s| s.exclusion == Exclusion::None).collect();
        assert_eq!(usable.len(), 1, "{rate} deg/s: {:?}", tape.segments());
        assert!(usable[0].start_us > 20_000_000);
    }
}

#[test]
fn a_steady_turn_on_crooked_axes_or_a_lean_is_no_jump_of_the_bias() {
    // Crooked axes show a tenth of the rate across gravity, which stands still; about a leaning axis gravity turns.
    for (seed, rate) in [1.0, 3.0, 9.0].into_iter().enumerate() {
        let crooked = segments(60.0, 1.0, seed as u64, |t| {
            let turning = if t > 5.0 { rate } else { 0.0 };
            (Vector3::new(1.0 + 0.1 * turning, -0.5, 2.0 + turning), up())
        });
        assert_eq!(stills(&crooked).len(), 1, "{rate} deg/s: {:?}", crooked.segments());
        let leaning = segments(60.0, 1.0, seed as u64, |t| {
            let (turning, angle) = if t > 5.0 { (rate, rate * DEGREE * (t - 5.0)) } else { (0.0, 0.0) };
            (Vector3::new(1.0 + turning, -0.5, 2.0), Vector3::new(0.0, angle.sin(), angle.cos()) * 9.8)
        });
        assert!(stills(&leaning).iter().all(|still| still.end_us < 5_600_000), "{:?}", leaning.segments());
        assert_eq!([&crooked, &leaning].map(|tape| tape.bias_jumps.total_rad_s.norm()), [0.0; 2]);
    }
}

#[test]
fn a_bias_that_jumps_at_rest_is_told_and_taken_out() {
    for (seed, jump) in [[0.7, 0.0, 0.0], [0.0, -1.5, 1.0], [3.0, 3.0, -3.0]].into_iter().enumerate() {
        let bias =
            |t: f64| Vector3::new(1.0, -0.5, 2.0) + if t > 10.0 { Vector3::from(jump) } else { Vector3::zeros() };
        let tape = segments(20.0, 1.0, seed as u64, |t| (bias(t), up()));
        let rests = stills(&tape);
        assert_eq!(rests.len(), 2, "{jump:?}: {:?}", tape.segments());
        assert!(rests.iter().all(|rest| rest.exclusion == Exclusion::None), "{jump:?}: {:?}", tape.segments());
        assert!(rests[1].start_us < 13_000_000, "{jump:?}: {:?}", tape.segments());
        let found = tape.bias_jumps.total_rad_s.cast::<f64>() / DEGREE;
        assert!((found - Vector3::from(jump)).amax() < 0.04, "{found} for {jump:?}");
        // What is on the tape is as if nothing had happened.
        let [before, after] = [rests[0], rests[1]].map(|rest| mean_rate(&tape, rest.first.into(), rest.end.into()));
        assert!((after - before).amax() < 0.04 * DEGREE as f32, "{before} {after}");
    }
}

#[test]
fn trembling_like_the_noise_is_rest_and_shaking_is_not() {
    let tremor = |t: f64, dps: f64| (Vector3::new(dps * (55.0 * t).sin(), 0.0, dps * (70.0 * t).cos()), up());
    let quiet = segments(30.0, 1.0, 3, |t| tremor(t, if t > 10.0 { 0.15 } else { 0.0 }));
    assert_eq!(stills(&quiet).len(), 1, "{:?}", quiet.segments());
    let shaken = segments(30.0, 1.0, 3, |t| tremor(t, if t > 10.0 { 3.0 } else { 0.0 }));
    assert!(stills(&shaken).iter().all(|still| still.end_us < 10_100_000), "{:?}", shaken.segments());
}

#[test]
fn a_still_holds_nothing_of_a_turn_that_starts_and_ends_gently() {
    // 3 s of rest, a turn whose rate rises and falls as sin², rest again; both stills' mean rates must be the offset.
    let turn = |t: f64| {
        if (3.0..13.0).contains(&t) { 72.0 * (std::f64::consts::PI * (t - 3.0) / 10.0).sin().powi(2) } else { 0.0 }
    };
    for seed in 0..20 {
        let tape = segments(16.0, 1.0, seed, |t| (Vector3::new(1.0, -0.5, 2.0 + turn(t)), up()));
        let stills = stills(&tape);
        assert_eq!(stills.len(), 2, "{:?}", tape.segments());
        for still in stills {
            let rate = mean_rate(&tape, still.first.into(), still.end.into());
            let error = f64::from(rate.z) / DEGREE - 2.0;
            // Noise of the mean over 2 s at 0.08 °/s white: 4 mdps; 5 sigma, and 5 mdps for the turn.
            assert!(error.abs() < 0.025, "seed {seed}: {error} deg/s in {still:?}");
        }
    }
}

#[test]
fn a_slow_tilt_without_any_gyroscope_signal_is_no_rest() {
    // A gyroscope axis that is dead does not make a slow roll a rest: gravity wanders.
    let tape = segments(20.0, 1.0, 5, |t| {
        let angle = if t > 5.0 { 3.0 * DEGREE * (t - 5.0) } else { 0.0 };
        (Vector3::zeros(), Vector3::new(0.0, angle.sin(), angle.cos()) * 9.8)
    });
    assert!(stills(&tape).iter().all(|still| still.end_us < 5_600_000), "{:?}", tape.segments());
}

#[test]
fn quiet_and_noisy_sensors_find_their_own_floor() {
    for scale in [0.1, 0.5, 2.0] {
        let tape = segments(60.0, scale, 11, |t| {
            let shake = if (20.0..40.0).contains(&t) { 40.0 * (9.0 * t).sin() } else { 0.0 };
            (Vector3::new(shake, 0.0, -shake), up())
        });
        assert_eq!(stills(&tape).len(), 2, "{scale}: {:?}", tape.segments());
    }
}
