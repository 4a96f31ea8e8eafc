//! What is written to the part at start.

use crate::register::Register;

/// The gyroscope's full scale.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum GyroRange {
    /// ±250 °/s.
    Dps250 = 0,
    /// ±500 °/s.
    Dps500 = 1,
    /// ±1000 °/s.
    Dps1000 = 2,
    /// ±2000 °/s: what no hand exceeds.
    #[default]
    Dps2000 = 3,
}

/// The accelerometer's full scale.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum AccelRange {
    /// ±2 g.
    G2 = 0,
    /// ±4 g.
    G4 = 1,
    /// ±8 g.
    G8 = 2,
    /// ±16 g: what no knock on a table exceeds for long.
    #[default]
    G16 = 3,
}

impl GyroRange {
    /// Full scale in °/s.
    pub fn full_scale_dps(self) -> u16 {
        250 << self as u8
    }
}

impl AccelRange {
    /// Full scale in g.
    pub fn full_scale_g(self) -> u8 {
        2 << self as u8
    }
}

/// Ranges, filters and rate. The default is ±2000 °/s, ±16 g, 41 Hz filters, 200 Hz.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Configuration {
    /// Gyroscope's full scale.
    pub gyro_range: GyroRange,
    /// Accelerometer's full scale.
    pub accel_range: AccelRange,
    /// `DLPF_CFG`, 1 to 6; 3 is 41 Hz with 5.9 ms delay.
    pub gyro_filter: u8,
    /// `A_DLPF_CFG`, 0 to 6; 3 is 41 Hz (44.8 Hz noise bandwidth).
    pub accel_filter: u8,
    /// `SMPLRT_DIV`: the rate is 1 kHz / (1 + this). 4 gives 200 Hz.
    pub rate_divider: u8,
}

impl Default for Configuration {
    fn default() -> Self {
        Self {
            gyro_range: GyroRange::default(),
            accel_range: AccelRange::default(),
            gyro_filter: 3,
            accel_filter: 3,
            rate_divider: 4,
        }
    }
}

/// `PWR_MGMT_1`: the gyroscope's oscillator once it is ready, which is steadier than the internal one.
pub(crate) const CLOCK_BEST: u8 = 0x01;
/// `PWR_MGMT_1`: reset the part.
pub(crate) const RESET: u8 = 0x80;
/// `USER_CTRL`: the bus is SPI alone, so that no SPI traffic is taken for I²C.
pub(crate) const I2C_OFF: u8 = 0x10;
/// `INT_PIN_CFG`: active high, push-pull, latched until any register is read. Latched, because a waiter that looks at
/// the level cannot miss it, while an edge between two waits is lost.
pub(crate) const INT_LATCHED: u8 = 0x30;
/// `INT_ENABLE`: data ready.
pub(crate) const INT_DATA_READY: u8 = 0x01;

impl Configuration {
    /// Nominal output rate in Hz. The part's own oscillator is good to 1 %: never take time from it.
    pub fn rate_hz(&self) -> f32 {
        1000.0 / (1.0 + f32::from(self.rate_divider))
    }

    /// Nominal time between two readings in µs.
    pub fn period_us(&self) -> u32 {
        1000 * (1 + u32::from(self.rate_divider))
    }

    /// Registers and values in the order of writing; the interrupt last, so that the first reading is a whole one.
    pub fn writes(&self) -> [(Register, u8); 10] {
        [
            (Register::PWR_MGMT_1, CLOCK_BEST),
            (Register::PWR_MGMT_2, 0),
            (Register::USER_CTRL, I2C_OFF),
            (Register::CONFIG, self.gyro_filter & 0x07),
            (Register::SMPLRT_DIV, self.rate_divider),
            (Register::GYRO_CONFIG, (self.gyro_range as u8) << 3),
            (Register::ACCEL_CONFIG, (self.accel_range as u8) << 3),
            (Register::ACCEL_CONFIG_2, self.accel_filter & 0x07),
            (Register::INT_PIN_CFG, INT_LATCHED),
            (Register::INT_ENABLE, INT_DATA_READY),
        ]
    }
}
