//! Suspicion of a wrong unit, before any estimator can make nonsense of it.
//!
//! Both checks are wide: an honest sensor with a wrong full scale (a factor of 2, 4 or 8) passes here, because that is
//! for the estimator's verdict and the diagnosis to name.

use super::error::Problem;
use super::{Row, STANDARD_GRAVITY_MPS2};

/// Refuses recordings whose specific force or angular rate is plainly in another unit.
pub(super) fn check(rows: &[Row]) -> Result<(), Problem> {
    check_accel(rows)?;
    check_gyro(rows)
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// At rest the length is 1 g, and people rest often enough for the median to be near it.
fn check_accel(rows: &[Row]) -> Result<(), Problem> {
    let mut lengths: Vec<f64> = rows.iter().map(|row| norm(row.accel_g)).collect();
    let middle = lengths.len() / 2;
    let median = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
    let unit = match median {
        m if m < 0.05 => "specific force without gravity, or a dead channel",
        // 15 % around 9.81: a ±2 g sensor taken for ±16 g reads 8 at rest and is not meant.
        m if (m / STANDARD_GRAVITY_MPS2 - 1.0).abs() < 0.15 => "m/s²",
        m if (m / 1000.0 - 1.0).abs() < 0.15 => "mg or cm/s²",
        m if m > 50.0 => "counts of the sensor",
        _ => return Ok(()),
    };
    Err(Problem::AccelUnit { median, unit })
}

/// Length of the windows over which directions are compared. Short enough for a fast turn (900 °/s) to stay below half
/// a revolution.
const WINDOW_S: f64 = 0.2;
/// A window counts where the specific force turned by more than this, so that noise (a few mrad in the mean of a
/// window) and linear acceleration of a careful hand do not add up.
const TURNED_DEG: f64 = 5.0;
/// So much turning in all before anything is concluded: three re-orientations.
const ENOUGH_DEG: f64 = 270.0;
/// Degrees taken for radians make the ratio 57; other errors of scale stay below 8.
const RATIO: f64 = 20.0;

/// The specific force cannot turn faster than the board does (shocks aside, hence the wide margin).
fn check_gyro(rows: &[Row]) -> Result<(), Problem> {
    let windows = windows(rows);
    let (mut accel_deg, mut gyro_deg) = (0.0, 0.0);
    for pair in windows.windows(2) {
        let turned = angle_deg(pair[0].accel, pair[1].accel);
        if turned > TURNED_DEG {
            accel_deg += turned;
            gyro_deg += (pair[0].gyro_deg + pair[1].gyro_deg) / 2.0;
        }
    }
    if accel_deg > ENOUGH_DEG && gyro_deg * RATIO < accel_deg {
        return Err(Problem::GyroUnit { gyro_deg, accel_deg });
    }
    Ok(())
}

struct Window {
    /// Sum of the specific force; only its direction matters.
    accel: [f64; 3],
    /// Integral of the rate's length.
    gyro_deg: f64,
}

fn windows(rows: &[Row]) -> Vec<Window> {
    let mut windows = Vec::new();
    let mut open = Window { accel: [0.0; 3], gyro_deg: 0.0 };
    let mut began_s = rows.first().map_or(0.0, |row| row.t_s);
    for pair in rows.windows(2) {
        let dt_s = (pair[1].t_s - pair[0].t_s).min(WINDOW_S); // a gap says nothing of what happened in it
        open.gyro_deg += norm(pair[1].gyro_dps) * dt_s;
        for (sum, value) in open.accel.iter_mut().zip(pair[1].accel_g) {
            *sum += value;
        }
        if pair[1].t_s - began_s >= WINDOW_S {
            began_s = pair[1].t_s;
            windows.push(std::mem::replace(&mut open, Window { accel: [0.0; 3], gyro_deg: 0.0 }));
        }
    }
    windows
}

fn angle_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
    let lengths = norm(a) * norm(b);
    if lengths > 0.0 { (dot / lengths).clamp(-1.0, 1.0).acos().to_degrees() } else { 0.0 }
}
