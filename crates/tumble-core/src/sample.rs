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
    /// True if any inertial channel stands at an end of its range, where the value is a bound and not a measurement.
    pub fn is_clipped(&self) -> bool {
        self.gyro.iter().chain(&self.accel).any(|&c| c == i16::MAX || c == i16::MIN)
    }
}
