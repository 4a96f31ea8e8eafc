use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use super::{Setting, SixFace, Tilt, single};
use crate::STANDARD_GRAVITY_MPS2;
use crate::estimate::Conditions;
use crate::face::Face;
use crate::setup::{BoxFaces, TurnStops};
use crate::tape::{Exclusion, Kind, Record, Segment, Tape};

type TestTape = Tape<3000, 64>;

const FENCED: Conditions =
    Conditions { stops: TurnStops::Fenced, faces: BoxFaces::Square, gravity_mps2: STANDARD_GRAVITY_MPS2 };
const STEPS: u32 = 120;
const TURN_S: f64 = 10.0;

/// A sensor without noise, a table tilted by 1.5°.
struct World {
    gyro: Matrix3<f64>,
    gyro_bias: Vector3<f64>,
    accel: Matrix3<f64>,
    accel_bias: Vector3<f64>,
    lever: Vector3<f64>,
    t_us: u64,
}

fn world() -> World {
    World {
        gyro: Matrix3::new(0.994, 0.011, -0.008, 0.007, 1.007, -0.012, 0.009, -0.006, 1.006),
        gyro_bias: Vector3::new(0.009, -0.004, 0.012),
        accel: Matrix3::new(1.02, -0.015, 0.004, 0.012, 0.98, 0.018, -0.007, 0.013, 1.01),
        accel_bias: Vector3::new(0.4, -0.3, 0.2),
        lever: Vector3::new(0.03, 0.02, 0.01),
        t_us: 1,
    }
}

impl World {
    /// Angle, rate and growth of a turn that starts and ends at rest.
    fn profile(t: f64) -> (f64, f64, f64) {
        let (w, s) = (core::f64::consts::TAU / TURN_S, t / TURN_S);
        let phase = core::f64::consts::TAU * s;
        (phase - libm::sin(phase), w * (1.0 - libm::cos(phase)), w * w * libm::sin(phase))
    }

    /// Raw force with the box at `heading` on a face: tilt of 1.5° towards +x of the level frame.
    fn force(&self, face: Face, heading: f64, rate: f64, growth: f64) -> Vector3<f64> {
        let up: Vector3<f64> = face.normal().cast();
        let tilt = 1.5f64.to_radians();
        let side = Vector3::from_fn(|i, _| if i == (face.axis() + 1) % 3 { 1.0 } else { 0.0 });
        let turned = Rotation3::from_axis_angle(&Unit::new_normalize(up), -heading) * side;
        let gravity = (up * libm::cos(tilt) + turned * libm::sin(tilt)) * f64::from(STANDARD_GRAVITY_MPS2);
        let circle = (up * rate).cross(&(up * rate).cross(&self.lever)) + (up * growth).cross(&self.lever);
        self.accel * (gravity + circle) + self.accel_bias
    }

    fn still(&mut self, tape: &mut TestTape, face: Face) {
        let first = tape.len();
        for _ in 0..20 {
            let record = Record {
                dt_s: 0.5,
                rotation_rad: (self.gyro_bias * 0.5).cast(),
                specific_force_mps2: self.force(face, 0.4, 0.0, 0.0).cast(),
            };
            tape.push(&record).expect("room");
        }
        self.close(tape, Kind::Still { face: Some(face), rate_variance: 1e-6 }, first, 10_000_000);
    }

    fn turn(&mut self, tape: &mut TestTape, face: Face, sign: f64) {
        let first = tape.len();
        let dt = TURN_S / f64::from(STEPS);
        for step in 0..STEPS {
            let (before, after) = (f64::from(step) * dt, f64::from(step + 1) * dt);
            let angle = (Self::profile(after).0 - Self::profile(before).0) * sign;
            let mean = (0..8).fold(Vector3::zeros(), |sum, part| {
                let (angle, rate, growth) = Self::profile(before + (f64::from(part) + 0.5) / 8.0 * dt);
                sum + self.force(face, 0.4 + sign * angle, sign * rate, sign * growth) / 8.0
            });
            let record = Record {
                dt_s: dt as f32,
                rotation_rad: (self.gyro * face.normal().cast() * angle + self.gyro_bias * dt).cast(),
                specific_force_mps2: mean.cast(),
            };
            tape.push(&record).expect("room");
        }
        let angle_rad = (sign * core::f64::consts::TAU) as f32;
        self.close(tape, Kind::OnTable { face, angle_rad }, first, 10_000_000);
    }

    fn close(&mut self, tape: &mut TestTape, kind: Kind, first: usize, length_us: u64) {
        let (start_us, end_us) = (self.t_us, self.t_us + length_us);
        let (first, end) = (first as u16, tape.len() as u16);
        tape.close(Segment {
            kind,
            first,
            end,
            start_us,
            end_us,
            exclusion: Exclusion::None,
            clipped: 0,
            clipped_samples: 0,
        })
        .expect("room");
        self.t_us = end_us;
    }

    /// Six faces, of which those in `turned` are turned.
    fn session(&mut self, turned: &[Face]) -> TestTape {
        let mut tape = TestTape::new();
        for face in Face::ALL {
            self.still(&mut tape, face);
            if turned.contains(&face) {
                self.turn(&mut tape, face, f64::from(face.sign()));
                self.still(&mut tape, face);
            }
            let first = tape.len();
            self.close(&mut tape, Kind::Hand, first, 4_000_000);
        }
        tape
    }
}

/// Largest errors of: gyroscope matrix, gyroscope bias, accelerometer matrix, accelerometer bias.
fn errors(turned: &[Face]) -> [f64; 4] {
    let mut world = world();
    let tape = world.session(turned);
    let setting = Setting::new(&tape, &FENCED);
    let found: SixFace<f64> = SixFace::solve(&tape, &setting, Tilt::Eliminated).expect("solved");
    let accel = world.accel.try_inverse().expect("regular");
    [
        (found.gyro.matrix - world.gyro).amax(),
        (found.rest.bias() - world.gyro_bias).amax(),
        (found.accel.correction - accel).amax(),
        (found.accel.bias - world.accel_bias).amax(),
    ]
}

#[test]
fn closed_forms_are_exact_where_there_is_no_noise() {
    let [gyro, gyro_bias, accel, accel_bias] = errors(&Face::ALL);
    // The tape's units: 15 µrad over a turn, 0.24 mm/s² over a record.
    assert!(gyro < 6e-6 && gyro_bias < 2e-6, "{gyro:e} {gyro_bias:e}");
    assert!(accel < 2e-5 && accel_bias < 1.5e-4, "{accel:e} {accel_bias:e}");
}

#[test]
fn three_turns_are_enough_and_unturned_faces_solve_their_tilt() {
    let [gyro, gyro_bias, accel, accel_bias] = errors(&[Face::PlusX, Face::MinusY, Face::PlusZ]);
    // One of the tape's 31 µrad over a rest of 10 s; noise being taken for no more than that rounding, Earth's rate takes some of it.
    assert!(gyro < 6e-6 && gyro_bias < 3.1e-6, "{gyro:e} {gyro_bias:e}");
    assert!(accel < 3e-5 && accel_bias < 1.5e-4, "{accel:e} {accel_bias:e}");
}

#[test]
fn a_leaking_tilt_is_as_large_as_the_tilt_and_f32_is_enough() {
    let mut world = world();
    let tape = world.session(&Face::ALL);
    let setting = Setting::new(&tape, &FENCED);
    let accel = world.accel.try_inverse().expect("regular");
    let leaking: SixFace<f64> = SixFace::solve(&tape, &setting, Tilt::Leaking).expect("solved");
    let leak = (leaking.accel.correction - accel).amax();
    assert!((0.01..0.04).contains(&leak), "{leak}");
    let double: SixFace<f64> = SixFace::solve(&tape, &setting, Tilt::Eliminated).expect("solved");
    let single_precision: SixFace<f32> = SixFace::solve(&tape, &setting, Tilt::Eliminated).expect("solved");
    let difference = (double.accel.correction.map(single) - single_precision.accel.correction).amax();
    let gyro = (double.gyro.matrix.map(single) - single_precision.gyro.matrix).amax();
    assert!(difference < 1e-5 && gyro < 2e-6, "{difference:e} {gyro:e}");
}

#[test]
fn without_turns_and_without_a_square_box_it_says_so() {
    let mut world = world();
    let tape = world.session(&[]);
    let found: SixFace<f64> = SixFace::solve(&tape, &Setting::new(&tape, &FENCED), Tilt::Eliminated).expect("solved");
    let gyroscope = found.gyroscope().expect("regular");
    assert_eq!(gyroscope.observable, [[false; 3]; 3]);
    let accelerometer = found.accelerometer();
    assert!(accelerometer.observable[0][0] && !accelerometer.observable[0][1], "{:?}", accelerometer.observable);
    let tape = world.session(&Face::ALL);
    let unknown = Conditions { faces: BoxFaces::Unknown, ..FENCED };
    let found: SixFace<f64> = SixFace::solve(&tape, &Setting::new(&tape, &unknown), Tilt::Eliminated).expect("solved");
    let accelerometer = found.accelerometer();
    assert!(accelerometer.observable[0][0] && !accelerometer.observable[0][1]);
    let empty = TestTape::new();
    assert!(SixFace::<f32>::solve(&empty, &Setting::new(&empty, &FENCED), Tilt::Eliminated).is_err());
}
