//! Biases that wander and parameters that follow the die's temperature.

use crate::STANDARD_GRAVITY_MPS2;
use crate::error::SimError;
use crate::rng::{Purpose, Rng};
use nalgebra::Vector3;

/// How the biases of both triads move; SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Drift {
    /// Gyro, rad/s.
    pub gyro: BiasDrift,
    /// Accelerometer, m/s².
    pub accel: BiasDrift,
}

/// How one triad's bias moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BiasDrift {
    /// Straight ramp, unit/s.
    pub ramp_per_s: Vector3<f64>,
    /// Random walk, unit/√s, each axis.
    pub random_walk_per_rts: f64,
    /// Bias instability `B` of 1/f noise, unit, each axis; the Allan deviation's floor is 0.664 B.
    pub instability: f64,
}

/// Correlation times of the first-order processes that together make 1/f noise, one a decade, s.
const FLICKER_TAU_S: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// The random part of one triad's bias.
///
/// 1/f noise of density `B²/(πf)` (one-sided; IEEE Std 952) has `B²·ln 10/π` of power in a decade: each process
/// has `σ = 0.856 B`.
#[derive(Debug, Clone)]
pub struct Wander {
    drift: BiasDrift,
    walk: Vector3<f64>,
    flicker: [Vector3<f64>; 4],
}

impl Wander {
    /// In its stationary state; the walk begins at 0.
    pub fn new(drift: BiasDrift, rng: &mut Rng) -> Self {
        let sigma = Self::process_sigma(&drift);
        let mut draw = || if sigma > 0.0 { rng.normal3() * sigma } else { Vector3::zeros() };
        Self { drift, walk: Vector3::zeros(), flicker: core::array::from_fn(|_| draw()) }
    }

    fn process_sigma(drift: &BiasDrift) -> f64 {
        drift.instability * (core::f64::consts::LN_10 / core::f64::consts::PI).sqrt()
    }

    /// Whether anything random moves.
    pub fn is_active(&self) -> bool {
        self.drift.random_walk_per_rts > 0.0 || self.drift.instability > 0.0
    }

    /// Moves on by `dt_s` and returns the random part of the bias.
    pub fn step(&mut self, dt_s: f64, rng: &mut Rng) -> Vector3<f64> {
        if self.drift.random_walk_per_rts > 0.0 {
            self.walk += rng.normal3() * (self.drift.random_walk_per_rts * dt_s.sqrt());
        }
        let sigma = Self::process_sigma(&self.drift);
        if sigma > 0.0 {
            for (state, tau_s) in self.flicker.iter_mut().zip(FLICKER_TAU_S) {
                let keep = (-dt_s / tau_s).exp();
                *state = *state * keep + rng.normal3() * (sigma * (1.0 - keep * keep).sqrt());
            }
        }
        self.walk + self.flicker.iter().sum::<Vector3<f64>>()
    }
}

/// The die's temperature and what depends on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thermal {
    /// At time 0, °C.
    pub start_degc: f64,
    /// Rise by self-heating, °C, with a time constant.
    pub warm_up_degc: f64,
    /// s.
    pub warm_up_tau_s: f64,
    /// Of the room, °C/s.
    pub ramp_degc_per_s: f64,
    /// Where the true parameters hold, °C.
    pub reference_degc: f64,
    /// Gyro bias, (rad/s)/°C.
    pub gyro_bias_per_degc: Vector3<f64>,
    /// Gyro scale, relative, 1/°C.
    pub gyro_scale_per_degc: Vector3<f64>,
    /// Accelerometer bias, (m/s²)/°C.
    pub accel_bias_per_degc: Vector3<f64>,
    /// Accelerometer scale, relative, 1/°C.
    pub accel_scale_per_degc: Vector3<f64>,
}

impl Thermal {
    /// A constant temperature, on which nothing depends.
    pub fn constant(degc: f64) -> Self {
        Self {
            start_degc: degc,
            warm_up_degc: 0.0,
            warm_up_tau_s: 60.0,
            ramp_degc_per_s: 0.0,
            reference_degc: degc,
            gyro_bias_per_degc: Vector3::zeros(),
            gyro_scale_per_degc: Vector3::zeros(),
            accel_bias_per_degc: Vector3::zeros(),
            accel_scale_per_degc: Vector3::zeros(),
        }
    }

    /// Half a degree of self-heating in the first minutes (the paper saw 0.5–1 °C in a session), with coefficients drawn
    /// within a tenth of the sheet's limits.
    ///
    /// The sheet's limits over −40 to 85 °C are ±30 °/s (0.24 °/s/°C) and ±4 % (0.032 %/°C) for the gyro, ±1.5 mg/°C and
    /// ±0.026 %/°C for the accelerometer; a tenth is what parts usually show near room temperature.
    pub fn warming_up(seed: u64) -> Self {
        // Seeds a stream apart from the truth's own draws.
        let mut rng = Rng::new(seed ^ 0x7E3A, Purpose::Truth);
        let mut within = |limit: f64| Vector3::from_fn(|_, _| rng.symmetric(0.1 * limit));
        Self {
            warm_up_degc: 0.5,
            gyro_bias_per_degc: within(0.24f64.to_radians()),
            gyro_scale_per_degc: within(3.2e-4),
            accel_bias_per_degc: within(1.5e-3 * STANDARD_GRAVITY_MPS2),
            accel_scale_per_degc: within(2.6e-4),
            ..Self::constant(25.0)
        }
    }

    /// The die's temperature, °C.
    pub fn at(&self, t_s: f64) -> f64 {
        let warm_up = self.warm_up_degc * (1.0 - (-t_s.max(0.0) / self.warm_up_tau_s).exp());
        self.start_degc + warm_up + self.ramp_degc_per_s * t_s
    }

    /// Refuses what cannot be simulated.
    ///
    /// # Errors
    /// Names the first setting out of its range.
    pub fn check(&self) -> Result<(), SimError> {
        SimError::check("start_degc", self.start_degc, |v| (-60.0..150.0).contains(&v), "-60 to 150 degrees")?;
        SimError::check("warm_up_tau_s", self.warm_up_tau_s, |v| v > 0.0, "above 0")?;
        SimError::check("ramp_degc_per_s", self.ramp_degc_per_s, |v| v.abs() < 10.0, "below 10 degrees a second")
    }
}
