//! Biases that move of themselves: what gyro and accelerometer have in common.

use super::kind::Draw;
use super::model::Model;
use super::units::{DPS, MG};
use crate::rng::{Purpose, Rng};
use crate::sensor::{Instant, Parameter, Signal};
use nalgebra::Vector3;

/// Which of the two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Triad {
    Gyro,
    Accel,
}

impl Triad {
    /// Adds to its channels, SI.
    pub(super) fn add(self, signal: &mut Signal, what: Vector3<f64>) {
        match self {
            Self::Gyro => signal.angular_rate_rad_s += what,
            Self::Accel => signal.specific_force_mps2 += what,
        }
    }

    /// SI in the unit that people use: °/s or mg.
    pub(super) fn unit_si(self) -> f64 {
        match self {
            Self::Gyro => DPS,
            Self::Accel => MG,
        }
    }

    /// That unit's name.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Gyro => "dps",
            Self::Accel => "mg",
        }
    }
}

/// `b(t) = b + s·[t ≥ t₀]`.
#[derive(Debug, Clone)]
pub(super) struct Step {
    triad: Triad,
    time_s: f64,
    /// °/s or mg.
    step: Vector3<f64>,
}

impl Step {
    pub(super) fn draw(triad: Triad, draw: &mut Draw) -> Box<dyn Model> {
        Box::new(Self { triad, time_s: draw.time_s(), step: draw.vector() })
    }
}

impl Model for Step {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        if at.t_s >= self.time_s {
            self.triad.add(signal, self.step * self.triad.unit_si());
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut all = vec![Parameter::new("step_time", self.time_s, "s")];
        all.extend(Parameter::xyz("step", &self.step, self.triad.unit()));
        all
    }
}

/// `db = q·dW` on each axis, from 0.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    triad: Triad,
    /// °/s/√s or mg/√s.
    density: f64,
    last_s: Option<f64>,
    walked: Vector3<f64>,
    rng: Rng,
}

impl Walk {
    pub(super) fn draw(triad: Triad, draw: &mut Draw) -> Box<dyn Model> {
        let rng = Rng::new((draw.rng.unit() * 2f64.powi(53)) as u64, Purpose::Effect);
        Box::new(Self { triad, density: draw.magnitude, last_s: None, walked: Vector3::zeros(), rng })
    }
}

impl Model for Walk {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let dt_s = self.last_s.map_or(0.0, |last_s| (at.t_s - last_s).max(0.0));
        self.last_s = Some(at.t_s);
        self.walked += self.rng.normal3() * (self.density * dt_s.sqrt());
        self.triad.add(signal, self.walked * self.triad.unit_si());
    }

    fn parameters(&self) -> Vec<Parameter> {
        let unit = if self.triad == Triad::Gyro { "dps/√s" } else { "mg/√s" };
        let mut all = vec![Parameter::new("random_walk", self.density, unit)];
        all.extend(Parameter::xyz("walked_in_all", &self.walked, self.triad.unit()));
        all
    }
}
