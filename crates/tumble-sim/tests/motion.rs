//! The motion is exact: attitude, rate, acceleration and position belong together, and turns are what they claim to be.

use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};
use tumble_sim::motion::{BoxShape, Hands, MotionConfig, Stops};
use tumble_sim::rng::{Purpose, Rng};
use tumble_sim::{Direction, Face, Motion, Primitive, World, WorldConfig};

/// Every kind of move, one after the other, with tremor, wobble, overshoot, a crooked box and a bump.
fn everything() -> (Motion, f64) {
    let mut config = MotionConfig::nominal();
    config.hands = Hands { wobble_deg: 1.0, ..Hands::by_hand() };
    config.shape = BoxShape::crooked(Vector3::new(0.03, 0.02, 0.01), 0.5, &mut Rng::new(3, Purpose::Box));
    let mut motion = Motion::new(config, 7).unwrap();
    let leaned = UnitQuaternion::from_euler_angles(0.7, -0.4, 2.0);
    let moves = [
        Primitive::Rest { duration_s: 0.5 },
        Primitive::Reorient { up: Face::MinusY, heading_rad: 1.0, duration_s: 2.5 },
        Primitive::full_turn(Direction::Cw, 5.0),
        Primitive::Pose { rotation_n_from_b: leaned, duration_s: 2.0 },
        Primitive::Hold { duration_s: 2.0 },
        Primitive::Reorient { up: Face::PlusX, heading_rad: 0.0, duration_s: 2.0 },
        Primitive::Turn { signed_angle_rad: FRAC_PI_2, duration_s: 2.5 },
        Primitive::Tumble { duration_s: 5.0, violence: 1.5 },
        Primitive::Rest { duration_s: 1.5 },
    ];
    for primitive in moves {
        motion.push(0.0, primitive);
    }
    let end_s = motion.end_s();
    motion.bump(end_s - 1.0, 3.0);
    (motion, end_s)
}

#[test]
fn integrating_the_rate_reproduces_the_attitude() {
    let (motion, end_s) = everything();
    // Fourth-order Magnus step with two Gauss points: the error goes with h⁴ (1.7e-9 rad at 0.5 ms).
    let h = 3e-4;
    let node = 3f64.sqrt() / 6.0;
    let steps = (end_s / h).ceil() as usize;
    let mut attitude = motion.at(0.0).spin.rotation;
    let mut worst = 0.0f64;
    for k in 0..steps {
        let t = k as f64 * h;
        let rate = |at: f64| motion.at(t + at * h).spin.rate;
        let (early, late) = (rate(0.5 - node), rate(0.5 + node));
        let angle = (early + late) * (0.5 * h) - late.cross(&early) * (3f64.sqrt() / 12.0 * h * h);
        attitude *= UnitQuaternion::from_scaled_axis(angle);
        worst = worst.max(attitude.angle_to(&motion.at(t + h).spin.rotation));
    }
    assert!(worst < 1e-9, "attitude error {worst:.2e} rad");
}

#[test]
fn accelerations_are_the_derivatives() {
    let (motion, end_s) = everything();
    let lever = motion.config().shape.lever_b_m;
    let h = 1e-5;
    let mut t = 0.0;
    while t < end_s {
        let (before, here, after) = (motion.at(t - h), motion.at(t), motion.at(t + h));
        let points = [before.point(&lever), here.point(&lever), after.point(&lever)];
        let velocity = (points[2].position - points[0].position) / (2.0 * h);
        let acceleration = (points[2].velocity - points[0].velocity) / (2.0 * h);
        let spin_up = (after.spin.rate - before.spin.rate) / (2.0 * h);
        assert!((velocity - points[1].velocity).norm() < 2e-6, "velocity at {t}");
        assert!((acceleration - points[1].acceleration).norm() < 2e-4, "acceleration at {t}");
        assert!((spin_up - here.spin.accel).norm() < 2e-3, "angular acceleration at {t}");
        t += 0.003_7;
    }
}

#[test]
fn rate_and_its_derivative_have_no_jumps() {
    let (motion, _) = everything();
    let edges = motion.segments().iter().flat_map(|s| [s.start_s, s.end_s()]);
    for edge in edges {
        let (before, after) = (motion.at(edge - 1e-7), motion.at(edge + 1e-7));
        assert!((before.spin.rate - after.spin.rate).norm() < 1e-6, "rate at {edge}");
        assert!((before.spin.accel - after.spin.accel).norm() < 1e-3, "angular acceleration at {edge}");
        assert!((before.centre.acceleration - after.centre.acceleration).norm() < 1e-3, "acceleration at {edge}");
        assert!(before.spin.rotation.angle_to(&after.spin.rotation) < 1e-9, "attitude at {edge}");
    }
}

#[test]
fn a_turn_is_about_the_face_normal_and_ends_as_its_stops_say() {
    for stops in [Stops::Exact, Stops::FENCE, Stops::HAND] {
        let mut config = MotionConfig::nominal();
        config.hands = Hands { stops, overshoot_deg: 2.0, wobble_deg: 1.0, ..Hands::fenced() };
        let mut motion = Motion::new(config, 11).unwrap();
        let placed = motion.push(0.0, Primitive::Reorient { up: Face::MinusX, heading_rad: 0.3, duration_s: 3.0 });
        let before = motion.standing();
        let turned = motion.push(placed, Primitive::full_turn(Direction::Ccw, 10.0));
        let after = motion.standing();
        let angle = motion.segments()[1].turned_rad();
        assert!((angle - (TAU + after.offset_rad - before.offset_rad)).abs() < 1e-12);
        let moved = motion.at(placed).spin.rotation.inverse() * motion.at(turned).spin.rotation;
        let closure = moved.scaled_axis();
        assert!((closure - Face::MinusX.up_b() * (angle - TAU)).norm() < 1e-9, "{stops:?}: {closure}");
        if stops == Stops::Exact {
            assert!(closure.norm() < 1e-12);
        }
    }
}

#[test]
fn stop_errors_have_the_stated_spread() {
    let mut rng = Rng::new(5, Purpose::Hands);
    let mut closure_rms = |stops: Stops| {
        let mut square = 0.0;
        for _ in 0..20_000 {
            square += (stops.draw(&mut rng) - stops.draw(&mut rng)).to_degrees().powi(2);
        }
        (square / 20_000f64).sqrt()
    };
    assert!((closure_rms(Stops::FENCE) - 0.1 * (2.0f64 / 3.0).sqrt()).abs() < 0.002);
    assert!((closure_rms(Stops::HAND) - 2.0).abs() < 0.04);
    assert_eq!(closure_rms(Stops::Exact), 0.0);
}

#[test]
fn an_undisturbed_turn_on_a_tilted_table_spins_only_about_the_normal() {
    let mut config = MotionConfig::nominal();
    config.hands = Hands::machine();
    let mut motion = Motion::new(config, 1).unwrap();
    let end = motion.push(0.0, Primitive::full_turn(Direction::Ccw, 10.0));
    for k in 0..1000 {
        let rate = motion.at(end * f64::from(k) / 1000.0).spin.rate;
        assert!(rate.xy().norm() < 1e-12 && rate.z >= 0.0);
    }
    let middle = motion.at(5.0).spin.rate.z.to_degrees();
    assert!((middle - 36.0 / 0.85).abs() < 1e-6, "plateau at {middle} °/s");
    let up = motion.at(3.0).spin.rotation * Vector3::z();
    assert!((up.angle(&Vector3::z()).to_degrees() - 1.5).abs() < 1e-9);
}

#[test]
fn gravity_points_up_and_the_centripetal_term_points_inward() {
    let mut config = WorldConfig::nominal(1);
    config.motion.hands = Hands::machine();
    config.motion.table.tilt_deg = 0.0;
    let mut world = World::new(&config).unwrap();
    for face in Face::ALL {
        let start = world.motion.end_s().max(0.0);
        let placed = world.motion.push(start, Primitive::Reorient { up: face, heading_rad: 0.0, duration_s: 2.0 });
        let still = world.ideal(placed + 0.5).specific_force_mps2;
        assert!((still - face.up_b() * 9.80665).norm() < 1e-9, "{face}: {still}");
        let rest = world.motion.push(placed, Primitive::Rest { duration_s: 1.0 });
        world.motion.push(rest, Primitive::full_turn(Direction::Cw, 5.0));
        let turning = world.ideal(rest + 2.5);
        let rate = world.motion.at(rest + 2.5).spin.rate;
        let lever = config.motion.shape.lever_b_m;
        let across = lever - face.up_b() * face.up_b().dot(&lever);
        let inward = -across * rate.norm_squared();
        // Coriolis: 2 · 7.3e-5 rad/s · 0.05 m/s stays below 1e-5.
        assert!((turning.specific_force_mps2 - still - inward).norm() < 1e-5, "{face}");
        assert!(rate.dot(&face.up_b()) < 0.0, "clockwise from above is negative about up");
    }
}

#[test]
fn the_earth_turns_a_box_at_rest() {
    let world = World::new(&WorldConfig::nominal(1)).unwrap();
    let rate = world.true_attitude(0.0) * world.ideal(0.0).angular_rate_rad_s;
    assert!((rate.norm() - 7.292_115e-5).abs() < 1e-12 && rate.x.abs() < 1e-15 && rate.y > 0.0 && rate.z > 0.0);
}

#[test]
fn tumbling_is_violent_and_comes_back() {
    let mut motion = Motion::new(MotionConfig::nominal(), 5).unwrap();
    let end = motion.push(0.0, Primitive::Tumble { duration_s: 65.0, violence: 1.0 });
    let rates: Vec<f64> = (0..6500).map(|k| motion.at(f64::from(k) * 0.01).spin.rate.norm().to_degrees()).collect();
    let peak = rates.iter().copied().fold(0.0, f64::max);
    assert!((200.0..800.0).contains(&peak), "peak {peak} °/s");
    assert!(motion.at(0.0).spin.rotation.angle_to(&motion.at(end).spin.rotation) < 1e-12);
    assert!(motion.idle_at(end + 0.3) && !motion.idle_at(end - 1.0));
}

#[test]
fn senseless_requests_do_nothing() {
    let mut motion = Motion::new(MotionConfig::nominal(), 1).unwrap();
    let bad = [
        Primitive::Rest { duration_s: f64::NAN },
        Primitive::full_turn(Direction::Cw, f64::INFINITY),
        Primitive::Tumble { duration_s: 5.0, violence: f64::NAN },
    ];
    for primitive in bad {
        assert_eq!(motion.push(1.0, primitive), 1.0);
    }
    assert!(motion.segments().is_empty() && motion.idle_at(f64::NAN));
    let mut config = MotionConfig::nominal();
    config.table.tilt_deg = f64::NAN;
    assert!(Motion::new(config, 1).unwrap_err().to_string().contains("tilt_deg"));
}
