//! Recordings as CSV (`docs/recording.md` is the contract's format): reading, checking, writing.
//!
//! Text is kept in `f64` and in the file's own units (°/s, g), so that writing what was read loses nothing;
//! [`Recording::samples`] is the one place where it becomes the core's `f32` and SI.

mod error;
mod inference;
mod metadata;
mod reader;
mod units;
mod writer;

use nalgebra::Vector3;
use tumble_core::sample::{Counts, Ranges, Sample};

pub use error::{Problem, RecordingError};
pub use inference::{Basis, Gap, Inference, Known};
pub use metadata::{BoxFaces, Metadata, TurnStops};
pub(crate) use metadata::{box_faces, turns};
pub use writer::RowWriter;

/// Exact by definition (CGPM 1901).
pub const STANDARD_GRAVITY_MPS2: f64 = 9.806_65;

/// One line of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The stamp as it stands, or moved ([`Recording::stamps_s`]).
    pub t_s: f64,
    /// Angular rate x, y, z.
    pub gyro_dps: [f64; 3],
    /// Specific force x, y, z.
    pub accel_g: [f64; 3],
    /// Die temperature; none where the file has none or says NaN.
    pub temp_c: Option<f64>,
}

impl Row {
    /// The six inertial channels: gyroscope x–z, accelerometer x–z.
    pub fn channels(&self) -> [f64; 6] {
        let ([gx, gy, gz], [ax, ay, az]) = (self.gyro_dps, self.accel_g);
        [gx, gy, gz, ax, ay, az]
    }
}

/// One sample as the core takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// SI, `f32`.
    pub sample: Sample,
    /// Channels at an end of their range, where a value is a bound and not a measurement; bits as in
    /// [`Counts::clipped`].
    pub clipped: u8,
}

/// A recording that passed every check.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What it says of itself.
    pub metadata: Metadata,
    /// At least one; time increases.
    pub rows: Vec<Row>,
    /// Remarks for the person: what was left out, and why.
    pub notices: Vec<String>,
    /// The file's own stamps, s, where some had to be moved for time to increase; else empty.
    pub stamps_s: Vec<f64>,
}

impl Recording {
    /// The first stamp, which is time zero of [`Self::samples`].
    pub fn origin_s(&self) -> f64 {
        self.rows.first().map_or(0.0, |row| row.t_s)
    }

    /// The core's samples. Roundings, all to nearest: time since the first stamp to 1 µs (at most 0.5 µs, 0.01 % of
    /// 5 ms and not cumulative); each reading once from `f64` to `f32` after the change of unit (relative 6e-8, 1/500 of
    /// a count at full scale).
    pub fn samples(&self, inference: &Inference) -> Vec<Reading> {
        let origin_s = self.origin_s();
        self.rows.iter().map(|row| Reading { sample: to_si(row, origin_s), clipped: inference.clipped(row) }).collect()
    }
}

fn to_si(row: &Row, origin_s: f64) -> Sample {
    Sample {
        t_us: time_us(row.t_s, origin_s),
        angular_rate_rad_s: Vector3::from(row.gyro_dps.map(|v| v.to_radians() as f32)),
        specific_force_mps2: Vector3::from(row.accel_g.map(|v| (v * STANDARD_GRAVITY_MPS2) as f32)),
        temperature_degc: row.temp_c.map_or(f32::NAN, |v| v as f32),
    }
}

/// Microseconds since `origin_s`, to nearest.
fn time_us(t_s: f64, origin_s: f64) -> u64 {
    ((t_s - origin_s) * 1e6).round() as u64
}

/// What the board would have read: the nearest counts of its ranges, turned back to SI by the board's own arithmetic.
/// A replay on the emulated board goes through the sensor's registers and so through this rounding.
pub fn as_board_reads(reading: &Reading, ranges: &Ranges) -> Reading {
    let sample = &reading.sample;
    let count = |value: f32, step: f32| (value / step).round() as i16; // `as` saturates, as the chip does
    let counts = Counts {
        gyro: sample.angular_rate_rad_s.map(|v| count(v, ranges.gyro_count_rad_s())).into(),
        accel: sample.specific_force_mps2.map(|v| count(v, ranges.accel_count_mps2())).into(),
        temperature: count(sample.temperature_degc - 21.0, 1.0 / 333.87),
    };
    let board = ranges.to_si(sample.t_us, &counts);
    let temperature_degc = if sample.temperature_degc.is_nan() { f32::NAN } else { board.temperature_degc };
    Reading { sample: Sample { temperature_degc, ..board }, clipped: reading.clipped | counts.clipped() }
}
