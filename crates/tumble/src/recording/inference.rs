//! What a recording does not say but shows: ranges, rate, gaps, and where a channel hit the end of its range.

use super::{Recording, Row};

/// Where a value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// The metadata.
    Stated,
    /// The least step between readings, which is one count.
    Step,
    /// The smallest usual range that holds the largest reading: a lower bound only.
    Largest,
}

/// A range with where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Full scale in the column's unit.
    pub value: f64,
    /// How it is known.
    pub basis: Basis,
}

/// Samples that never came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Stamp of the last sample before it.
    pub start_s: f64,
    /// How long.
    pub length_s: f64,
    /// How many samples of the usual spacing would fit.
    pub missing: u64,
}

/// All that was inferred.
#[derive(Clone, Debug, PartialEq)]
pub struct Inference {
    /// °/s.
    pub gyro_range_dps: Known,
    /// g.
    pub accel_range_g: Known,
    /// By the stamps, gaps left out.
    pub rate_hz: f64,
    /// In order of time.
    pub gaps: Vec<Gap>,
    /// For each channel, gyroscope x–z then accelerometer x–z, the readings from which on it is clipped.
    clipped: [Limits; 6],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Limits {
    low: f64,
    high: f64,
}

/// Full scales in use: every power of two from 125 °/s and from 2 g.
const GYRO_RANGES: [f64; 6] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0];
const ACCEL_RANGES: [f64; 5] = [2.0, 4.0, 8.0, 16.0, 32.0];

impl Inference {
    /// Looks through the whole recording.
    pub fn of(recording: &Recording) -> Self {
        let rows = &recording.rows;
        let channels: [Vec<f64>; 6] = std::array::from_fn(|c| rows.iter().map(|row| row.channels()[c]).collect());
        let meta = &recording.metadata;
        let gyro_range_dps = range(meta.gyro_range_dps, &channels[..3], &GYRO_RANGES);
        let accel_range_g = range(meta.accel_range_g, &channels[3..], &ACCEL_RANGES);
        let spacing_s = median_spacing(rows);
        let clipped = std::array::from_fn(|c| {
            limits(&channels[c], if c < 3 { gyro_range_dps.value } else { accel_range_g.value })
        });
        Self { gyro_range_dps, accel_range_g, rate_hz: rate(rows, spacing_s), gaps: gaps(rows, spacing_s), clipped }
    }

    /// Channels of this row at an end of their range: bits 0–2 gyroscope x–z, 3–5 accelerometer x–z.
    pub fn clipped(&self, row: &Row) -> u8 {
        let ends = row.channels().into_iter().zip(&self.clipped).map(|(value, limits)| limits.contain(value));
        ends.enumerate().fold(0, |mask, (channel, end)| mask | u8::from(end) << channel)
    }

    /// Samples that never came, over all gaps.
    pub fn missing(&self) -> u32 {
        u32::try_from(self.gaps.iter().map(|gap| gap.missing).sum::<u64>()).unwrap_or(u32::MAX)
    }

    /// How many rows each channel is clipped in.
    pub fn clipped_counts(&self, rows: &[Row]) -> [usize; 6] {
        std::array::from_fn(|c| rows.iter().filter(|row| self.clipped[c].contain(row.channels()[c])).count())
    }
}

impl Limits {
    fn contain(self, value: f64) -> bool {
        value <= self.low || value >= self.high
    }
}

fn largest(channels: &[Vec<f64>]) -> f64 {
    channels.iter().flatten().fold(0.0, |max: f64, v| max.max(v.abs()))
}

fn range(stated: Option<f64>, channels: &[Vec<f64>], usual: &[f64]) -> Known {
    if let Some(value) = stated {
        return Known { value, basis: Basis::Stated };
    }
    let largest = largest(channels);
    let mut steps: Vec<f64> = channels.iter().filter_map(|channel| least_step(channel)).collect();
    steps.sort_by(f64::total_cmp);
    // Makers' counts differ from range/2^15 by 0.05 % (131 counts per °/s) to 15 % (70 mdps for 2000 °/s).
    let by_step = steps.get(steps.len() / 2).and_then(|step| {
        usual.iter().copied().find(|full| (0.95..1.2).contains(&(step * 32768.0 / full)) && largest <= full * 1.2)
    });
    match by_step {
        Some(value) => Known { value, basis: Basis::Step },
        None => {
            let value = usual.iter().copied().find(|full| largest <= full * 1.001).unwrap_or(largest);
            Known { value, basis: Basis::Largest }
        }
    }
}

/// The spacing that at least every twentieth pair of neighbouring values has: at rest noise visits adjacent counts, so
/// one count is by far the commonest spacing; decimals of the text shift it by less than 2 %. Without quantisation this
/// is some tiny number that fits no range.
fn least_step(channel: &[f64]) -> Option<f64> {
    let mut values = channel.to_vec();
    values.sort_by(f64::total_cmp);
    let mut gaps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 1e-9).collect();
    gaps.sort_by(f64::total_cmp);
    gaps.get(gaps.len() / 20).copied()
}

fn median_spacing(rows: &[Row]) -> f64 {
    let mut spacings: Vec<f64> = rows.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).collect();
    spacings.sort_by(f64::total_cmp);
    spacings.get(spacings.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Half a sample more than usual is jitter; more is a sample that never came.
const GAP_SPACINGS: f64 = 1.5;

/// Mean over all spacings that are no gaps, since single stamps are rounded to the text's last decimal.
fn rate(rows: &[Row], spacing_s: f64) -> f64 {
    let usual = rows.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).filter(|dt| *dt <= GAP_SPACINGS * spacing_s);
    let (count, sum) = usual.fold((0.0, 0.0), |(count, sum), dt| (count + 1.0, sum + dt));
    count / sum
}

fn gaps(rows: &[Row], spacing_s: f64) -> Vec<Gap> {
    rows.windows(2)
        .map(|pair| (pair[0].t_s, pair[1].t_s - pair[0].t_s))
        .filter(|(_, length_s)| *length_s > GAP_SPACINGS * spacing_s)
        .map(|(start_s, length_s)| Gap {
            start_s,
            length_s,
            missing: ((length_s / spacing_s).round() as u64).saturating_sub(1),
        })
        .collect()
}

/// Clipped where a reading is at the end of the range, or where readings pile up at the extreme.
fn limits(channel: &[f64], full_scale: f64) -> Limits {
    let end = full_scale * 0.998; // makers' counts fall short of range/2^15 by up to 0.1 % (16.4 counts per °/s for 2000)
    let upper = pile_up(channel.iter().copied(), full_scale);
    let lower = pile_up(channel.iter().map(|v| -v), full_scale);
    Limits { low: (-end).max(-lower), high: end.min(upper) }
}

/// The largest reading if the channel stands at it: three in a row exactly equal, more there than in the 2 % below it,
/// and far out (a quarter of full scale), where noise and motion never repeat a value by chance. Infinity if not.
fn pile_up(channel: impl Iterator<Item = f64> + Clone, full_scale: f64) -> f64 {
    let max = channel.clone().fold(f64::NEG_INFINITY, f64::max);
    if max < full_scale / 4.0 {
        return f64::INFINITY;
    }
    let (mut run, mut longest, mut at, mut near) = (0, 0, 0, 0);
    for value in channel {
        run = if value == max { run + 1 } else { 0 };
        longest = longest.max(run);
        at += usize::from(value == max);
        near += usize::from(value < max && value > 0.98 * max);
    }
    if longest >= 3 && at > near { max } else { f64::INFINITY }
}
