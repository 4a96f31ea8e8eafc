//! What was drawn for an effect, as the truth file has it.

use nalgebra::Vector3;
use serde::Serialize;

/// One number that was drawn for an effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    /// What it is, in `snake_case`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

impl Parameter {
    /// A parameter of this name.
    pub fn new(name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self { name: name.into(), value, unit }
    }

    /// The three components of a vector: `name_x`, `name_y`, `name_z`.
    pub fn xyz(name: &str, vector: &Vector3<f64>, unit: &'static str) -> Vec<Self> {
        ["x", "y", "z"]
            .iter()
            .zip(vector.iter())
            .map(|(axis, v)| Self::new(format!("{name}_{axis}"), *v, unit))
            .collect()
    }
}

/// An effect as it was drawn: what goes into the truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectTruth {
    /// The contract's id.
    pub id: &'static str,
    /// As asked for.
    pub magnitude: f64,
    /// Of the magnitude.
    pub unit: &'static str,
    /// What was drawn or came out.
    pub parameters: Vec<Parameter>,
}
