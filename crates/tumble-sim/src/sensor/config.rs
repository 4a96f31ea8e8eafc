//! Everything that a simulated sensor is made of, and the presets.

use super::drift::{Drift, Thermal};
use super::quantise::Quantisation;
use super::triad::{PaperAngles, Triad};
use crate::STANDARD_GRAVITY_MPS2;
use crate::error::SimError;
use crate::rng::{Purpose, Rng};
use nalgebra::{Matrix3, Vector3};

/// The limits that a data sheet gives; truths are drawn uniformly within them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Zero-rate offset, degrees per second.
    pub gyro_bias_dps: f64,
    /// Zero-g offsets of x, y and z, mg.
    pub accel_bias_mg: [f64; 3],
    /// Relative sensitivity error of both triads.
    pub sensitivity: f64,
    /// Cross-axis sensitivity of both triads, each of the six terms.
    pub cross_axis: f64,
    /// Every term of the gyro's g-sensitivity, degrees per second per g.
    pub g_sensitivity_dps_per_g: f64,
}

impl Sheet {
    /// MPU-9250 product specification, rev. 1.1, tables 1 and 2. It leaves g-sensitivity unspecified: 0 here (its sibling
    /// has 0.1 °/s/g).
    pub const MPU9250: Self = Self {
        gyro_bias_dps: 5.0,
        accel_bias_mg: [60.0, 60.0, 80.0],
        sensitivity: 0.03,
        cross_axis: 0.02,
        g_sensitivity_dps_per_g: 0.0,
    };
}

/// The constant true parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorTruth {
    /// rad/s.
    pub gyro: Triad,
    /// m/s².
    pub accel: Triad,
    /// `raw_gyro` gains `G · f_b`, (rad/s)/(m/s²).
    pub gyro_g_sensitivity: Matrix3<f64>,
}

impl SensorTruth {
    /// A sensor without errors.
    pub fn ideal() -> Self {
        Self { gyro: Triad::ideal(), accel: Triad::ideal(), gyro_g_sensitivity: Matrix3::zeros() }
    }

    /// A sensor drawn from a sheet's limits.
    pub fn draw(sheet: &Sheet, seed: u64) -> Self {
        let mut rng = Rng::new(seed, Purpose::Truth);
        let gyro_bias = Vector3::repeat(sheet.gyro_bias_dps.to_radians());
        let accel_bias = Vector3::from(sheet.accel_bias_mg) * (1e-3 * STANDARD_GRAVITY_MPS2);
        let g_limit = sheet.g_sensitivity_dps_per_g.to_radians() / STANDARD_GRAVITY_MPS2;
        Self {
            gyro: Triad::draw(gyro_bias, sheet.sensitivity, sheet.cross_axis, &mut rng),
            accel: Triad::draw(accel_bias, sheet.sensitivity, sheet.cross_axis, &mut rng),
            gyro_g_sensitivity: Matrix3::from_fn(|_, _| rng.symmetric(g_limit)),
        }
    }

    /// The paper's Table 1: gyro bias 0.5 °/s, scales 0.99391, 1.00741, 1.00589, angles −0.45° and 0.65° on every axis (in
    /// the table's order: `θxy θxz`, `θyx θyz`, `θzx θzy`). It says nothing of the accelerometer, which is `accel`.
    pub fn paper_table_1(accel: Triad) -> Self {
        let angles = PaperAngles { xy: -0.45, xz: 0.65, yx: -0.45, yz: 0.65, zx: -0.45, zy: 0.65 };
        let scale = Vector3::new(0.993_91, 1.007_41, 1.005_89);
        let gyro = Triad::paper(scale, &angles, Vector3::repeat(0.5));
        Self { gyro, accel, gyro_g_sensitivity: Matrix3::zeros() }
    }
}

/// White noise by its one-sided spectral density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// °/s/√Hz.
    pub gyro_dps_rthz: f64,
    /// µg/√Hz.
    pub accel_ug_rthz: f64,
    /// Cut-off of the second-order low-pass that shapes it, Hz; `None` leaves it white up to half the sample rate.
    pub bandwidth_hz: Option<f64>,
    /// Rms of the temperature reading, °C.
    pub temperature_degc: f64,
}

impl Noise {
    /// The sheet: 0.01 °/s/√Hz, 300 µg/√Hz, 41 Hz.
    pub const MPU9250: Self =
        Self { gyro_dps_rthz: 0.01, accel_ug_rthz: 300.0, bandwidth_hz: Some(41.0), temperature_degc: 0.02 };
    /// None at all.
    pub const NONE: Self = Self { gyro_dps_rthz: 0.0, accel_ug_rthz: 0.0, bandwidth_hz: None, temperature_degc: 0.0 };

    /// Density of the gyro's noise, rad/s/√Hz.
    pub fn gyro_density(&self) -> f64 {
        self.gyro_dps_rthz.to_radians()
    }

    /// Density of the accelerometer's noise, m/s²/√Hz.
    pub fn accel_density(&self) -> f64 {
        self.accel_ug_rthz * 1e-6 * STANDARD_GRAVITY_MPS2
    }
}

/// How long after the motion the sensor reports it. The low-pass is modelled on the motion as its delay: hands move below
/// 12 Hz, where a 41 Hz second-order low-pass takes 0.4 % off the amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Delay {
    /// s.
    pub gyro_s: f64,
    /// s.
    pub accel_s: f64,
}

impl Delay {
    /// The register map at `CONFIG = 3` and `ACCEL_CONFIG2 = 3`: 5.9 and 4.88 ms (another page has 11.8 for the latter).
    pub const MPU9250: Self = Self { gyro_s: 5.9e-3, accel_s: 4.88e-3 };
}

/// A whole sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorConfig {
    /// The parameters that a calibration is to find.
    pub truth: SensorTruth,
    /// White noise.
    pub noise: Noise,
    /// Biases that wander.
    pub drift: Drift,
    /// The die's temperature and what depends on it.
    pub thermal: Thermal,
    /// The low-pass's delays.
    pub delay: Delay,
    /// Range and resolution, for recordings; the board's chip model has its own.
    pub quantisation: Option<Quantisation>,
    /// The rate at which it will be asked, Hz: scales the noise per sample.
    pub rate_hz: f64,
}

impl SensorConfig {
    /// A sensor within the sheet's limits, with the sheet's noise and nothing else: no drift, no delay, no quantisation.
    pub fn nominal(seed: u64) -> Self {
        Self {
            truth: SensorTruth::draw(&Sheet::MPU9250, seed),
            noise: Noise::MPU9250,
            drift: Drift::default(),
            thermal: Thermal::constant(25.0),
            delay: Delay::default(),
            quantisation: None,
            rate_hz: 200.0,
        }
    }

    /// The nominal sensor as it is on a board: the sheet's delays, and a die that warms up by half a degree.
    pub fn mpu9250(seed: u64) -> Self {
        Self { delay: Delay::MPU9250, thermal: Thermal::warming_up(seed), ..Self::nominal(seed) }
    }

    /// Refuses what cannot be simulated.
    ///
    /// # Errors
    /// Names the first setting out of its range.
    pub fn check(&self) -> Result<(), SimError> {
        SimError::check("rate_hz", self.rate_hz, |v| v > 0.0 && v <= 1e5, "above 0 and at most 100 kHz")?;
        SimError::check("gyro_dps_rthz", self.noise.gyro_dps_rthz, |v| v >= 0.0, "0 or more")?;
        SimError::check("accel_ug_rthz", self.noise.accel_ug_rthz, |v| v >= 0.0, "0 or more")?;
        SimError::check("bandwidth_hz", self.noise.bandwidth_hz.unwrap_or(1.0), |v| v > 0.0, "above 0")?;
        SimError::check("delay.gyro_s", self.delay.gyro_s, |v| (0.0..1.0).contains(&v), "0 to 1 s")?;
        SimError::check("delay.accel_s", self.delay.accel_s, |v| (0.0..1.0).contains(&v), "0 to 1 s")?;
        if let Some(range) = self.quantisation {
            SimError::check("gyro_range_dps", range.gyro_range_dps, |v| v > 0.0, "above 0")?;
            SimError::check("accel_range_g", range.accel_range_g, |v| v > 0.0, "above 0")?;
        }
        self.thermal.check()?;
        self.truth.gyro.correction()?;
        self.truth.accel.own_frame().map(|_| ())
    }
}
