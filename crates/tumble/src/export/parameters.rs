//! Reading a calibration: the host tool's JSON or the board's `cal export`.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};

use super::ExportError;
use crate::output::{Matrix, Report, Vector};
use crate::serial::value;

/// One sensor's numbers; an element that the recording does not determine is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Triad {
    /// SI.
    pub bias: Vector3<f64>,
    /// Row by row.
    pub correction: [[Option<f64>; 3]; 3],
    name: &'static str,
}

/// Both sensors' numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// m/s².
    pub accelerometer: Triad,
    /// rad/s.
    pub gyroscope: Triad,
    /// What is to be taken off the raw rate for the compensated specific force, (rad/s)/(m/s²), where there is such a thing.
    pub g_sensitivity: Option<Matrix3<f64>>,
    /// `box` or `accelerometer`, where it is said.
    pub frame: Option<String>,
    /// Where it is said.
    pub temperature_degc: Option<f64>,
}

impl Triad {
    /// The whole matrix, or which element is not determined.
    pub fn matrix(&self) -> Result<Matrix3<f64>, ExportError> {
        let mut matrix = Matrix3::zeros();
        for i in 0..3 {
            for j in 0..3 {
                matrix[(i, j)] = self.element(i, j)?;
            }
        }
        Ok(matrix)
    }

    /// The diagonal alone.
    pub fn scale(&self) -> Result<Vector3<f64>, ExportError> {
        Ok(Vector3::new(self.element(0, 0)?, self.element(1, 1)?, self.element(2, 2)?))
    }

    /// The largest off-diagonal element that is known.
    pub fn largest_cross(&self) -> f64 {
        let off = (0..3).flat_map(|i| (0..3).filter(move |j| *j != i).map(move |j| (i, j)));
        off.filter_map(|(i, j)| self.correction[i][j]).fold(0.0, |max, v| max.max(v.abs()))
    }

    fn element(&self, i: usize, j: usize) -> Result<f64, ExportError> {
        self.correction[i][j].ok_or_else(|| ExportError::NotObservable(element_name(self.name, i, j)))
    }
}

fn element_name(sensor: &str, i: usize, j: usize) -> String {
    let axes = ["x", "y", "z"];
    format!("{sensor}_correction_{}{}", axes[i], axes[j])
}

impl Parameters {
    /// Takes either form.
    pub fn parse(text: &str) -> Result<Self, ExportError> {
        if let Ok(report) = serde_json::from_str::<Report>(text) {
            return Self::from_report(&report);
        }
        let lines = || text.lines().map(str::trim).filter(|line| line.starts_with("@param "));
        if lines().next().is_none() {
            return Err(ExportError::NotParameters);
        }
        Self::from_lines(lines())
    }

    fn from_report(report: &Report) -> Result<Self, ExportError> {
        let (Some(accel), Some(gyro)) = (&report.accelerometer, &report.gyroscope) else {
            return Err(ExportError::Rejected(report.reasons.join("; ")));
        };
        Ok(Self {
            accelerometer: triad("accel", &accel.bias_mps2, &accel.correction),
            gyroscope: triad("gyro", &gyro.bias_rad_s, &gyro.correction),
            g_sensitivity: gyro.g_sensitivity_rad_s_per_mps2.map(|rows| Matrix3::from_fn(|i, j| f64::from(rows[i][j]))),
            frame: report.frame.clone(),
            temperature_degc: report.temperature_degc.map(f64::from),
        })
    }

    fn from_lines<'a>(lines: impl Iterator<Item = &'a str>) -> Result<Self, ExportError> {
        let mut numbers = HashMap::new();
        for line in lines {
            let name = value(line, "name").ok_or_else(|| ExportError::Missing(format!("the name in '{line}'")))?;
            let observable = value(line, "observable") != Some("no");
            let number = value(line, "value").and_then(|text| text.parse::<f64>().ok()).filter(|v| v.is_finite());
            if observable && number.is_none() {
                return Err(ExportError::Missing(name.into()));
            }
            numbers.insert(name.to_owned(), number.filter(|_| observable));
        }
        let get = |name: String| numbers.get(&name).copied().ok_or(ExportError::Missing(name));
        Ok(Self {
            accelerometer: named("accel", &get)?,
            gyroscope: named("gyro", &get)?,
            g_sensitivity: felt(&numbers),
            frame: None,
            temperature_degc: numbers.get("calibration_temperature").copied().flatten(),
        })
    }
}

/// All nine or none.
fn felt(numbers: &HashMap<String, Option<f64>>) -> Option<Matrix3<f64>> {
    let mut matrix = Matrix3::zeros();
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let axes = ["x", "y", "z"];
        matrix[(i, j)] = numbers.get(&format!("gyro_g_sensitivity_{}{}", axes[i], axes[j])).copied().flatten()?;
    }
    Some(matrix)
}

fn triad(name: &'static str, bias: &Vector, correction: &Matrix) -> Triad {
    Triad {
        bias: Vector3::from(bias.map(f64::from)),
        correction: correction.map(|row| row.map(|v| v.map(f64::from))),
        name,
    }
}

fn named(
    sensor: &'static str,
    get: &impl Fn(String) -> Result<Option<f64>, ExportError>,
) -> Result<Triad, ExportError> {
    let mut triad = Triad { bias: Vector3::zeros(), correction: [[None; 3]; 3], name: sensor };
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let bias = format!("{sensor}_bias_{axis}");
        triad.bias[i] = get(bias.clone())?.ok_or(ExportError::NotObservable(bias))?;
        for j in 0..3 {
            triad.correction[i][j] = get(element_name(sensor, i, j))?;
        }
    }
    Ok(triad)
}
