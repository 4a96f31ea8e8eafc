//! The part's built-in self-test: it pushes its own masses, and the response is compared with the factory's.
//!
//! Procedure, formula and limits: InvenSense AN-MPU-9250A-03 rev. 1.0. The sensor must lie still meanwhile.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::SpiDevice;

use crate::configuration::{AccelRange, Configuration, GyroRange};
use crate::device::Mpu9250;
use crate::error::Error;
use crate::register::Register;

/// Readings averaged in each of the two states (application note, steps 1 and 3).
const AVERAGED: u16 = 200;
/// For the pushed masses to settle (steps 2 and 4).
const SETTLE_MS: u32 = 20;
/// Self-test bits of all three axes in `GYRO_CONFIG` and `ACCEL_CONFIG`.
const PUSH: u8 = 0xE0;
/// Lowest ratio of response to factory trim, both sensors; the gyroscope has no upper bound.
const RATIO_MIN: f32 = 0.5;
/// Highest ratio for the accelerometer.
const RATIO_MAX: f32 = 1.5;
/// Counts of one °/s at ±250 °/s, and the least response where the factory left no trim (60 °/s).
const GYRO_MIN_COUNTS: f32 = 60.0 * 32768.0 / 250.0;
/// Least and largest response of the accelerometer at ±2 g without a trim (225 and 675 mg).
const ACCEL_MIN_COUNTS: f32 = 0.225 * 32768.0 / 2.0;
const ACCEL_MAX_COUNTS: f32 = 0.675 * 32768.0 / 2.0;

/// What a response was compared with.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Basis {
    /// The factory's trim in counts: `response` is the ratio to it.
    FactoryTrim(f32),
    /// The part has no trim (code 0): `response` is the ratio to the least allowed response.
    Absolute,
}

/// One axis.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct AxisResult {
    /// Response over its basis; 1 is as from the factory.
    pub response: f32,
    /// What it was compared with.
    pub basis: Basis,
    /// Within the limits.
    pub ok: bool,
}

/// All six axes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SelfTest {
    /// x, y, z.
    pub gyro: [AxisResult; 3],
    /// x, y, z.
    pub accel: [AxisResult; 3],
}

impl SelfTest {
    /// All six.
    pub fn is_ok(&self) -> bool {
        self.gyro.iter().chain(&self.accel).all(|axis| axis.ok)
    }
}

/// `2620 / 2^FS · 1.01^(code − 1)` counts, here with FS = 0. By multiplication, since `core` has no power: at most 254
/// roundings, 1.5e-5 relative, against limits of a half.
pub(crate) fn factory_trim(code: u8) -> f32 {
    (1..code).fold(2620.0, |trim, _| trim * 1.01)
}

pub(crate) fn judge_gyro(code: u8, response: f32) -> AxisResult {
    if code == 0 {
        let ratio = magnitude(response) / GYRO_MIN_COUNTS;
        return AxisResult { response: ratio, basis: Basis::Absolute, ok: ratio >= 1.0 };
    }
    let trim = factory_trim(code);
    let ratio = response / trim;
    AxisResult { response: ratio, basis: Basis::FactoryTrim(trim), ok: ratio > RATIO_MIN }
}

pub(crate) fn judge_accel(code: u8, response: f32) -> AxisResult {
    if code == 0 {
        let size = magnitude(response);
        let ok = (ACCEL_MIN_COUNTS..=ACCEL_MAX_COUNTS).contains(&size);
        return AxisResult { response: size / ACCEL_MIN_COUNTS, basis: Basis::Absolute, ok };
    }
    let trim = factory_trim(code);
    let ratio = response / trim;
    AxisResult { response: ratio, basis: Basis::FactoryTrim(trim), ok: ratio > RATIO_MIN && ratio < RATIO_MAX }
}

fn magnitude(x: f32) -> f32 {
    if x < 0.0 { -x } else { x }
}

/// Mean of the six channels, in counts.
struct Mean {
    gyro: [f32; 3],
    accel: [f32; 3],
}

impl<S: SpiDevice, D: DelayNs> Mpu9250<S, D> {
    /// Runs the self-test (half a second), then writes `configuration` back, also when the test could not be finished.
    pub async fn self_test(&mut self, configuration: &Configuration) -> Result<SelfTest, Error<S::Error>> {
        let result = self.push_and_compare().await;
        self.configure(configuration).await?;
        self.delay_ms(SETTLE_MS).await;
        result
    }

    async fn push_and_compare(&mut self) -> Result<SelfTest, Error<S::Error>> {
        // 1 kHz, 92 Hz filters, ±250 °/s, ±2 g.
        let quiet = Configuration {
            gyro_range: GyroRange::Dps250,
            accel_range: AccelRange::G2,
            gyro_filter: 2,
            accel_filter: 2,
            rate_divider: 0,
        };
        self.configure(&quiet).await?;
        self.delay_ms(SETTLE_MS).await;
        let rest = self.mean().await?;
        self.write_checked(Register::ACCEL_CONFIG, PUSH).await?;
        self.write_checked(Register::GYRO_CONFIG, PUSH).await?;
        self.delay_ms(SETTLE_MS).await;
        let pushed = self.mean().await?;
        self.write_checked(Register::ACCEL_CONFIG, 0).await?;
        self.write_checked(Register::GYRO_CONFIG, 0).await?;
        self.delay_ms(SETTLE_MS).await;
        let gyro_codes = self.codes(Register::SELF_TEST_X_GYRO).await?;
        let accel_codes = self.codes(Register::SELF_TEST_X_ACCEL).await?;
        Ok(SelfTest {
            gyro: core::array::from_fn(|i| judge_gyro(gyro_codes[i], pushed.gyro[i] - rest.gyro[i])),
            accel: core::array::from_fn(|i| judge_accel(accel_codes[i], pushed.accel[i] - rest.accel[i])),
        })
    }

    async fn codes(&mut self, first: Register) -> Result<[u8; 3], Error<S::Error>> {
        let mut codes = [0; 3];
        for (code, address) in codes.iter_mut().zip(first.0..) {
            *code = self.read_register(Register(address)).await?;
        }
        Ok(codes)
    }

    async fn mean(&mut self) -> Result<Mean, Error<S::Error>> {
        let (mut gyro, mut accel) = ([0_i32; 3], [0_i32; 3]);
        for _ in 0..AVERAGED {
            let reading = self.next_fresh().await?;
            for i in 0..3 {
                gyro[i] += i32::from(reading.gyro[i]);
                accel[i] += i32::from(reading.accel[i]);
            }
        }
        // At most 200 · 32768 = 6.6e6, which an f32 holds exactly.
        let mean = |sums: [i32; 3]| sums.map(|sum| sum as f32 / f32::from(AVERAGED));
        Ok(Mean { gyro: mean(gyro), accel: mean(accel) })
    }

    /// The next new reading, looked for every millisecond; after fifty the part is taken for stopped.
    async fn next_fresh(&mut self) -> Result<crate::Reading, Error<S::Error>> {
        const POLLS: u16 = 50;
        for _ in 0..POLLS {
            self.delay_ms(1).await;
            let reading = self.read().await?;
            if reading.status.is_fresh() {
                return Ok(reading);
            }
        }
        Err(Error::NoData { polls: POLLS })
    }
}
