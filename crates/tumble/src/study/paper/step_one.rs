//! The paper's first step: accelerometer, gyroscope bias and scale from six faces, each with a full turn.

use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;
use tumble_sim::motion::{Kind, Segment};
use tumble_sim::{Recording, SchemeConfig};

use crate::study::navigation::Correction;
use crate::study::truth::up_face;

/// What of the paper's text is taken how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Divide a turn by cos β, as its equations (5) to (7) have it. A box turned on a tilted table turns about its own
    /// face normal, so that the right divisor is 1.
    pub cos_beta: bool,
    /// Take the accelerometer's columns from stills, which a tilted table leans over, and not from whole turns, over which the
    /// tilt averages out.
    pub tilt_leaks: bool,
}

/// Its results.
#[derive(Clone, Copy, Debug)]
pub struct StepOne {
    /// `f = A (raw − a)`.
    pub accel: Correction,
    /// rad/s.
    pub gyro_bias: Vector3<f64>,
    /// Raw over ideal along each axis.
    pub scale: Vector3<f64>,
}

/// A face's sums.
#[derive(Clone, Copy, Default)]
struct FaceSums {
    /// Mean specific force in the rest before the turn, and over the angle of the turn.
    still: Vector3<f64>,
    turn: Vector3<f64>,
    /// Whole turn by the raw gyroscope less its bias, rad.
    turned: Vector3<f64>,
}

/// None if a face or its turn is missing.
pub fn step_one(config: &SchemeConfig, recording: &Recording, reading: Reading) -> Option<StepOne> {
    let gyro_bias = resting_rate(recording);
    let mut faces = [FaceSums::default(); 6];
    let mut still = Vector3::zeros();
    for segment in recording.world.motion.segments().iter().filter(|segment| segment.end_s() > 0.0) {
        match segment.kind() {
            Kind::Rest => still = mean(recording, segment, |sample| sample.specific_force_mps2, |_| 1.0),
            Kind::Turn => {
                let up_b = segment.from.rotation_n_from_b.inverse_transform_vector(&Vector3::z());
                let (face, axis) = up_face(&up_b)?;
                // Weighted by the rate, time becomes angle, and a full circle of tilt has mean zero.
                let rate = |sample: &tumble_sim::Sample| (sample.angular_rate_rad_s - gyro_bias).dot(&axis).abs();
                let turn = mean(recording, segment, |sample| sample.specific_force_mps2, rate);
                let turned = mean(recording, segment, |sample| sample.angular_rate_rad_s - gyro_bias, |_| 1.0);
                faces[face] = FaceSums { still, turn, turned: turned * segment.duration_s };
            }
            _ => {}
        }
    }
    let cosine = config.world.motion.table.tilt_deg.to_radians().cos();
    let force = |face: usize| if reading.tilt_leaks { faces[face].still } else { faces[face].turn };
    let column = |axis: usize| (force(2 * axis) - force(2 * axis + 1)) / (2.0 * config.world.gravity_mps2 * cosine);
    let matrix = Matrix3::from_columns(&[column(0), column(1), column(2)]).try_inverse()?;
    let bias = (0..6).map(force).sum::<Vector3<f64>>() / 6.0;
    let whole = if reading.cos_beta { TAU * cosine } else { TAU };
    let scale =
        |axis: usize| (faces[2 * axis].turned[axis].abs() + faces[2 * axis + 1].turned[axis].abs()) / (2.0 * whole);
    Some(StepOne { accel: Correction { bias, matrix }, gyro_bias, scale: Vector3::new(scale(0), scale(1), scale(2)) })
}

/// Weighted by the rests' lengths: the first may have none.
fn resting_rate(recording: &Recording) -> Vector3<f64> {
    let rests = recording.world.motion.segments().iter().filter(|segment| segment.kind() == Kind::Rest);
    let (sum, time_s) =
        rests.filter(|rest| rest.start_s >= 0.0).fold((Vector3::zeros(), 0.0), |(sum, time_s), rest| {
            let rate = mean(recording, rest, |sample| sample.angular_rate_rad_s, |_| 1.0);
            (sum + rate * rest.duration_s, time_s + rest.duration_s)
        });
    if time_s > 0.0 { sum / time_s } else { sum }
}

fn mean(
    recording: &Recording,
    segment: &Segment,
    value: impl Fn(&tumble_sim::Sample) -> Vector3<f64>,
    weight: impl Fn(&tumble_sim::Sample) -> f64,
) -> Vector3<f64> {
    let (mut sum, mut weights) = (Vector3::zeros(), 0.0);
    let within = |sample: &&tumble_sim::Sample| sample.t_s >= segment.start_s && sample.t_s < segment.end_s();
    for sample in recording.samples.iter().filter(within) {
        sum += value(sample) * weight(sample);
        weights += weight(sample);
    }
    if weights > 0.0 { sum / weights } else { sum }
}
