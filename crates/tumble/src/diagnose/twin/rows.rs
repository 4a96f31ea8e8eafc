//! Whitened residuals with their addresses.

use nalgebra::{DMatrix, DVector};

/// Which comparison a row comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Class {
    /// Rate at rest against the bias and the Earth.
    RestRate,
    /// Specific force at rest against gravity.
    RestForce,
    /// The first of it after a motion: what the motion left of level.
    Hinge,
    /// Specific force in a turn against gravity and the lever arm.
    TurnForce,
    /// What a whole turn leaves against its stop.
    Closure,
    /// The face on the table.
    Plate,
}

impl Class {
    /// All, in the order of reports.
    pub const ALL: [Self; 6] =
        [Self::RestRate, Self::RestForce, Self::Hinge, Self::TurnForce, Self::Closure, Self::Plate];

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RestRate => "rate at rest",
            Self::RestForce => "gravity at rest",
            Self::Hinge => "level after a motion",
            Self::TurnForce => "gravity in a turn",
            Self::Closure => "whole turns",
            Self::Plate => "box on the table",
        }
    }
}

/// Where a row comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Address {
    /// Comparison.
    pub class: Class,
    /// Gyroscope x–z 0–2, accelerometer x–z 3–5; what concerns attitude counts as the gyroscope's.
    pub channel: usize,
    /// Stretch number.
    pub stretch: usize,
    /// Middle, s.
    pub t_s: f64,
    /// In the second half of its position: for what is held out.
    pub late: bool,
}

/// Names of the six channels, as the contract has them.
pub const CHANNELS: [&str; 6] = ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"];

/// All rows of a pass: under the nominal model `values` are independent standard normals, and a candidate of size θ shifts
/// them by `responses · θ`.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Addresses.
    pub at: Vec<Address>,
    /// Innovations over their sigmas.
    pub values: DVector<f64>,
    /// A column a candidate.
    pub responses: DMatrix<f64>,
    /// Sum of the logarithms of the innovations' sigmas: what a model pays for expecting much.
    pub log_sigma: f64,
}

impl Rows {
    /// Mean square over the rows that `keep` keeps; NaN if none.
    pub fn mean_square(&self, keep: impl Fn(&Address) -> bool) -> f64 {
        let (sum, count) = self
            .at
            .iter()
            .zip(self.values.iter())
            .filter(|(at, _)| keep(at))
            .fold((0.0, 0.0), |(sum, count), (_, value)| (sum + value * value, count + 1.0));
        sum / count
    }
}
