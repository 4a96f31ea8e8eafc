//! The register file: addresses, reset values, which bits take a write.

use super::SensorOptions;

pub const COUNT: usize = 0x80;

pub const SELF_TEST_GYRO: usize = 0x00;
pub const SELF_TEST_ACCEL: usize = 0x0D;
pub const SMPLRT_DIV: usize = 0x19;
pub const CONFIG: usize = 0x1A;
pub const GYRO_CONFIG: usize = 0x1B;
pub const ACCEL_CONFIG: usize = 0x1C;
pub const INT_PIN_CFG: usize = 0x37;
pub const INT_ENABLE: usize = 0x38;
pub const INT_STATUS: usize = 0x3A;
pub const ACCEL_XOUT_H: usize = 0x3B;
pub const EXT_SENS_DATA_23: usize = 0x60;
pub const SIGNAL_PATH_RESET: usize = 0x68;
pub const USER_CTRL: usize = 0x6A;
pub const PWR_MGMT_1: usize = 0x6B;
pub const PWR_MGMT_2: usize = 0x6C;
pub const FIFO_COUNTH: usize = 0x72;
pub const FIFO_R_W: usize = 0x74;
pub const WHO_AM_I: usize = 0x75;

/// Accelerometer, temperature, gyroscope: seven big-endian words.
pub const DATA_BYTES: usize = 14;

pub const H_RESET: u8 = 0x80;
pub const SLEEP: u8 = 0x40;
pub const CLKSEL: u8 = 0x07;
pub const CLOCK_STOPPED: u8 = 0x07;
pub const RAW_DATA_RDY: u8 = 0x01;
pub const ACTIVE_LOW: u8 = 0x80;
pub const LATCH: u8 = 0x20;
pub const ANY_READ_CLEARS: u8 = 0x10;
pub const FULL_SCALE: u8 = 0x18;
/// `FIFO_RST`, `I2C_MST_RST` and `SIG_COND_RST` clear themselves.
const SELF_CLEARING_USER: u8 = 0x07;
pub const SIG_COND_RST: u8 = 0x01;

/// RM 3: all zero but `PWR_MGMT_1`, `WHO_AM_I` and the factory's self-test codes.
pub fn defaults(options: &SensorOptions) -> [u8; COUNT] {
    let mut registers = [0; COUNT];
    registers[PWR_MGMT_1] = 0x01;
    registers[WHO_AM_I] = options.who_am_i;
    registers[SELF_TEST_GYRO..SELF_TEST_GYRO + 3].copy_from_slice(&options.self_test_codes[..3]);
    registers[SELF_TEST_ACCEL..SELF_TEST_ACCEL + 3].copy_from_slice(&options.self_test_codes[3..]);
    registers
}

/// What a write of `value` leaves in `register`, or `None` where the register takes none.
pub fn stored(register: usize, value: u8) -> Option<u8> {
    match register {
        INT_STATUS..=EXT_SENS_DATA_23 | FIFO_COUNTH..=WHO_AM_I => None,
        SIGNAL_PATH_RESET => Some(0),
        USER_CTRL => Some(value & !SELF_CLEARING_USER),
        _ => Some(value),
    }
}

/// 8 kHz (32 kHz with the filter bypassed) unless `DLPF_CFG` is 1 to 6, else 1 kHz over `1 + SMPLRT_DIV`.
pub fn sample_rate_hz(registers: &[u8; COUNT]) -> f64 {
    let bypass = registers[GYRO_CONFIG] & 0x03;
    let filter = registers[CONFIG] & 0x07;
    if bypass != 0 {
        32_000.0
    } else if (1..=6).contains(&filter) {
        1000.0 / (1.0 + f64::from(registers[SMPLRT_DIV]))
    } else {
        8000.0
    }
}
