//! What table, box and hands do.

use crate::common::{G, Pair, mg, none};
use std::f64::consts::TAU;
use tumble_sim::motion::Kind;

/// The angle between both attitudes at a time, degrees.
fn apart_deg(pair: &Pair, t_s: f64) -> f64 {
    pair.with.world.true_attitude(t_s).angle_to(&pair.without.world.true_attitude(t_s)).to_degrees()
}

#[test]
fn levers() {
    let pair = Pair::quiet("accel_lever_arm=12");
    let lever = pair.with.truth.in_box.lever_arm_m;
    assert!((nalgebra::Vector3::from(lever).norm() - 0.12).abs() < 1e-12);

    let pair = Pair::quiet("accel_internal_lever_arms=10");
    let offsets = ["x", "y", "z"].map(|axis| pair.vector(&format!("offset_of_{axis}")));
    assert!((offsets.iter().map(|offset| offset.norm()).fold(0.0, f64::max) - 10.0).abs() < 1e-9);
    let (world, truth) = (&pair.without.world, pair.without.world.sensor().config().truth.accel.distortion);
    pair.check(none, |t| {
        // The rate relative to the Earth and to inertial space differ by 4 mdps: 1e-9 m/s² here.
        let rate = world.ideal(t).angular_rate_rad_s;
        let accel = world.motion.at(t).spin.accel;
        let at = |offset: &nalgebra::Vector3<f64>| {
            let offset = offset * 1e-3;
            accel.cross(&offset) + rate.cross(&rate.cross(&offset))
        };
        truth * nalgebra::Vector3::new(at(&offsets[0]).x, at(&offsets[1]).y, at(&offsets[2]).z)
    });
}

#[test]
fn turns_stop_short() {
    let mut all = 0;
    for seed in 1..=6 {
        let pair = Pair::of(crate::common::short(seed), "incomplete_turn=5");
        let turns = |r: &tumble_sim::Recording| {
            let turns = r.world.motion.segments().iter().filter(|s| s.kind() == Kind::Turn);
            turns.map(|s| s.turned_rad().to_degrees()).collect::<Vec<_>>()
        };
        let (with, without) = (turns(&pair.with), turns(&pair.without));
        let short = |k: usize| without[k].abs() - with[k].abs();
        let only = pair.parameter("only_turn_number");
        for k in 0..with.len() {
            let expected = if only == 0.0 || only == k as f64 + 1.0 { 5.0 } else { 0.0 };
            assert!((short(k) - expected).abs() < 1e-9, "seed {seed}, turn {k}: {}", short(k));
        }
        all += u32::from(only == 0.0);
    }
    assert!((1..6).contains(&all), "some stop short once, some always: {all}");
}

#[test]
fn the_table_tilts_and_rocks() {
    let pair = Pair::quiet("platform_tilt_change=0.4");
    let (time_s, end_s) = (pair.parameter("time"), pair.with.samples.last().unwrap().t_s);
    assert!(apart_deg(&pair, time_s) < 1e-9, "nothing before {time_s} s");
    for t_s in [time_s + 0.51, 0.5 * (time_s + end_s), end_s] {
        assert!((apart_deg(&pair, t_s) - 0.4).abs() < 1e-9);
    }
    // Specific force follows: 0.4 degrees of gravity is 7 mg.
    let last = pair.added().last().unwrap().2;
    assert!(last.norm() > mg(6.0) && last.norm() < mg(8.0), "{last}");

    let pair = Pair::quiet("table_rocking=0.1");
    let peak = (0..2000).map(|k| apart_deg(&pair, 0.005 * f64::from(k))).fold(0.0, f64::max);
    assert!((peak - 0.1).abs() < 1e-4, "{peak}");
    // The gyro sees the rocking's rate in every attitude.
    let expected = 0.1 * TAU * pair.parameter("frequency");
    let seen = pair.added().map(|(_, rate, _)| rate.norm().to_degrees()).fold(0.0, f64::max);
    assert!((seen / expected - 1.0).abs() < 0.06, "{seen} for {expected}, with 3 % of scale error");
}

/// The rocking plate's acceleration is the second derivative of the sensor's place.
#[test]
fn rocking_is_consistent() {
    let pair = Pair::quiet("table_rocking=1");
    let motion = &pair.with.world.motion;
    let lever = motion.config().shape.lever_b_m;
    let place = |t: f64| motion.at(t).point(&lever);
    let h = 1e-4;
    for k in 1..200 {
        let t = 0.5 * f64::from(k);
        let (before, here, after) = (place(t - h), place(t), place(t + h));
        let velocity = (after.position - before.position) / (2.0 * h);
        let acceleration = (after.velocity - before.velocity) / (2.0 * h);
        assert!((velocity - here.velocity).norm() < 1e-4, "at {t}");
        assert!((acceleration - here.acceleration).norm() < 2e-3, "at {t}");
    }
}

#[test]
fn the_axis_wobbles() {
    let pair = Pair::quiet("spin_axis_wobble=3");
    let turn = pair.with.world.motion.segments().iter().find(|s| s.kind() == Kind::Turn && s.start_s > 0.0).unwrap();
    let peak = (0..500).map(|k| apart_deg(&pair, turn.start_s + turn.duration_s * f64::from(k) / 500.0));
    // Once a turn, and a third of it twice a turn: between 2/3 and 4/3 of the amplitude on each of two axes.
    let peak = peak.fold(0.0, f64::max);
    assert!((2.9..4.2).contains(&peak), "{peak}");
    assert!(apart_deg(&pair, turn.start_s) < 1e-9, "flat at the ends");
}

#[test]
fn vibration_and_shock() {
    let pair = Pair::quiet("vibration_line=20");
    let truth = pair.without.world.sensor().config().truth;
    let undo = truth.accel.correction().unwrap();
    let force = pair.added().map(|(_, _, force)| (undo * force).norm()).fold(0.0, f64::max);
    assert!((force / mg(20.0) - 1.0).abs() < 0.02, "{force}");
    let hz = pair.parameter("frequency");
    let phase = |t: f64| TAU * hz * t;
    let (mut sin, mut cos) = (nalgebra::Vector3::zeros(), nalgebra::Vector3::zeros());
    for (t, _, force) in pair.added() {
        sin += undo * force * phase(t).sin();
        cos += undo * force * phase(t).cos();
    }
    let amplitude = 2.0 * (sin.norm_squared() + cos.norm_squared()).sqrt() / pair.with.samples.len() as f64;
    assert!((amplitude / mg(20.0) - 1.0).abs() < 0.01, "all of it is at {hz} Hz: {amplitude}");

    let pair = Pair::quiet("shock=2");
    let (start_s, length_s) = (pair.parameter("start"), 1e-3 * pair.parameter("duration"));
    assert!((0.0099..=0.02).contains(&length_s));
    let touched: Vec<f64> = pair.added().filter(|(_, _, f)| f.norm() > 1e-9).map(|(t, ..)| t).collect();
    assert!(touched.iter().all(|t| (start_s..=start_s + length_s).contains(t)) && !touched.is_empty());
    assert!((pair.vector("force_peak").norm() - 2.0).abs() < 1e-12);
    let peak = pair.added().map(|(_, _, force)| force.norm()).fold(0.0, f64::max);
    assert!((1.2..2.1).contains(&(peak / G)), "{peak}");
    let at = pair.without.world.motion.segments().iter().find(|s| s.end_s() > start_s).unwrap();
    assert!(matches!(at.kind(), Kind::Rest | Kind::Turn), "{:?}", at.kind());
}

#[test]
fn the_earth_turns_faster() {
    let pair = Pair::quiet("earth_rotation=11");
    let undo = pair.without.world.sensor().config().truth.gyro.correction().unwrap();
    for (t_s, rate, _) in pair.added() {
        assert!(((undo * rate).norm() - 10.0 * 7.292_115e-5).abs() < 1e-9, "at {t_s}");
    }
    let pair = Pair::quiet("earth_rotation");
    assert!(pair.samples().all(|(with, without)| with == without), "the nominal world has it");
}
