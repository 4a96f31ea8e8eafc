//! What the sensor does wrong, against its equation.

use crate::common::{G, Pair, dps, mg, none, short};
use nalgebra::{Matrix3, Vector3};
use tumble_sim::Sample;

/// The largest component is the magnitude and the others have 30 % of it or more.
fn is_spread(vector: &Vector3<f64>, magnitude: f64) {
    assert!((vector.amax() - magnitude).abs() < 1e-12 * magnitude, "{vector}");
    assert!(vector.iter().all(|v| v.abs() >= 0.3 * magnitude - 1e-12), "{vector}");
}

#[test]
fn specific_force_moves_the_gyro() {
    let pair = Pair::quiet("gyro_g_sensitivity=0.2");
    let axes = ["x", "y", "z"];
    let matrix = Matrix3::from_fn(|i, j| pair.parameter(&format!("g_{}{}", axes[i], axes[j])));
    assert!((matrix.norm() - 0.2).abs() < 1e-12);
    let world = &pair.without.world;
    pair.check(|t| matrix * world.ideal(t).specific_force_mps2 * dps(1.0) / G, none);
    assert!(pair.with.truth.in_box.gyroscope.g_sensitivity_rad_s_per_mps2.is_some());

    let pair = Pair::quiet("gyro_g_squared=0.3");
    let c = pair.vector("c");
    is_spread(&c, 0.3);
    let world = &pair.without.world;
    pair.check(|t| (world.ideal(t).specific_force_mps2 / G).map(|f| f * f).component_mul(&c) * dps(1.0), none);
}

#[test]
fn the_gyro_bends() {
    let degrees = |pair: &Pair, t: f64| pair.without.world.ideal(t).angular_rate_rad_s.map(f64::to_degrees);
    let pair = Pair::quiet("gyro_scale_quadratic=20");
    let k = pair.vector("k");
    is_spread(&k, 20.0);
    pair.check(|t| degrees(&pair, t).zip_map(&k, |w, k| dps(k * 1e-6 * w * w)), none);

    let pair = Pair::quiet("gyro_scale_cubic=1000");
    let k = pair.vector("k_at_100_dps");
    is_spread(&k, 1000.0);
    pair.check(|t| degrees(&pair, t).zip_map(&k, |w, k| dps(k * 1e-6 * w * w * w / 1e4)), none);

    let pair = Pair::quiet("gyro_scale_asymmetry=500");
    let k = pair.vector("scale_positive_less_negative");
    is_spread(&k, 500.0);
    pair.check(|t| degrees(&pair, t).zip_map(&k, |w, k| dps(0.5 * k * 1e-6 * w.abs())), none);

    let pair = Pair::quiet("gyro_dead_zone=0.4");
    pair.check(|t| degrees(&pair, t).map(|w| if w.abs() < 0.4 { dps(-w) } else { dps(-0.4 * w.signum()) }), none);
}

#[test]
fn the_accelerometer_bends() {
    for (word, power, peak) in [("accel_quadratic=4", 2, 4.0), ("accel_cubic=7", 3, 7.0)] {
        let pair = Pair::quiet(word);
        let k = pair.vector("k");
        is_spread(&k, peak);
        let world = &pair.without.world;
        pair.check(none, |t| (world.ideal(t).specific_force_mps2 / G).zip_map(&k, |f, k| mg(k * f.powi(power))));
    }
}

#[test]
fn readings_clip_and_come_in_steps() {
    let clipped = |word: &str, level: f64, of: fn(&Sample) -> Vector3<f64>| {
        let pair = Pair::of(short(3), word);
        let mut clipped = 0;
        for (with, without) in pair.samples() {
            assert!((of(with) - of(without).map(|v| v.clamp(-level, level))).norm() < 1e-12);
            clipped += usize::from(of(with) != of(without));
        }
        assert_eq!(pair.parameter("samples_clipped") as usize, clipped);
        assert!(clipped > 100, "{word}: {clipped}");
    };
    clipped("gyro_saturation=50", dps(50.0), |s| s.angular_rate_rad_s);
    clipped("accel_saturation=0.95", 0.95 * G, |s| s.specific_force_mps2);

    let pair = Pair::of(short(3), "gyro_coarse_quantization=0.5");
    for (with, without) in pair.samples() {
        let steps = with.angular_rate_rad_s.map(|w| w.to_degrees() / 0.5);
        assert!((steps - steps.map(f64::round)).amax() < 1e-9);
        assert!((with.angular_rate_rad_s - without.angular_rate_rad_s).amax() <= dps(0.25) + 1e-12);
    }
}

#[test]
fn parameters_follow_the_temperature() {
    for (id, unit) in [("gyro_bias_temperature", dps(1.0)), ("accel_bias_temperature", mg(1.0))] {
        let pair = Pair::quiet(&format!("{id}=0.5"));
        let slope = pair.vector("slope");
        is_spread(&slope, 0.5);
        let at = |t: f64| slope * (unit * (pair.with.world.sensor().config().thermal.at(t) - 25.0));
        if id.starts_with("gyro") {
            pair.check(at, none)
        } else {
            pair.check(none, at)
        }
        let degrees = || pair.with.samples.iter().map(|sample| sample.temperature_degc);
        let swing = degrees().fold(f64::MIN, f64::max) - degrees().fold(f64::MAX, f64::min);
        assert!((1.0..8.5).contains(&swing), "{id}: the column moves by {swing} degC");
    }
    for id in ["gyro_scale_temperature", "accel_scale_temperature"] {
        let pair = Pair::quiet(&format!("{id}=300"));
        let slope = pair.vector("slope") * 1e-6;
        is_spread(&slope, 300e-6);
        let truth = pair.without.world.sensor().config().truth;
        let warmer = |t: f64| pair.with.world.sensor().config().thermal.at(t) - 25.0;
        let ideal = |t: f64| pair.without.world.ideal(t);
        let rate = |t: f64| slope.component_mul(&(truth.gyro.distortion * ideal(t).angular_rate_rad_s)) * warmer(t);
        let force = |t: f64| slope.component_mul(&(truth.accel.distortion * ideal(t).specific_force_mps2)) * warmer(t);
        if id.starts_with("gyro") { pair.check(rate, none) } else { pair.check(none, force) }
    }
}

#[test]
fn biases_move_of_themselves() {
    let pair = Pair::quiet("gyro_warm_up=0.3");
    let (bias, tau_s) = (pair.vector("decaying_bias"), pair.parameter("time_constant"));
    assert!((bias.norm() - 0.3).abs() < 1e-12 && (20.0..100.0).contains(&tau_s));
    pair.check(|t| bias * dps((-t / tau_s).exp()), none);

    let pair = Pair::quiet("accel_warm_up=3");
    let (bias, tau_s) = (pair.vector("decaying_bias"), pair.parameter("time_constant"));
    assert!((bias.norm() - 3.0).abs() < 1e-12 && (20.0..100.0).contains(&tau_s));
    pair.check(none, |t| bias * mg((-t / tau_s).exp()));

    for (id, unit) in [("gyro_bias_step", dps(1.0)), ("accel_bias_step", mg(1.0))] {
        let pair = Pair::quiet(&format!("{id}=0.7"));
        let (step, time_s) = (pair.vector("step"), pair.parameter("step_time"));
        assert!((step.norm() - 0.7).abs() < 1e-12 && (11.0..46.0).contains(&time_s));
        let at = |t: f64| if t >= time_s { step * unit } else { Vector3::zeros() };
        if id.starts_with("gyro") { pair.check(at, none) } else { pair.check(none, at) }
    }

    for (id, unit) in [("gyro_bias_random_walk", dps(1.0)), ("accel_bias_random_walk", mg(1.0))] {
        let pair = Pair::quiet(&format!("{id}=0.02"));
        let added: Vec<_> = pair.added().map(|(_, rate, force)| rate + force).collect();
        let power: f64 = added.windows(2).map(|pair| (pair[1] - pair[0]).norm_squared()).sum();
        let density = (power / (3.0 * added.len() as f64) * 200.0).sqrt() / unit;
        // 34 000 increments: 0.4 % of sigma.
        assert!((density / 0.02 - 1.0).abs() < 0.016, "{id}: {density}");
        assert_eq!(added[0], Vector3::zeros());
    }
}

#[test]
fn axes_and_ranges_are_not_what_they_say() {
    let columns = |s: &Sample| [s.angular_rate_rad_s, s.specific_force_mps2];
    for variant in 1..=4 {
        let pair = Pair::of(short(5), &format!("axis_mapping={variant}"));
        let axis = (0..3).find(|&k| [0.0, 1.0, 2.0][k] == pair.with.truth.effects[0].parameters[0].value).unwrap();
        let (changed, kept) = if variant <= 2 { (0, 1) } else { (1, 0) };
        for (with, without) in pair.samples() {
            assert_eq!(columns(with)[kept], columns(without)[kept]);
            let mut expected = columns(without)[changed];
            if variant % 2 == 0 {
                expected[axis] = -expected[axis];
            } else {
                expected.swap_rows((axis + 1) % 3, (axis + 2) % 3);
            }
            assert_eq!(columns(with)[changed], expected);
        }
    }
    let pair = Pair::of(short(5), "wrong_full_scale=0.5");
    let triad = pair.parameter("triad") as usize;
    for (with, without) in pair.samples() {
        assert_eq!(columns(with)[triad], columns(without)[triad] * 0.5);
        assert_eq!(columns(with)[1 - triad], columns(without)[1 - triad]);
    }
}
