//! What the sensor makes of the motion.
//!
//! `raw_gyro = (I + S_g ΔT)·D_g·ω + b_g(t) + G·f + n_g` and `raw_accel = (I + S_a ΔT)·D_a·f + b_a(t) + n_a`, in SI and the box
//! frame; `b(t) = b + ramp·t + slope·ΔT + random part`.

mod config;
mod drawn;
mod drift;
mod instant;
mod noise;
mod quantise;
mod triad;
mod truth;

pub use config::{Delay, Noise, SensorConfig, SensorTruth, Sheet};
pub use drawn::{EffectTruth, Parameter};
pub use drift::{BiasDrift, Drift, Thermal, Wander};
pub use instant::{Ideal, Instant, Signal};
pub(crate) use instant::{Stages, Untouched};
pub use noise::ShapedNoise;
pub use quantise::Quantisation;
pub use triad::{PaperAngles, Triad};
pub use truth::{AccelTruth, FrameTruth, GyroTruth, SettingTruth, Truth};

use crate::error::SimError;
use crate::rng::{Purpose, Rng};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// One sample as the sensor gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The stamp, s.
    pub t_s: f64,
    /// rad/s.
    pub angular_rate_rad_s: Vector3<f64>,
    /// m/s²; points up at rest.
    pub specific_force_mps2: Vector3<f64>,
    /// °C.
    pub temperature_degc: f64,
}

/// The random parts of both biases at one time.
type Wandered = (f64, Vector3<f64>, Vector3<f64>);

/// The simulated sensor.
#[derive(Debug, Clone)]
pub struct Sensor {
    config: SensorConfig,
    rng: Rng,
    gyro_noise: ShapedNoise,
    accel_noise: ShapedNoise,
    gyro_wander: Wander,
    accel_wander: Wander,
    span_s: Option<(f64, f64)>,
    history: Vec<Wandered>,
}

impl Sensor {
    /// A sensor that has not been asked yet.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(config: SensorConfig, seed: u64) -> Result<Self, SimError> {
        config.check()?;
        let mut rng = Rng::new(seed, Purpose::Noise);
        let (noise, rate_hz) = (config.noise, config.rate_hz);
        Ok(Self {
            gyro_noise: ShapedNoise::new(noise.gyro_density(), rate_hz, noise.bandwidth_hz, &mut rng),
            accel_noise: ShapedNoise::new(noise.accel_density(), rate_hz, noise.bandwidth_hz, &mut rng),
            gyro_wander: Wander::new(config.drift.gyro, &mut rng),
            accel_wander: Wander::new(config.drift.accel, &mut rng),
            config,
            rng,
            span_s: None,
            history: Vec::new(),
        })
    }

    /// What it was made from.
    pub fn config(&self) -> &SensorConfig {
        &self.config
    }

    /// From the first to the last sample so far, s.
    pub fn span_s(&self) -> Option<(f64, f64)> {
        self.span_s
    }

    /// The sensor's answer to a true angular rate and specific force, both in the box frame at the sensor.
    ///
    /// Ask at increasing `t_s`: each call is one sample of noise, and the biases wander by the time between calls.
    pub fn measure(&mut self, t_s: f64, rate: &Vector3<f64>, force: &Vector3<f64>) -> Sample {
        let at = Instant {
            t_s,
            ideal: Ideal { angular_rate_rad_s: *rate, specific_force_mps2: *force },
            angular_acceleration_rad_s2: Vector3::zeros(),
            temperature_degc: self.config.thermal.at(t_s),
            rotation_n_from_b: UnitQuaternion::identity(),
        };
        self.measure_through(&at, &mut Untouched)
    }

    /// The same with what takes hold between the linear model and the noise, and between the noise and the rounding.
    pub(crate) fn measure_through(&mut self, at: &Instant, stages: &mut impl Stages) -> Sample {
        let t_s = at.t_s;
        let (rate, force) = (&at.ideal.angular_rate_rad_s, &at.ideal.specific_force_mps2);
        let (first_s, last_s) = self.span_s.unwrap_or((t_s, t_s));
        let dt_s = (t_s - last_s).max(0.0);
        self.span_s = Some((first_s, last_s.max(t_s)));
        let (gyro_random, accel_random) = self.wander(t_s, dt_s);
        let (gyro, accel) = self.triads_at(t_s);
        let mut signal = Signal {
            angular_rate_rad_s: gyro.distort(rate) + self.config.truth.gyro_g_sensitivity * force + gyro_random,
            specific_force_mps2: accel.distort(force) + accel_random,
        };
        stages.analog(at, &mut signal);
        signal.angular_rate_rad_s += self.gyro_noise.step(&mut self.rng);
        signal.specific_force_mps2 += self.accel_noise.step(&mut self.rng);
        let temperature_degc = self.config.thermal.at(t_s) + self.config.noise.temperature_degc * self.rng.normal();
        stages.converter(at, &mut signal);
        let Signal { angular_rate_rad_s: rate, specific_force_mps2: force } = signal;
        let range = self.config.quantisation;
        Sample {
            t_s,
            angular_rate_rad_s: range.map_or(rate, |range| range.gyro(&rate)),
            specific_force_mps2: range.map_or(force, |range| range.accel(&force)),
            temperature_degc,
        }
    }

    /// Lets the biases wander and remembers where they were, once a second.
    fn wander(&mut self, t_s: f64, dt_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let gyro = self.gyro_wander.step(dt_s, &mut self.rng);
        let accel = self.accel_wander.step(dt_s, &mut self.rng);
        let active = self.gyro_wander.is_active() || self.accel_wander.is_active();
        if active && self.history.last().is_none_or(|(last_s, ..)| t_s - last_s >= 1.0) {
            self.history.push((t_s, gyro, accel));
        }
        (gyro, accel)
    }

    /// Both triads at `t_s`, without the random part of their biases.
    fn triads_at(&self, t_s: f64) -> (Triad, Triad) {
        let SensorConfig { truth, drift, thermal, .. } = &self.config;
        let warmer = thermal.at(t_s) - thermal.reference_degc;
        let at = |triad: &Triad, ramp: &BiasDrift, slope: &Vector3<f64>, scale: &Vector3<f64>| Triad {
            distortion: (Matrix3::identity() + Matrix3::from_diagonal(&(scale * warmer))) * triad.distortion,
            bias: triad.bias + ramp.ramp_per_s * t_s + slope * warmer,
        };
        (
            at(&truth.gyro, &drift.gyro, &thermal.gyro_bias_per_degc, &thermal.gyro_scale_per_degc),
            at(&truth.accel, &drift.accel, &thermal.accel_bias_per_degc, &thermal.accel_scale_per_degc),
        )
    }

    /// The parameters averaged over a time: what a calibration made then should find.
    pub fn truth_between(&self, from_s: f64, to_s: f64) -> SensorTruth {
        const STEPS: usize = 200;
        let mut mean = self.config.truth;
        let instants = (0..STEPS).map(|i| from_s + (to_s - from_s) * (i as f64 + 0.5) / STEPS as f64);
        let (gyros, accels): (Vec<Triad>, Vec<Triad>) = instants.map(|t_s| self.triads_at(t_s)).unzip();
        let (gyro_random, accel_random) = self.random_between(from_s, to_s);
        mean.gyro = average(&gyros);
        mean.gyro.bias += gyro_random;
        mean.accel = average(&accels);
        mean.accel.bias += accel_random;
        mean
    }

    /// Mean random part of both biases over a time; the nearest remembered one if none lies within.
    fn random_between(&self, from_s: f64, to_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let within: Vec<&Wandered> = self.history.iter().filter(|(t, ..)| (from_s..=to_s).contains(t)).collect();
        if within.is_empty() {
            let distance = |t: f64| (t - 0.5 * (from_s + to_s)).abs();
            let nearest = self.history.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
            return nearest.map_or((Vector3::zeros(), Vector3::zeros()), |(_, gyro, accel)| (*gyro, *accel));
        }
        let share = 1.0 / within.len() as f64;
        let gyro = within.iter().map(|(_, gyro, _)| gyro).sum::<Vector3<f64>>();
        let accel = within.iter().map(|(_, _, accel)| accel).sum::<Vector3<f64>>();
        (gyro * share, accel * share)
    }
}

/// The mean of several triads.
fn average(triads: &[Triad]) -> Triad {
    let share = 1.0 / triads.len() as f64;
    Triad {
        distortion: triads.iter().map(|t| t.distortion).sum::<Matrix3<f64>>() * share,
        bias: triads.iter().map(|t| t.bias).sum::<Vector3<f64>>() * share,
    }
}
