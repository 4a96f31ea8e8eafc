//! A simulated recording on a tape, as a session has it.

use nalgebra::{Matrix3, Vector3};
use tumble_core::estimate::Conditions;
use tumble_core::motion::segmenter::Segmenter;
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_core::sample::Sample;
use tumble_core::tape::Tape;
use tumble_sim::SchemeConfig;

/// The tape of these tests: twice what a session on the board takes.
pub type SessionTape = Tape<6000, 256>;

/// A fenced session with a square box.
pub const FENCED: Conditions =
    Conditions { stops: TurnStops::Fenced, faces: BoxFaces::Square, gravity_mps2: tumble_core::STANDARD_GRAVITY_MPS2 };

/// Truth in the box frame.
pub struct Truth {
    pub gyro_bias: Vector3<f64>,
    pub gyro: Matrix3<f64>,
    pub accel_bias: Vector3<f64>,
    pub accel: Matrix3<f64>,
}

/// A session's samples through the segmenter, and the truth.
pub fn session(config: &SchemeConfig) -> (Box<SessionTape>, Truth) {
    let recording = config.record().expect("a valid scheme");
    let mut tape = Box::new(SessionTape::new());
    let mut segmenter = Segmenter::new(1.0);
    for sample in &recording.samples {
        let sample = Sample {
            t_us: (sample.t_s * 1e6).round() as u64 + 1,
            angular_rate_rad_s: sample.angular_rate_rad_s.map(|value| value as f32),
            specific_force_mps2: sample.specific_force_mps2.map(|value| value as f32),
            temperature_degc: 25.0,
        };
        segmenter.step(&sample, 0, &mut tape);
    }
    segmenter.finish(&mut tape);
    let truth = recording.truth.in_box;
    let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
    let truth = Truth {
        gyro_bias: truth.gyroscope.bias_rad_s.into(),
        gyro: matrix(truth.gyroscope.correction),
        accel_bias: truth.accelerometer.bias_mps2.into(),
        accel: matrix(truth.accelerometer.correction),
    };
    (tape, truth)
}
