//! One instant between motion and file: what is so, what the sensor makes of it, and where something may take hold on the way.

use nalgebra::{UnitQuaternion, Vector3};

/// True angular rate and specific force in the box frame at the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ideal {
    /// Relative to inertial space, rad/s.
    pub angular_rate_rad_s: Vector3<f64>,
    /// m/s².
    pub specific_force_mps2: Vector3<f64>,
}

/// What is so at the instant of a sample.
#[derive(Debug, Clone, Copy)]
pub struct Instant {
    /// s.
    pub t_s: f64,
    /// What a perfect sensor would say.
    pub ideal: Ideal,
    /// In the box frame, rad/s².
    pub angular_acceleration_rad_s2: Vector3<f64>,
    /// Of the die, °C.
    pub temperature_degc: f64,
    /// Attitude.
    pub rotation_n_from_b: UnitQuaternion<f64>,
}

/// What the sensor makes of it so far, with its linear errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signal {
    /// rad/s.
    pub angular_rate_rad_s: Vector3<f64>,
    /// m/s².
    pub specific_force_mps2: Vector3<f64>,
}

/// What takes hold between the motion and the rounding. Nothing does unless it says so.
pub(crate) trait Stages {
    /// What is there to be measured.
    fn ideal(&self, at: &Instant) -> Ideal {
        at.ideal
    }
    /// Behind the linear model, before noise.
    fn analog(&mut self, _at: &Instant, _signal: &mut Signal) {}
    /// After noise, before rounding.
    fn converter(&mut self, _at: &Instant, _signal: &mut Signal) {}
}

/// Nothing takes hold.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Untouched;

impl Stages for Untouched {}
