//! Means over records of the tape.

use nalgebra::Vector3;

use super::record::Record;
use crate::tape::Tape;

fn mean_over<const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    first: usize,
    end: usize,
    value: fn(&Record) -> Vector3<f32>,
) -> Vector3<f32> {
    let (mut sum, mut time) = (Vector3::zeros(), 0.0f32);
    for record in (first..end).filter_map(|index| tape.record(index)) {
        sum += value(&record);
        time += record.dt_s;
    }
    if time > 0.0 { sum / time } else { sum }
}

/// Mean specific force over records, m/s².
pub fn mean_force<const R: usize, const S: usize>(tape: &Tape<R, S>, first: usize, end: usize) -> Vector3<f32> {
    mean_over(tape, first, end, |record| record.specific_force_mps2 * record.dt_s)
}

/// Mean angular rate over records, rad/s.
pub fn mean_rate<const R: usize, const S: usize>(tape: &Tape<R, S>, first: usize, end: usize) -> Vector3<f32> {
    mean_over(tape, first, end, |record| record.rotation_rad)
}
