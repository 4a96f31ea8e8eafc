//! Closed-form start: opposite faces give the accelerometer's offsets and scales, whole turns the gyroscope's scales.

use nalgebra::{Matrix3, Vector3};

use super::model::Nominal;
use crate::calibration::Triad;
use crate::motion::means::{mean_force, mean_rate};
use crate::motion::path::whole_turns;
use crate::tape::{Exclusion, Kind, Segment, Tape};

/// The longest usable stills' means by face, and what follows.
pub fn nominal<const R: usize, const S: usize>(tape: &Tape<R, S>, gravity: f32) -> Nominal {
    let (bias, _) = resting_rate(tape, |_| Vector3::zeros());
    Nominal {
        accel: accelerometer(tape, gravity),
        earth_rad_s: Vector3::zeros(),
        gyro: Triad { bias, correction: Matrix3::from_diagonal(&turn_scales(tape)) },
    }
}

/// Mean rate over all usable stills, weighted by their length, and one sigma of the stills' own means about it, rad/s, both less what
/// the mean raw specific force makes of it.
pub fn resting_rate<const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    felt: impl Fn(&Vector3<f32>) -> Vector3<f32>,
) -> (Vector3<f32>, Vector3<f32>) {
    let (mut mean, mut squares, mut time) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for segment in usable_stills(tape) {
        let (first, end) = (usize::from(segment.first), usize::from(segment.end));
        let rate = mean_rate(tape, first, end) - felt(&mean_force(tape, first, end));
        let duration = segment.duration_s();
        time += duration;
        // West's recurrence: no difference of large squares.
        let deviation = rate - mean;
        mean += deviation * (duration / time);
        squares += deviation.component_mul(&(rate - mean)) * duration;
    }
    (mean, if time > 0.0 { (squares / time).map(libm::sqrtf) } else { squares })
}

/// `a₊ = bias + g/s`, `a₋ = bias − g/s` on each axis; no error where a face is missing.
fn accelerometer<const R: usize, const S: usize>(tape: &Tape<R, S>, gravity: f32) -> Triad {
    let mut readings = [(0.0f32, 0.0f32); 6];
    for segment in usable_stills(tape) {
        if let Some(face) = segment.face() {
            let force = mean_force(tape, usize::from(segment.first), usize::from(segment.end));
            let reading = &mut readings[face.index()];
            reading.0 += force[face.axis()] * segment.duration_s();
            reading.1 += segment.duration_s();
        }
    }
    let mut triad = Triad::identity();
    for axis in 0..3 {
        let [plus, minus] = [readings[2 * axis], readings[2 * axis + 1]];
        if plus.1 > 0.0 && minus.1 > 0.0 {
            let (plus, minus) = (plus.0 / plus.1, minus.0 / minus.1);
            triad.bias[axis] = 0.5 * (plus + minus);
            triad.correction[(axis, axis)] = 2.0 * gravity / (plus - minus);
        }
    }
    triad
}

/// Revolutions counted over revolutions measured, axis by axis; 1 where no turn was made.
fn turn_scales<const R: usize, const S: usize>(tape: &Tape<R, S>) -> Vector3<f32> {
    let mut sums = [(0.0f32, 0.0f32); 3];
    for segment in tape.segments() {
        if let Kind::OnTable { face, angle_rad } = segment.kind
            && segment.exclusion == Exclusion::None
            && let Some(turns) = whole_turns(angle_rad)
        {
            let sum = &mut sums[face.axis()];
            sum.0 += libm::fabsf(turns as f32) * core::f32::consts::TAU;
            sum.1 += libm::fabsf(angle_rad);
        }
    }
    Vector3::from(sums.map(|(whole, measured)| if whole > 0.0 { whole / measured } else { 1.0 }))
}

fn usable_stills<const R: usize, const S: usize>(tape: &Tape<R, S>) -> impl Iterator<Item = &Segment> {
    tape.segments().iter().filter(|segment| segment.is_usable_still())
}
