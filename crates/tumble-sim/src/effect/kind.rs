//! What an effect is called, what its magnitude means, and what it is drawn from.

use super::model::Model;
use crate::rng::Rng;
use crate::sensor::Quantisation;
use core::fmt;
use nalgebra::Vector3;

/// What an effect's magnitude may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Values {
    /// Any number from the first to the second.
    Range(f64, f64),
    /// A whole number from the first to the second, which chooses a variant.
    Whole(u8, u8),
}

impl Values {
    /// Whether this number is one of them.
    pub fn contains(self, value: f64) -> bool {
        match self {
            Self::Range(low, high) => (low..=high).contains(&value),
            Self::Whole(low, high) => value.fract() == 0.0 && (f64::from(low)..=f64::from(high)).contains(&value),
        }
    }

    /// The ends.
    pub fn bounds(self) -> (f64, f64) {
        match self {
            Self::Range(low, high) => (low, high),
            Self::Whole(low, high) => (f64::from(low), f64::from(high)),
        }
    }
}

impl fmt::Display for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(low, high) => write!(f, "from {low} to {high}"),
            Self::Whole(low, high) => write!(f, "a whole number from {low} to {high}"),
        }
    }
}

/// An effect's entry in the registry.
#[derive(Debug)]
pub struct Kind {
    /// The contract's id.
    pub id: &'static str,
    /// In plain words.
    pub name: &'static str,
    /// What the magnitude is; everything else is drawn from the seed.
    pub meaning: &'static str,
    /// Of the magnitude.
    pub unit: &'static str,
    /// Typical, but clearly visible.
    pub default: f64,
    /// What is accepted.
    pub values: Values,
    /// What a blind trial draws from, evenly in the logarithm: about 3 to 10 times what is just visible in 200 s of six
    /// faces. Of the smaller effects, a linear calibration of `Scheme::Double` leaves a signal-to-noise ratio of 15 to
    /// 200 (5 is just visible); clipping, lag, wobble, torn bytes and wrong axes have far more. For an effect that grows
    /// as its number falls (a clipping level, a rate) the visible end is the lower.
    pub draws: (f64, f64),
    /// Where the typical size comes from.
    pub source: &'static str,
    /// Whether it can be added to a recording of a real sensor.
    pub injects: bool,
    pub(super) make: fn(&mut Draw) -> Box<dyn Model>,
}

impl Kind {
    /// What its magnitude must be, in words.
    pub(super) fn allowed(&self) -> String {
        format!("{} {}, {}", self.values, self.unit, self.meaning)
    }
}

/// When and how a recording is made: what an effect's times and counts are drawn from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// First stamp, s.
    pub start_s: f64,
    /// Length, s.
    pub duration_s: f64,
    /// Samples a second.
    pub rate_hz: f64,
    /// The recording's ranges; the widest of the MPU-9250 if it has none.
    pub ranges: Quantisation,
}

/// ±2000 °/s and ±16 g: what a recording has whose ranges are not stated.
pub const WIDEST: Quantisation = Quantisation { gyro_range_dps: 2000.0, accel_range_g: 16.0 };

/// From one magnitude to all that an effect needs.
pub(super) struct Draw<'a> {
    pub(super) magnitude: f64,
    pub(super) rng: &'a mut Rng,
    pub(super) scene: Scene,
}

impl Draw<'_> {
    /// +1 or −1.
    pub(super) fn sign(&mut self) -> f64 {
        if self.rng.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// 0, 1 or 2.
    pub(super) fn axis(&mut self) -> usize {
        self.rng.index(3)
    }

    /// The magnitude on one axis and 30 to 100 % of it on the others, each with its own sign.
    pub(super) fn spread(&mut self) -> Vector3<f64> {
        let peak = self.axis();
        let size = self.magnitude;
        Vector3::from_fn(|i, _| {
            let share = self.rng.uniform(0.3, 1.0);
            size * self.sign() * if i == peak { 1.0 } else { share }
        })
    }

    /// A vector of the magnitude's length, in any direction.
    pub(super) fn vector(&mut self) -> Vector3<f64> {
        self.rng.direction() * self.magnitude
    }

    /// A time well within the recording: 20 to 80 % of it.
    pub(super) fn time_s(&mut self) -> f64 {
        self.scene.start_s + self.scene.duration_s * self.rng.uniform(0.2, 0.8)
    }
}
