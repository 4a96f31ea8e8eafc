//! What every real recording has: the nuisances that a diagnosis must not report.

use super::{Clock, Scheme, SchemeConfig, Stamps};
use crate::effect::{Effect, Swing};
use crate::rng::{Purpose, Rng};
use crate::sensor::{BiasDrift, Quantisation, Thermal};
use crate::{EARTH_RATE_RAD_S, STANDARD_GRAVITY_MPS2};
use nalgebra::Vector3;

/// Bias instability of the gyro, in Earth rates: 10 °/h, as Allan plots of MPU-9250 boards show.
pub(super) const GYRO_INSTABILITY_EARTH_RATES: f64 = 10.0 / 15.041;
/// Bias instability of the accelerometer, g: 40 µg, from the same plots.
pub(super) const ACCEL_INSTABILITY_G: f64 = 40e-6;
/// Of the sheet's temperature coefficients: what is left of them over the half degree of a session is below 0.2 mdps.
const THERMAL_SHARE: f64 = 0.01;

impl SchemeConfig {
    /// A clean recording as it is really made. To the nominal world it adds, drawn from the seed: a table tilted by 0
    /// to 3° to any side, a spin axis that wobbles by 0.1 to 0.5°, 1/f noise of both biases (10 °/h and 40 µg), a die
    /// that warms up by 0.2 to 0.8 °C with a hundredth of the sheet's coefficients, an oscillator off by up to 0.5 %
    /// under true stamps, and counts of ±2000 °/s and ±16 g. Tremor, speeds, stops within 0.1° of the fence, knocks and
    /// scatter of put-downs are the nominal world's already.
    ///
    /// Clean means that no effect of the catalogue is there beyond this.
    pub fn realistic(scheme: Scheme, seed: u64) -> Self {
        let mut config = Self::new(scheme, seed);
        config.add_nuisances();
        config
    }

    /// A recording for a blind trial: [`SchemeConfig::realistic`] with a temperature that moves, so that nothing but
    /// its physics shows which effect is in it, or whether one is.
    pub fn blind(scheme: Scheme, seed: u64, effect: Option<Effect>) -> Self {
        let mut config = Self::realistic(scheme, seed);
        config.add_temperature_swing();
        config.effects.extend(effect);
        config
    }

    /// Adds to any configuration what [`SchemeConfig::realistic`] adds to the nominal one.
    pub fn add_nuisances(&mut self) {
        let mut rng = Rng::new(self.world.seed ^ 0x5EA1, Purpose::Box);
        let motion = &mut self.world.motion;
        motion.table.tilt_deg = rng.uniform(0.0, 3.0);
        motion.table.azimuth_deg = rng.uniform(0.0, 360.0);
        motion.hands.wobble_deg = rng.uniform(0.1, 0.5);
        let sensor = &mut self.world.sensor;
        let wander = |drift: BiasDrift, instability: f64| BiasDrift { instability, ..drift };
        sensor.drift.gyro = wander(sensor.drift.gyro, GYRO_INSTABILITY_EARTH_RATES * EARTH_RATE_RAD_S);
        sensor.drift.accel = wander(sensor.drift.accel, ACCEL_INSTABILITY_G * STANDARD_GRAVITY_MPS2);
        let mut within = |limit: f64| Vector3::from_fn(|_, _| rng.symmetric(THERMAL_SHARE * limit));
        // The sheet's limits, as in `Thermal::warming_up`.
        sensor.thermal = Thermal {
            gyro_bias_per_degc: within(0.24f64.to_radians()),
            gyro_scale_per_degc: within(3.2e-4),
            accel_bias_per_degc: within(1.5e-3 * STANDARD_GRAVITY_MPS2),
            accel_scale_per_degc: within(2.6e-4),
            ..Thermal::constant(25.0)
        };
        sensor.thermal.warm_up_degc = rng.uniform(0.2, 0.8);
        sensor.quantisation = Some(Quantisation { gyro_range_dps: 2000.0, accel_range_g: 16.0 });
        self.clock = Clock { rate_error: rng.symmetric(0.005), stamps: Stamps::True };
    }

    /// Lets the temperature move by 3 to 8 °C, as it does where an effect of temperature is to be seen, while nothing
    /// depends on it: among recordings that have one, a temperature that moves then tells nothing.
    pub fn add_temperature_swing(&mut self) {
        let mut rng = Rng::new(self.world.seed ^ 0x7E3B, Purpose::Box);
        let (mut swing, duration_s) = (Swing::of_any_recording(self.scene(), &mut rng), self.duration_s());
        let constant = Thermal::constant(self.world.sensor.thermal.start_degc);
        self.world.sensor.thermal = constant;
        swing.apply(&mut self.world.sensor.thermal, duration_s);
    }
}
