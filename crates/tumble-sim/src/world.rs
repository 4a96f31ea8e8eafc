//! Motion and sensor together: ask it for samples.

use crate::error::SimError;
use crate::motion::{Kinematics, Motion, MotionConfig};
use crate::sensor::{Ideal, Instant, Sample, Sensor, SensorConfig, Stages, Truth, Untouched};
use crate::{EARTH_RATE_RAD_S, STANDARD_GRAVITY_MPS2};
use nalgebra::{UnitQuaternion, Vector3};

/// Everything that a world is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldConfig {
    /// Table, box and hands.
    pub motion: MotionConfig,
    /// The sensor.
    pub sensor: SensorConfig,
    /// Local gravity, m/s².
    pub gravity_mps2: f64,
    /// Latitude, degrees north.
    pub latitude_deg: f64,
    /// Seed of all chance but the sensor's own parameters.
    pub seed: u64,
}

impl WorldConfig {
    /// The nominal motion and a nominal sensor: sheet noise only.
    pub fn nominal(seed: u64) -> Self {
        Self {
            motion: MotionConfig::nominal(),
            sensor: SensorConfig::nominal(seed),
            gravity_mps2: STANDARD_GRAVITY_MPS2,
            latitude_deg: 48.0,
            seed,
        }
    }

    /// The same with a sensor as it is on a board: delays and a die that warms up.
    pub fn mpu9250(seed: u64) -> Self {
        Self { sensor: SensorConfig::mpu9250(seed), ..Self::nominal(seed) }
    }
}

/// A box with a sensor on a table, and hands that move it.
#[derive(Debug, Clone)]
pub struct World {
    /// The queue of moves: push to it.
    pub motion: Motion,
    sensor: Sensor,
    gravity_mps2: f64,
    latitude_deg: f64,
    seed: u64,
    /// 1 but for the effect that says otherwise.
    pub(crate) earth_rate_share: f64,
}

impl World {
    /// The box stands on the table with `+z` up.
    ///
    /// # Errors
    /// If a setting is out of its range; it is named.
    pub fn new(config: &WorldConfig) -> Result<Self, SimError> {
        SimError::check("gravity_mps2", config.gravity_mps2, |v| v > 0.0, "above 0")?;
        SimError::check("latitude_deg", config.latitude_deg, |v| v.abs() <= 90.0, "-90 to 90 degrees")?;
        Ok(Self {
            motion: Motion::new(config.motion.clone(), config.seed)?,
            sensor: Sensor::new(config.sensor.clone(), config.seed)?,
            gravity_mps2: config.gravity_mps2,
            latitude_deg: config.latitude_deg,
            seed: config.seed,
            earth_rate_share: 1.0,
        })
    }

    /// The sensor's sample at `t_s`, with all its errors. Ask at increasing times; each call is one sample of noise.
    pub fn sample(&mut self, t_s: f64) -> Sample {
        self.sample_through(t_s, &mut Untouched)
    }

    /// The same with what takes hold on the way.
    pub(crate) fn sample_through(&mut self, t_s: f64, stages: &mut impl Stages) -> Sample {
        let delay = self.sensor.config().delay;
        let at_gyro = self.instant(t_s - delay.gyro_s);
        let at_accel = if delay.accel_s == delay.gyro_s { at_gyro } else { self.instant(t_s - delay.accel_s) };
        let ideal = Ideal {
            angular_rate_rad_s: stages.ideal(&at_gyro).angular_rate_rad_s,
            specific_force_mps2: stages.ideal(&at_accel).specific_force_mps2,
        };
        let temperature_degc = self.sensor.config().thermal.at(t_s);
        let at = Instant { t_s, ideal, temperature_degc, ..at_gyro };
        self.sensor.measure_through(&at, stages)
    }

    fn instant(&self, t_s: f64) -> Instant {
        let kinematics = self.motion.at(t_s);
        Instant {
            t_s,
            ideal: self.ideal_of(&kinematics),
            angular_acceleration_rad_s2: kinematics.spin.accel,
            temperature_degc: self.sensor.config().thermal.at(t_s),
            rotation_n_from_b: kinematics.spin.rotation,
        }
    }

    /// What a perfect sensor would say: `ω = ω_nb + R_b_from_n·ω_ie` and `f = R_b_from_n·(a + 2 ω_ie × v + g·up)`.
    pub fn ideal(&self, t_s: f64) -> Ideal {
        self.ideal_of(&self.motion.at(t_s))
    }

    fn ideal_of(&self, kinematics: &Kinematics) -> Ideal {
        let rotation = kinematics.spin.rotation;
        let earth = self.earth_rate_n();
        let point = kinematics.point(&self.motion.config().shape.lever_b_m);
        let force_n = point.acceleration + 2.0 * earth.cross(&point.velocity) + Vector3::z() * self.gravity_mps2;
        Ideal {
            angular_rate_rad_s: kinematics.spin.rate + rotation.inverse_transform_vector(&earth),
            specific_force_mps2: rotation.inverse_transform_vector(&force_n),
        }
    }

    /// The Earth's rate in `n` (east, north, up), rad/s.
    pub fn earth_rate_n(&self) -> Vector3<f64> {
        let latitude = self.latitude_deg.to_radians();
        Vector3::new(0.0, latitude.cos(), latitude.sin()) * (EARTH_RATE_RAD_S * self.earth_rate_share)
    }

    /// `R_n_from_b` at any time.
    pub fn true_attitude(&self, t_s: f64) -> UnitQuaternion<f64> {
        self.motion.at(t_s).spin.rotation
    }

    /// Whether neither hand nor knock moves the box at `t_s`.
    pub fn motion_idle_at(&self, t_s: f64) -> bool {
        self.motion.idle_at(t_s)
    }

    /// The sensor.
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// The truth averaged over all samples so far (at time 0 before the first): what a calibration should find.
    ///
    /// # Errors
    /// If a triad's axes do not span space, which a checked configuration excludes at its reference temperature.
    pub fn truth(&self) -> Result<Truth, SimError> {
        let (from_s, to_s) = self.sensor.span_s().unwrap_or((0.0, 0.0));
        self.truth_between(from_s, to_s)
    }

    /// The truth averaged over a time.
    ///
    /// # Errors
    /// As [`World::truth`].
    pub fn truth_between(&self, from_s: f64, to_s: f64) -> Result<Truth, SimError> {
        let sensor = self.sensor.truth_between(from_s, to_s);
        Truth::new(&sensor, self.motion.config(), self.gravity_mps2, self.latitude_deg, self.seed)
    }
}
