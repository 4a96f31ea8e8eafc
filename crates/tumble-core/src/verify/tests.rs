//! A known calibration on a known motion: what is right passes at the stated rate, what is wrong does not.

use nalgebra::{Matrix3, Rotation3};

use super::*;
use crate::DEGREE_RAD;
use crate::calibration::{Fit, Frame, Triad, TriadEstimate};
use crate::face::Face;

const RATE_HZ: f32 = 200.0;

/// Sums of uniform deviates: near enough to normal, and the same on every run.
struct Noise(u64);

impl Noise {
    fn normal(&mut self) -> f32 {
        let mut uniform = || {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 40) as f32 / (1 << 24) as f32 - 0.5
        };
        (0..12).map(|_| uniform()).sum()
    }

    fn vector(&mut self) -> Vector3<f32> {
        Vector3::from_fn(|_, _| self.normal())
    }
}

fn estimate(bias_sigma: f32, correction_sigma: f32) -> TriadEstimate {
    TriadEstimate {
        triad: Triad::identity(),
        bias_sigma: Vector3::repeat(bias_sigma),
        correction_sigma: Matrix3::repeat(correction_sigma),
        observable: [[true; 3]; 3],
    }
}

/// As the estimator achieves: 20 µg and 30 ppm, 2 mdps and 40 ppm.
fn calibration() -> Calibration {
    Calibration {
        g_sensitivity: None,
        accelerometer: estimate(2e-4, 30e-6),
        gyroscope: estimate(2e-3 * DEGREE_RAD, 40e-6),
        frame: Frame::Box,
        temperature_degc: 24.0,
        fit: Fit { nis_per_dof: 1.0, gravity_rms_mps2: 0.001, ..Fit::default() },
    }
}

/// A sensor with errors left over by the calibration, in a hand.
struct Rig {
    verifier: Verifier,
    noise: Noise,
    t_us: u64,
    rotation_n_from_b: Rotation3<f32>,
    left_over: [Triad; 2],
    checks: std::vec::Vec<PoseCheck>,
}

extern crate std;

impl Rig {
    fn new(seed: u64, left_over: [Triad; 2]) -> Self {
        Self {
            verifier: Verifier::new(&calibration()),
            noise: Noise(seed),
            t_us: 0,
            rotation_n_from_b: Rotation3::identity(),
            left_over,
            checks: std::vec::Vec::new(),
        }
    }

    fn sample(&mut self, rate: &Vector3<f32>) {
        let force = self.rotation_n_from_b.inverse() * Vector3::new(0.0, 0.0, STANDARD_GRAVITY_MPS2);
        // White noise in 200 samples a second: density times √(200/2).
        let (accel_noise, gyro_noise) = (300e-6 * STANDARD_GRAVITY_MPS2 * 10.0, 0.01 * DEGREE_RAD * 10.0);
        let [accel, gyro] = self.left_over;
        self.verifier.sample(&Sample {
            t_us: self.t_us,
            angular_rate_rad_s: gyro.compensate(rate) + self.noise.vector() * gyro_noise,
            specific_force_mps2: accel.compensate(&force) + self.noise.vector() * accel_noise,
            temperature_degc: 25.0,
        });
    }

    fn pass(&mut self, rate: &Vector3<f32>) {
        let dt = 1.0 / RATE_HZ;
        self.rotation_n_from_b *= Rotation3::new(rate * dt);
        self.rotation_n_from_b.renormalize();
        self.t_us += 5000;
        self.sample(rate);
    }

    fn event(&mut self, event: MotionEvent) {
        self.checks.extend(self.verifier.event(&event));
    }

    fn rest(&mut self, seconds: f32) {
        self.event(MotionEvent::StillBegan { face: None });
        for half in 1..=(2.0 * seconds) as usize {
            (0..100).for_each(|_| self.pass(&Vector3::zeros()));
            self.event(MotionEvent::StillHeld { face: None, held_s: half as f32 * 0.5 });
        }
    }

    /// A smooth turn about a fixed axis of the box.
    fn turn(&mut self, rotation: &Vector3<f32>, seconds: f32) {
        // The end of the rest is noticed late: part of a block is in motion already.
        let steps = (seconds * RATE_HZ) as usize;
        for i in 0..steps {
            if i == 40 {
                self.event(MotionEvent::StillEnded { face: None, held_s: 2.0 });
            }
            let phase = (i as f32 + 0.5) / steps as f32;
            let shape = 1.0 - libm::cosf(phase * core::f32::consts::TAU);
            self.pass(&(rotation * (shape / seconds)));
        }
    }

    fn check(&mut self) -> Verification {
        let quarter = core::f32::consts::FRAC_PI_2;
        let (x, y) = (Vector3::x() * quarter, Vector3::y() * quarter);
        self.rest(2.0);
        for rotation in [x, x, x, y * 0.5, x * 0.7, y, x] {
            self.turn(&rotation, 3.0);
            self.rest(2.0);
            if let Some(verification) = self.verifier.verdict() {
                return verification;
            }
        }
        panic!("six poses are enough: {:?}", self.checks);
    }
}

#[test]
fn a_true_calibration_passes_and_its_errors_are_small() {
    let mut failures = 0;
    for seed in 1..=60 {
        let mut rig = Rig::new(seed * 0x9e37_79b9, [Triad::identity(); 2]);
        let verification = rig.check();
        failures += usize::from(!verification.pass);
        assert!(verification.poses == POSES && verification.level_max_rad < 0.3 * DEGREE_RAD, "{verification:?}");
        assert_eq!(rig.checks.iter().filter(|check| check.level_error_rad.is_none()).count(), 1, "only the first");
    }
    assert_eq!(failures, 0, "one in a thousand may fail");
}

#[test]
fn errors_within_the_sigmas_pass_and_large_ones_fail_where_they_are() {
    let off = |bias: f32, scale: f32| Triad { bias: Vector3::repeat(bias), correction: Matrix3::identity() * scale };
    let none = Triad::identity();
    let fails = |left_over| !Rig::new(77, left_over).check().pass;
    assert!(!fails([off(2e-4, 1.000_03), off(2e-3 * DEGREE_RAD, 1.000_04)]));
    assert!(fails([off(0.05, 1.0), none]), "5 mg of bias");
    assert!(fails([off(0.0, 1.003), none]), "0.3 % of accelerometer scale");
    assert!(fails([none, off(0.0, 1.01)]), "1 % of gyroscope scale");
    assert!(fails([none, off(0.2 * DEGREE_RAD, 1.0)]), "0.2 °/s of gyroscope bias");
    assert!(fails([none, off(f32::NAN, 1.0)]), "not a number is not right");
}

#[test]
fn a_pose_that_was_there_already_does_not_count() {
    let mut rig = Rig::new(5, [Triad::identity(); 2]);
    rig.rest(3.0);
    rig.turn(&(Vector3::z() * 3.0), 3.0);
    rig.rest(2.0);
    let fresh: std::vec::Vec<bool> = rig.checks.iter().map(|check| check.fresh).collect();
    assert_eq!(fresh, [true, false]);
    assert_eq!(rig.verifier.verdict(), None);
}

#[test]
fn a_gap_spares_the_level_and_not_the_gravity() {
    let mut rig = Rig::new(6, [Triad::identity(); 2]);
    rig.rest(2.0);
    rig.turn(&Vector3::x(), 2.0);
    rig.t_us += 300_000;
    rig.turn(&Vector3::x(), 2.0);
    rig.rest(2.0);
    let last = rig.checks.last().expect("two poses");
    assert!(last.fresh && last.level_error_rad.is_none() && last.ok(), "{last:?}");
}

#[test]
fn a_short_rest_is_passed_over() {
    let mut rig = Rig::new(7, [Triad::identity(); 2]);
    rig.rest(2.0);
    rig.turn(&Vector3::x(), 2.0);
    rig.rest(1.0);
    rig.turn(&Vector3::y(), 2.0);
    rig.rest(2.0);
    assert_eq!(rig.checks.len(), 2);
    assert!(rig.checks[1].ok(), "{:?}", rig.checks[1]);
}

/// The propagation against the exact rotation, with coning in it: 2 rad/s at 2 Hz about two axes, 10 s.
#[test]
fn propagation_keeps_to_the_exact_rotation() {
    let rate = |t: f32| Vector3::new(libm::cosf(12.57 * t), libm::sinf(12.57 * t), 0.3) * 2.0;
    let mut propagation = Propagation::default();
    let mut truth = Rotation3::<f64>::identity();
    let sample = |t_us: u64, rate: Vector3<f32>| Sample {
        t_us,
        angular_rate_rad_s: rate,
        specific_force_mps2: Vector3::zeros(),
        temperature_degc: f32::NAN,
    };
    propagation.step(&sample(0, rate(0.0)));
    propagation.restart(Face::PlusX.normal(), 0.0);
    for i in 1..=2000_u64 {
        let t = i as f32 * 0.005;
        for fine in 0..50 {
            let middle = (i - 1) as f32 * 0.005 + (fine as f32 + 0.5) * 1e-4;
            truth *= Rotation3::new(rate(middle).cast::<f64>() * 1e-4);
        }
        propagation.step(&sample(i * 5000, rate(t)));
    }
    let up = truth.inverse() * Vector3::<f64>::x();
    let angle = propagation.angle_to(&up.cast::<f32>()).expect("no gap");
    assert!(angle < 0.06 * DEGREE_RAD, "0.006 °/s: {} degrees", angle / DEGREE_RAD);
    assert!((propagation.duration_s() - 10.0).abs() < 1e-3);
}
