//! What the sensor says, and its one conversion to SI.

use nalgebra::Vector3;

use crate::{DEGREE_RAD, STANDARD_GRAVITY_MPS2};

/// One reading in the sensor's own counts, right-handed sensor frame `s`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Angular rate, full scale at ±32768.
    pub gyro: [i16; 3],
    /// Specific force, full scale at ±32768.
    pub accel: [i16; 3],
    /// Die temperature.
    pub temperature: i16,
}

/// One reading in SI units, sensor frame `s`, errors and all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time of the data-ready edge by the microcontroller's crystal, µs since start.
    pub t_us: u64,
    /// Angular rate, rad/s.
    pub angular_rate_rad_s: Vector3<f32>,
    /// Specific force (up at rest), m/s².
    pub specific_force_mps2: Vector3<f32>,
    /// Die temperature, °C; NaN where the source has none.
    pub temperature_degc: f32,
}

/// The measuring ranges in force, which fix what a count is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// Gyroscope full scale, °/s (250, 500, 1000 or 2000 on the MPU9250).
    pub gyro_full_scale_dps: f32,
    /// Accelerometer full scale, g (2, 4, 8 or 16 on the MPU9250).
    pub accel_full_scale_g: f32,
}

impl Ranges {
    /// What the firmware sets: the widest. A count is 0.061 °/s and 0.49 mg, whose rounding error (0.018 °/s and 0.14 mg,
    /// one sigma) hides below one sample's noise (0.08 °/s and 2.4 mg in 41 Hz), and no hand reaches the ends.
    pub const WIDEST: Self = Self { gyro_full_scale_dps: 2000.0, accel_full_scale_g: 16.0 };

    /// One gyroscope count in rad/s.
    pub fn gyro_count_rad_s(&self) -> f32 {
        self.gyro_full_scale_dps / 32768.0 * DEGREE_RAD
    }

    /// One accelerometer count in m/s².
    pub fn accel_count_mps2(&self) -> f32 {
        self.accel_full_scale_g / 32768.0 * STANDARD_GRAVITY_MPS2
    }

    /// Counts to SI. Temperature by the MPU-9250 register map: `counts / 333.87 + 21 °C`.
    pub fn to_si(&self, t_us: u64, counts: &Counts) -> Sample {
        let gyro = self.gyro_count_rad_s();
        let accel = self.accel_count_mps2();
        Sample {
            t_us,
            angular_rate_rad_s: Vector3::from(counts.gyro.map(|c| f32::from(c) * gyro)),
            specific_force_mps2: Vector3::from(counts.accel.map(|c| f32::from(c) * accel)),
            temperature_degc: f32::from(counts.temperature) / 333.87 + 21.0,
        }
    }
}

impl Counts {
    /// Channels at an end of their range, where a value is a bound and not a measurement: bits 0–2 gyroscope x–z, 3–5
    /// accelerometer x–z.
    pub fn clipped(&self) -> u8 {
        let ends = |c: i16| u8::from(c == i16::MAX || c == i16::MIN);
        self.gyro.iter().chain(&self.accel).enumerate().fold(0, |mask, (channel, &c)| mask | ends(c) << channel)
    }
}

/// The sensor's own sample period, by the microcontroller's clock, and what was missed against it.
///
/// The sensor's oscillator is off by up to 1 % (sheet), and what feeds an emulated one has a rate of its own. So the period is
/// the median of the first gaps after a start, and not the nominal one.
#[derive(Clone, Debug)]
pub struct Cadence {
    gaps_us: heapless::Vec<f32, LEARNT_GAPS>,
    period_us: u32,
}

/// Gaps that the period is learnt from: 0.16 s at 200 Hz. Half of them may be disturbed.
const LEARNT_GAPS: usize = 32;

impl Default for Cadence {
    fn default() -> Self {
        Self::new()
    }
}

impl Cadence {
    /// Nothing learnt yet.
    pub const fn new() -> Self {
        Self { gaps_us: heapless::Vec::new(), period_us: 0 }
    }

    /// The period, µs; none while it is learnt.
    pub fn period_us(&self) -> Option<u32> {
        (self.period_us > 0).then_some(self.period_us)
    }

    /// Samples missed in a gap between two readings; none are counted while the period is learnt. Rounded to whole
    /// periods: a stamp is off by some µs, so the count is right up to hundreds of them.
    pub fn missed(&mut self, gap_us: u64) -> u32 {
        let gap_us = u32::try_from(gap_us).unwrap_or(u32::MAX);
        if self.period_us == 0 {
            self.learn(gap_us);
            return 0;
        }
        (gap_us.saturating_add(self.period_us / 2) / self.period_us).saturating_sub(1)
    }

    fn learn(&mut self, gap_us: u32) {
        let _ = self.gaps_us.push(gap_us as f32);
        if self.gaps_us.is_full() {
            let median = crate::order::median(&mut self.gaps_us).unwrap_or(1.0);
            self.period_us = (median as u32).max(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cadence_learns_any_rate_and_counts_what_is_missed() {
        for period in [4950u64, 5000, 9766, 16_000] {
            let mut cadence = Cadence::new();
            for k in 0..LEARNT_GAPS as u64 {
                assert_eq!(cadence.missed(if k % 5 == 0 { 3 * period } else { period + k % 3 }), 0);
            }
            assert!(cadence.period_us().is_some_and(|found| u64::from(found).abs_diff(period) < 3));
            assert_eq!([1, 2, 7, 100].map(|n| cadence.missed(n * period + 2)), [0, 1, 6, 99]);
            assert_eq!(cadence.missed(period / 3), 0);
        }
    }

    #[test]
    fn counts_become_si_and_ends_of_range_are_seen() {
        let counts = Counts { gyro: [16384, -32768, 0], accel: [2048, 0, 32767], temperature: -7012 };
        let sample = Ranges::WIDEST.to_si(7, &counts);
        assert!((sample.angular_rate_rad_s.x - 1000.0 * DEGREE_RAD).abs() < 1e-4);
        assert!((sample.specific_force_mps2.x - STANDARD_GRAVITY_MPS2).abs() < 1e-5);
        assert!((sample.temperature_degc - 0.0).abs() < 0.01);
        assert_eq!(counts.clipped(), 0b10_0010);
    }
}
