//! From what the elements put out to counts at the configured full scale.

use super::registers as reg;
use super::{Mpu9250, SensorOptions};
use crate::world::{PhysicalSample, STANDARD_GRAVITY_MPS2};

/// Counts of full scale; the product's driver reads counts by the same convention.
const FULL_SCALE_COUNTS: f64 = 32768.0;
const TEMPERATURE_COUNTS_PER_DEGREE: f64 = 333.87;
const TEMPERATURE_ZERO_DEGC: f64 = 21.0;
/// Self-test bits of x, y, z in `GYRO_CONFIG` and `ACCEL_CONFIG`.
const SELF_TEST: [u8; 3] = [0x80, 0x40, 0x20];
/// `PWR_MGMT_2`: accelerometer x, y, z, then gyroscope x, y, z switched off.
const OFF: [u8; 6] = [0x20, 0x10, 0x08, 0x04, 0x02, 0x01];
/// The response of a part without trim, in counts at ±250 °/s and ±2 g: 80 °/s and 450 mg.
const UNTRIMMED: [f64; 2] = [80.0 / 250.0 * FULL_SCALE_COUNTS, 0.45 / 2.0 * FULL_SCALE_COUNTS];

/// The fourteen bytes of the data registers.
pub(super) fn counts(
    physical: &PhysicalSample,
    registers: &[u8; reg::COUNT],
    options: &SensorOptions,
) -> [u8; reg::DATA_BYTES] {
    let gyro_range = 250.0 * range_factor(registers[reg::GYRO_CONFIG]);
    let accel_range = 2.0 * range_factor(registers[reg::ACCEL_CONFIG]);
    let mut words = [0_i16; 7];
    for axis in 0..3 {
        let force_g = physical.specific_force_mps2[axis] / STANDARD_GRAVITY_MPS2;
        let push = push(1, axis, registers[reg::ACCEL_CONFIG], options);
        words[axis] = saturated(force_g / accel_range * FULL_SCALE_COUNTS + push);
        let rate_dps = physical.angular_rate_rad_s[axis].to_degrees();
        let push = self::push(0, axis, registers[reg::GYRO_CONFIG], options);
        words[4 + axis] = saturated(rate_dps / gyro_range * FULL_SCALE_COUNTS + push);
    }
    let warmth = physical.temperature_degc - TEMPERATURE_ZERO_DEGC;
    words[3] = saturated(warmth * TEMPERATURE_COUNTS_PER_DEGREE);
    for (off, word) in OFF.into_iter().zip([0, 1, 2, 4, 5, 6]) {
        if registers[reg::PWR_MGMT_2] & off != 0 {
            words[word] = 0;
        }
    }
    let mut bytes = [0; reg::DATA_BYTES];
    for (pair, word) in bytes.chunks_exact_mut(2).zip(words) {
        pair.copy_from_slice(&word.to_be_bytes());
    }
    bytes
}

fn range_factor(config: u8) -> f64 {
    f64::from(1_u8 << ((config & reg::FULL_SCALE) >> 3))
}

/// The self-test's deflection in counts at the configured range: the factory's `2620 · 1.01^(code − 1)` at the
/// finest range, times this part's response.
fn push(sensor: usize, axis: usize, config: u8, options: &SensorOptions) -> f64 {
    if config & SELF_TEST[axis] == 0 {
        return 0.0;
    }
    let index = if sensor == 0 { axis } else { 3 + axis };
    let trim = match options.self_test_codes[index] {
        0 => UNTRIMMED[sensor],
        code => 2620.0 * 1.01_f64.powi(i32::from(code) - 1),
    };
    trim * options.self_test_response[index] / range_factor(config)
}

fn saturated(counts: f64) -> i16 {
    counts.round().clamp(f64::from(i16::MIN), f64::from(i16::MAX)) as i16
}

impl Mpu9250 {
    /// The counts the chip would show for `physical` as it is configured now, for tests and the operator.
    #[must_use]
    pub fn counts_of(&self, physical: &PhysicalSample) -> [i16; 7] {
        let bytes = counts(physical, &self.registers, &self.options);
        std::array::from_fn(|word| i16::from_be_bytes([bytes[2 * word], bytes[2 * word + 1]]))
    }
}
