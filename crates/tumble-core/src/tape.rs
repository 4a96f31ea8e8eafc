//! The session's memory: decimated sums instead of a raw buffer.
//!
//! A record holds the rotation vector and the mean specific force over an interval: 1/12 s while it moves, 0.5 s at rest.
//! A simulated 200 s session lost nothing measurable by it (`design.md` §2). A record is 14 bytes; rounding remainders are
//! carried into the next record, so that sums over a turn stay exact to half a unit: 15 µrad, 2.4 ppm of a revolution.

use heapless::Vec;
use nalgebra::Vector3;

use crate::face::Face;
use crate::motion::grain::Grain;
pub use crate::motion::record::Record;

/// One unit of rotation, rad: ±32767 units reach ±1 rad, which a record of one 62.5 Hz sample fills at 3600 °/s.
pub const ANGLE_UNIT_RAD: f32 = 1.0 / 32768.0;
/// One unit of specific force, m/s² (50 µg): ±16 m/s² reach beyond any still or turn on a table; hand moves, whose
/// specific force is not used, may saturate.
pub const FORCE_UNIT_MPS2: f32 = 1.0 / 2048.0;
/// One unit of time, µs: 65 535 units reach 0.65 s.
const TIME_UNIT_US: f32 = 10.0;

#[derive(Clone, Copy, Debug, Default)]
struct Packed {
    time: u16,
    rotation: [i16; 3],
    force: [i16; 3],
}

/// What happened in an interval between two instants of the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// At rest.
    Still {
        /// Which axis is up, if any.
        face: Option<Face>,
        /// Variance of one sample's angular rate about the mean, pooled over the axes, (rad/s)².
        rate_variance: f32,
    },
    /// On one face, on the table, all the way.
    OnTable {
        /// Which axis is up.
        face: Face,
        /// Rotation about up by the raw gyroscope less its resting rate, rad, counter-clockwise from above positive.
        angle_rad: f32,
    },
    /// Anything else.
    Hand,
}

/// Why a segment is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exclusion {
    /// It is used.
    None,
    /// A reading stood at the end of its range.
    Clipped,
    /// Samples are missing.
    Gap,
    /// The person asked for this face again.
    Redone,
    /// It turned steadily: what was first taken for rest disagrees with the rate of later rests.
    SteadyTurn,
    /// The gyroscope's bias jumped in it.
    BiasJump,
    /// It does not fit the rest.
    Outlier,
}

/// A run of records of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// What.
    pub kind: Kind,
    /// First record.
    pub first: u16,
    /// One past the last record.
    pub end: u16,
    /// µs.
    pub start_us: u64,
    /// µs.
    pub end_us: u64,
    /// Whether it may be used.
    pub exclusion: Exclusion,
    /// Channels that stood at an end of their range: bits 0–2 gyroscope x–z, 3–5 accelerometer x–z.
    pub clipped: u8,
    /// How many samples had such a channel.
    pub clipped_samples: u16,
}

impl Segment {
    /// Length, s.
    pub fn duration_s(&self) -> f32 {
        (self.end_us - self.start_us) as f32 * 1e-6
    }

    /// The face that is up, for stills and turns.
    pub fn face(&self) -> Option<Face> {
        match self.kind {
            Kind::Still { face, .. } => face,
            Kind::OnTable { face, .. } => Some(face),
            Kind::Hand => None,
        }
    }

    /// Is it a still that may be used?
    pub fn is_usable_still(&self) -> bool {
        matches!(self.kind, Kind::Still { .. }) && self.exclusion == Exclusion::None
    }
}

/// By how much the gyroscope's bias has jumped since the first record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasJumps {
    /// All together, rad/s.
    pub total_rad_s: Vector3<f32>,
    /// The largest, rad/s.
    pub largest_rad_s: Vector3<f32>,
}

impl BiasJumps {
    /// None.
    pub const fn new() -> Self {
        let zero = Vector3::new(0.0, 0.0, 0.0);
        Self { total_rad_s: zero, largest_rad_s: zero }
    }

    /// Takes one more, rad/s.
    pub fn take(&mut self, by: &Vector3<f32>) {
        self.total_rad_s += by;
        if by.norm_squared() > self.largest_rad_s.norm_squared() {
            self.largest_rad_s = *by;
        }
    }

    /// Was there any?
    pub fn any(&self) -> bool {
        self.largest_rad_s != Vector3::zeros()
    }
}

impl Default for BiasJumps {
    fn default() -> Self {
        Self::new()
    }
}

/// No room for another record or segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

/// At most `R` records in at most `S` segments.
#[derive(Clone, Debug)]
pub struct Tape<const R: usize, const S: usize> {
    records: Vec<Packed, R>,
    segments: Vec<Segment, S>,
    rotation_left: Vector3<f32>,
    force_left: Vector3<f32>,
    time_left_us: f32,
    temperature_sum_degc: f32,
    temperature_count: u32,
    /// How coarse the readings are that the records are sums of.
    pub grain: Grain,
    /// What is put on the tape now is the sample's rate less the total of these.
    pub bias_jumps: BiasJumps,
}

impl<const R: usize, const S: usize> Default for Tape<R, S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const R: usize, const S: usize> Tape<R, S> {
    /// Empty.
    pub const fn new() -> Self {
        Self {
            records: Vec::new(),
            segments: Vec::new(),
            rotation_left: Vector3::new(0.0, 0.0, 0.0),
            force_left: Vector3::new(0.0, 0.0, 0.0),
            time_left_us: 0.0,
            temperature_sum_degc: 0.0,
            temperature_count: 0,
            grain: Grain::new(),
            bias_jumps: BiasJumps::new(),
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.records.clear();
        self.segments.clear();
        self.rotation_left = Vector3::zeros();
        self.force_left = Vector3::zeros();
        self.time_left_us = 0.0;
        self.temperature_sum_degc = 0.0;
        self.temperature_count = 0;
        self.grain = Grain::new();
        self.bias_jumps = BiasJumps::new();
    }

    /// Number of records.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// No records?
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// How full, 0 to 1: the fuller of the two stores.
    pub fn fill(&self) -> f32 {
        let records = self.records.len() as f32 / R as f32;
        let segments = self.segments.len() as f32 / S as f32;
        records.max(segments)
    }

    /// Appends a record, rounding with carry.
    pub fn push(&mut self, record: &Record) -> Result<(), Full> {
        let mut packed = Packed::default();
        let time_us = record.dt_s * 1e6 + self.time_left_us;
        packed.time = libm::roundf(time_us / TIME_UNIT_US).clamp(0.0, 65_535.0) as u16;
        for axis in 0..3 {
            let rotation = record.rotation_rad[axis] + self.rotation_left[axis];
            packed.rotation[axis] = units(rotation, ANGLE_UNIT_RAD);
            let force = record.specific_force_mps2[axis] + self.force_left[axis];
            packed.force[axis] = units(force, FORCE_UNIT_MPS2);
        }
        self.records.push(packed).map_err(|_| Full)?;
        self.time_left_us = remainder(time_us, f32::from(packed.time) * TIME_UNIT_US, TIME_UNIT_US);
        for axis in 0..3 {
            let rotation = record.rotation_rad[axis] + self.rotation_left[axis];
            let kept = f32::from(packed.rotation[axis]) * ANGLE_UNIT_RAD;
            self.rotation_left[axis] = remainder(rotation, kept, ANGLE_UNIT_RAD);
            let force = record.specific_force_mps2[axis] + self.force_left[axis];
            self.force_left[axis] = remainder(force, f32::from(packed.force[axis]) * FORCE_UNIT_MPS2, FORCE_UNIT_MPS2);
        }
        Ok(())
    }

    /// The record at `index`, or none past the end.
    pub fn record(&self, index: usize) -> Option<Record> {
        self.records.get(index).map(|packed| Record {
            dt_s: f32::from(packed.time) * (TIME_UNIT_US * 1e-6),
            rotation_rad: Vector3::from(packed.rotation.map(|c| f32::from(c) * ANGLE_UNIT_RAD)),
            specific_force_mps2: Vector3::from(packed.force.map(|c| f32::from(c) * FORCE_UNIT_MPS2)),
        })
    }

    /// Replaces the records from `first` on, but for the last `keep`, by one: what was rest is kept coarsely.
    /// Rotation vectors add up, which at rest (rotations of microradians) is exact.
    pub fn merge(&mut self, first: usize, keep: usize) {
        let end = self.records.len().saturating_sub(keep);
        if end <= first + 1 {
            return;
        }
        let (mut dt_s, mut rotation, mut impulse) = (0.0f32, Vector3::zeros(), Vector3::zeros());
        for index in first..end {
            if let Some(record) = self.record(index) {
                dt_s += record.dt_s;
                rotation += record.rotation_rad;
                impulse += record.specific_force_mps2 * record.dt_s;
            }
        }
        let mut tail: Vec<Packed, 32> = Vec::new();
        for packed in self.records.iter().skip(end) {
            if tail.push(*packed).is_err() {
                return;
            }
        }
        self.records.truncate(first);
        let merged = Record { dt_s, rotation_rad: rotation, specific_force_mps2: impulse / dt_s };
        // Room is certain: at least two records became one.
        let _ = self.push(&merged);
        for packed in tail {
            let _ = self.records.push(packed);
        }
    }

    /// Drops all segments and the first `count` records.
    pub fn drop_front(&mut self, count: usize) {
        self.segments.clear();
        let count = count.min(self.records.len());
        self.records.rotate_left(count);
        let left = self.records.len() - count;
        self.records.truncate(left);
    }

    /// Closes a segment over the records from `segment.first` to `segment.end`.
    pub fn close(&mut self, segment: Segment) -> Result<(), Full> {
        self.segments.push(segment).map_err(|_| Full)
    }

    /// All segments in order of time.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// For marking exclusions.
    pub fn segments_mut(&mut self) -> &mut [Segment] {
        &mut self.segments
    }

    /// Takes note of a temperature; NaN is passed over.
    pub fn note_temperature(&mut self, degc: f32) {
        if degc.is_finite() {
            self.temperature_sum_degc += degc;
            self.temperature_count += 1;
        }
    }

    /// Mean of the temperatures noted, °C; NaN if there were none.
    pub fn temperature_degc(&self) -> f32 {
        if self.temperature_count == 0 {
            return f32::NAN;
        }
        self.temperature_sum_degc / self.temperature_count as f32
    }
}

fn units(value: f32, unit: f32) -> i16 {
    libm::roundf(value / unit).clamp(-32_767.0, 32_767.0) as i16
}

/// What rounding left over; nothing is carried out of a saturated record.
fn remainder(value: f32, kept: f32, unit: f32) -> f32 {
    let left = value - kept;
    if libm::fabsf(left) <= unit { left } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(rotation: f32) -> Record {
        Record {
            dt_s: 0.050_003,
            rotation_rad: Vector3::repeat(rotation),
            specific_force_mps2: Vector3::repeat(9.806_65),
        }
    }

    #[test]
    fn sums_stay_exact_to_half_a_unit() {
        let mut tape: Tape<400, 4> = Tape::new();
        for _ in 0..400 {
            tape.push(&record(0.015_711_1)).expect("room");
        }
        let total: f64 = (0..400).filter_map(|i| tape.record(i)).map(|r| f64::from(r.rotation_rad.x)).sum();
        assert!((total - 400.0 * f64::from(0.015_711_1f32)).abs() < 0.6 * f64::from(ANGLE_UNIT_RAD), "{total}");
        let time: f64 = (0..400).filter_map(|i| tape.record(i)).map(|r| f64::from(r.dt_s)).sum();
        assert!((time - 20.001_2).abs() < 1e-5, "{time}");
        assert_eq!(tape.push(&record(0.0)), Err(Full));
    }

    #[test]
    fn merging_keeps_sums_and_the_tail() {
        let mut tape: Tape<40, 4> = Tape::new();
        for i in 0..12 {
            tape.push(&record(1e-3 * i as f32)).expect("room");
        }
        tape.merge(2, 3);
        assert_eq!(tape.len(), 6);
        let merged = tape.record(2).expect("there");
        assert!((merged.dt_s - 7.0 * 0.050_003).abs() < 2e-5);
        assert!((merged.rotation_rad.x - 1e-3 * (2..9).sum::<i32>() as f32).abs() < 2.0 * ANGLE_UNIT_RAD);
        assert!((tape.record(5).expect("there").rotation_rad.x - 0.011).abs() < 2.0 * ANGLE_UNIT_RAD);
    }
}
