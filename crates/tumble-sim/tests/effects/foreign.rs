//! Effects outside the catalogue, against their equations.

use crate::common::{G, Pair, dps, mg, none};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// (v_y·v_z, v_z·v_x, v_x·v_y).
fn products(v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.y * v.z, v.z * v.x, v.x * v.y)
}

#[test]
fn products_of_rates_and_forces() {
    let pair = Pair::quiet("x_gyro_rate_product=5");
    let (world, k) = (&pair.without.world, pair.vector("at_100_dps"));
    assert!((k.amax() - 5.0).abs() < 1e-12);
    pair.check(|t| products(&(world.ideal(t).angular_rate_rad_s / dps(100.0))).component_mul(&k) * dps(1.0), none);

    let pair = Pair::quiet("x_accel_cross_product=30");
    let (world, k) = (&pair.without.world, pair.vector("k"));
    pair.check(none, |t| products(&(world.ideal(t).specific_force_mps2 / G)).component_mul(&k) * mg(1.0));

    let pair = Pair::quiet("x_gyro_force_rate_product=800");
    let (world, k) = (&pair.without.world, pair.vector("k") * 1e-6);
    pair.check(
        |t| {
            let ideal = world.ideal(t);
            ideal.specific_force_mps2.component_mul(&ideal.angular_rate_rad_s).component_mul(&k) / G
        },
        none,
    );

    let pair = Pair::quiet("x_accel_rate_squared=25");
    let (world, a) = (&pair.without.world, pair.vector("at_100_dps"));
    assert!((a.norm() - 25.0).abs() < 1e-12);
    pair.check(none, |t| a * mg((world.ideal(t).angular_rate_rad_s.norm() / dps(100.0)).powi(2)));
}

#[test]
fn things_of_time() {
    let pair = Pair::quiet("x_gyro_periodic_bias=0.08");
    let (a, hz, phase) = (pair.vector("amplitude"), pair.parameter("frequency"), pair.parameter("phase").to_radians());
    assert!((a.norm() - 0.08).abs() < 1e-12 && (0.03..0.2).contains(&hz));
    pair.check(|t| a * dps((TAU * hz * t + phase).sin()), none);

    let pair = Pair::quiet("x_gyro_scale_drift=900");
    let (world, s) = (&pair.without.world, pair.vector("over_the_recording") * 1e-6);
    let length_s = pair.with.samples.last().unwrap().t_s;
    for (t, rate, _) in pair.added() {
        let expected = s.component_mul(&world.ideal(t).angular_rate_rad_s) * (t / length_s - 0.5);
        assert!((rate - expected).norm() < 1e-5, "at {t}");
    }

    let pair = Pair::quiet("x_gyro_telegraph_noise=0.05");
    let axis = (0..3).find(|&k| [0.0, 1.0, 2.0][k] == pair.parameter("axis")).unwrap();
    let added: Vec<f64> = pair.added().map(|(_, rate, _)| rate[axis].to_degrees()).collect();
    assert!(added.iter().all(|v| (v.abs() - 0.05).abs() < 1e-9));
    let jumps = added.windows(2).filter(|two| two[0] * two[1] < 0.0).count();
    assert!(jumps >= 2 && jumps as f64 <= pair.parameter("jumps"), "{jumps}");
}

#[test]
fn things_that_remember() {
    let pair = Pair::quiet("x_gyro_after_effect=0.1");
    // A turn about an axis leaves 0.1 °/s or 30 % of it less what died away since.
    let most = pair.added().map(|(_, rate, _)| rate.amax().to_degrees()).fold(0.0, f64::max);
    assert!((0.05..0.4).contains(&most), "{most}");
    assert_eq!(pair.added().next().unwrap().1, Vector3::zeros());

    let pair = Pair::quiet("x_accel_hysteresis=4");
    let h = pair.vector("shift");
    for (_, _, force) in pair.added() {
        assert!((force.abs() - h.abs() * mg(1.0)).norm() < 1e-9);
    }

    let pair = Pair::quiet("x_accel_creep=5");
    let added: Vec<_> = pair.added().map(|(_, _, force)| force.amax()).collect();
    let most = added.iter().copied().fold(0.0, f64::max);
    // From one face to the opposite it is 2 g, less what crept while it was turned over.
    assert!(most > mg(1.5) && most < mg(10.5), "{most}");
    assert!(added[0] < 1e-12);
}

#[test]
fn things_of_attitude_and_acceleration() {
    let axes = ["x", "y", "z"];
    let pair = Pair::quiet("x_gyro_magnetic=0.2");
    let m = Matrix3::from_fn(|i, j| pair.parameter(&format!("m_{}{}", axes[i], axes[j])));
    assert!((m.norm() - 0.2).abs() < 1e-12);
    let world = &pair.without.world;
    let field = Vector3::new(0.0, 65f64.to_radians().cos(), -65f64.to_radians().sin());
    pair.check(|t| m * (world.true_attitude(t).inverse() * field) * dps(1.0), none);

    let pair = Pair::quiet("x_gyro_angular_acceleration=20");
    let c =
        Matrix3::from_fn(|i, j| if i == j { 0.0 } else { pair.parameter(&format!("c_{}{}", axes[i], axes[j])) * 1e-3 });
    assert!((c.norm() - 0.02).abs() < 1e-12);
    let world = &pair.without.world;
    pair.check(|t| c * world.motion.at(t).spin.accel, none);
}
