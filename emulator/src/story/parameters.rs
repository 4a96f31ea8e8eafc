//! The calibration as the board says it: its `@param` lines.

use nalgebra::{Matrix3, Vector3};
use tumble_core::calibration::Triad;
use tumble_core::sample::Sample;

use super::line::Line;

/// One `@param` line.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    pub name: String,
    pub value: Option<f32>,
    pub sigma: Option<f32>,
    pub unit: String,
    pub observable: bool,
}

impl Parameter {
    #[must_use]
    pub fn read(line: &Line) -> Option<Self> {
        line.says("@param").then_some(())?;
        let number = |key| line.value(key).and_then(|text| text.parse().ok());
        Some(Self {
            name: line.value("name")?.to_owned(),
            value: number("value"),
            sigma: number("sigma"),
            unit: line.value("unit").unwrap_or("").to_owned(),
            observable: line.value("observable") == Some("yes"),
        })
    }
}

/// What a board computes with: `f = A (f_raw − a)`, `ω = M (ω_raw − b − G f)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compensation {
    accel: Triad,
    gyro: Triad,
    felt: Matrix3<f32>,
}

impl Compensation {
    #[must_use]
    pub fn apply(&self, raw: &Sample) -> Sample {
        let specific_force_mps2 = self.accel.compensate(&raw.specific_force_mps2);
        let unfelt = raw.angular_rate_rad_s - self.felt * specific_force_mps2;
        Sample { angular_rate_rad_s: self.gyro.compensate(&unfelt), specific_force_mps2, ..*raw }
    }
}

/// All of them, in the board's order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters(pub Vec<Parameter>);

/// The two sensors by the names' beginnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    Accelerometer,
    Gyroscope,
}

impl Sensor {
    #[must_use]
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Accelerometer => "accel",
            Self::Gyroscope => "gyro",
        }
    }
}

pub const AXES: [&str; 3] = ["x", "y", "z"];

impl Parameters {
    #[must_use]
    pub fn read(lines: &[Line]) -> Self {
        Self(lines.iter().filter_map(Parameter::read).collect())
    }

    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Parameter> {
        self.0.iter().find(|parameter| parameter.name == name)
    }

    /// One sensor's bias and correction, as the board computes with them; none if a number is missing.
    #[must_use]
    pub fn triad(&self, sensor: Sensor) -> Option<Triad> {
        let prefix = sensor.prefix();
        let value = |name: String| self.get(&name)?.value;
        let mut triad = Triad { bias: Vector3::zeros(), correction: Matrix3::zeros() };
        for (i, row) in AXES.iter().enumerate() {
            triad.bias[i] = value(format!("{prefix}_bias_{row}"))?;
            for (j, column) in AXES.iter().enumerate() {
                triad.correction[(i, j)] = value(format!("{prefix}_correction_{row}{column}"))?;
            }
        }
        Some(triad)
    }

    /// All that the board computes with; none if a number is missing.
    #[must_use]
    pub fn compensation(&self) -> Option<Compensation> {
        let felt = Matrix3::from_fn(|i, j| {
            let felt = self.get(&format!("gyro_g_sensitivity_{}{}", AXES[i], AXES[j]));
            felt.and_then(|parameter| parameter.value).unwrap_or(0.0)
        });
        Some(Compensation { accel: self.triad(Sensor::Accelerometer)?, gyro: self.triad(Sensor::Gyroscope)?, felt })
    }
}
