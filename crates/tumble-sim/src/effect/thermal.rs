//! Parameters that follow the die's temperature, and a temperature that moves.

use super::bias::Triad;
use super::error::EffectError;
use super::kind::{Draw, Scene};
use super::model::Model;
use super::units::PPM;
use crate::rng::Rng;
use crate::sensor::{Instant, Parameter, Sample, Signal, Thermal};
use crate::world::WorldConfig;
use nalgebra::Vector3;

/// A recording whose temperature moves by less keeps its own; otherwise the effect brings one, °C.
const ENOUGH_DEGC: f64 = 2.0;
/// Below this the readings' noise is all there is, °C.
const LEAST_DEGC: f64 = 0.2;

/// The die becomes warmer: evenly (the room, the sun), or quickly at first (self-heating after switch-on).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Swing {
    ramp_degc_per_s: f64,
    warm_up_degc: f64,
    warm_up_tau_s: f64,
}

impl Swing {
    /// 3 to 8 °C over the recording, up or down, or 3 to 8 °C up with a time constant of 30 to 100 s.
    fn draw(draw: &mut Draw) -> Self {
        let (size_degc, tau_s) = (draw.rng.uniform(3.0, 8.0), draw.rng.uniform(30.0, 100.0));
        let direction = draw.sign();
        if draw.rng.chance(0.5) {
            let per_s = direction * size_degc / draw.scene.duration_s.max(1.0);
            Self { ramp_degc_per_s: per_s, warm_up_degc: 0.0, warm_up_tau_s: tau_s }
        } else {
            Self { ramp_degc_per_s: 0.0, warm_up_degc: size_degc, warm_up_tau_s: tau_s }
        }
    }

    /// The same for a recording of which nothing else is to be known.
    pub(crate) fn of_any_recording(scene: Scene, rng: &mut Rng) -> Self {
        Self::draw(&mut Draw { magnitude: 0.0, rng, scene })
    }

    /// Unless the temperature moves enough already.
    pub(crate) fn apply(&mut self, thermal: &mut Thermal, duration_s: f64) {
        let moved = (thermal.at(duration_s) - thermal.at(0.0)).abs();
        if moved < ENOUGH_DEGC {
            thermal.ramp_degc_per_s = self.ramp_degc_per_s;
            thermal.warm_up_degc = self.warm_up_degc;
            thermal.warm_up_tau_s = self.warm_up_tau_s;
        } else {
            self.ramp_degc_per_s = thermal.ramp_degc_per_s;
            self.warm_up_degc = thermal.warm_up_degc;
            self.warm_up_tau_s = thermal.warm_up_tau_s;
        }
    }

    fn parameters(&self) -> [Parameter; 3] {
        [
            Parameter::new("temperature_ramp", self.ramp_degc_per_s, "degC/s"),
            Parameter::new("temperature_warm_up", self.warm_up_degc, "degC"),
            Parameter::new("temperature_warm_up_tau", self.warm_up_tau_s, "s"),
        ]
    }
}

/// What follows the temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Follows {
    /// °/s/°C or mg/°C.
    Bias,
    /// ppm/°C.
    Scale,
}

/// `b(T) = b + β·(T − T₀)` or `D(T) = (I + diag(σ)·(T − T₀))·D`.
#[derive(Debug, Clone)]
pub(super) struct Slope {
    triad: Triad,
    follows: Follows,
    slope: Vector3<f64>,
    swing: Swing,
    duration_s: f64,
    /// Mean of a real recording's temperatures, about which it is changed; a simulated sensor has its own.
    real_mean_degc: Option<f64>,
}

impl Slope {
    pub(super) fn draw(triad: Triad, follows: Follows, draw: &mut Draw) -> Box<dyn Model> {
        let (slope, swing) = (draw.spread(), Swing::draw(draw));
        Box::new(Self { triad, follows, slope, swing, duration_s: draw.scene.duration_s, real_mean_degc: None })
    }

    /// SI per °C, or relative.
    fn slope_si(&self) -> Vector3<f64> {
        let unit = if self.follows == Follows::Scale { PPM } else { self.triad.unit_si() };
        self.slope * unit
    }
}

impl Model for Slope {
    fn prepare(&mut self, config: &mut WorldConfig) {
        let thermal = &mut config.sensor.thermal;
        self.swing.apply(thermal, self.duration_s);
        let slope = match (self.triad, self.follows) {
            (Triad::Gyro, Follows::Bias) => &mut thermal.gyro_bias_per_degc,
            (Triad::Gyro, Follows::Scale) => &mut thermal.gyro_scale_per_degc,
            (Triad::Accel, Follows::Bias) => &mut thermal.accel_bias_per_degc,
            (Triad::Accel, Follows::Scale) => &mut thermal.accel_scale_per_degc,
        };
        *slope += self.slope_si();
    }

    fn adopt(&mut self, samples: &[Sample]) -> Result<(), EffectError> {
        let all = || samples.iter().map(|sample| sample.temperature_degc);
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        if all().any(|degc| !degc.is_finite()) {
            return Err(EffectError::Lacks { what: "no temperature, or not in every row (column temp_c)" });
        }
        if high - low < LEAST_DEGC {
            return Err(EffectError::Lacks { what: "a temperature that moves by less than 0.2 °C" });
        }
        self.real_mean_degc = Some(all().sum::<f64>() / samples.len() as f64);
        Ok(())
    }

    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let Some(mean_degc) = self.real_mean_degc else { return };
        let warmer = self.slope_si() * (at.temperature_degc - mean_degc);
        let ideal = match self.triad {
            Triad::Gyro => at.ideal.angular_rate_rad_s,
            Triad::Accel => at.ideal.specific_force_mps2,
        };
        let change = if self.follows == Follows::Scale { warmer.component_mul(&ideal) } else { warmer };
        self.triad.add(signal, change);
    }

    fn parameters(&self) -> Vec<Parameter> {
        let unit = match (self.follows, self.triad) {
            (Follows::Scale, _) => "ppm/degC",
            (Follows::Bias, Triad::Gyro) => "dps/degC",
            (Follows::Bias, Triad::Accel) => "mg/degC",
        };
        let mut all = Parameter::xyz("slope", &self.slope, unit);
        if self.real_mean_degc.is_none() {
            all.extend(self.swing.parameters());
        }
        all
    }
}
