//! What a study reads of a diagnosis: the contract's JSON, and nothing that the contract does not promise.

use serde::Deserialize;

/// `tumble diagnose --json`.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Answer {
    /// In one word.
    pub verdict: String,
    /// What was named.
    #[serde(default)]
    pub effects: Vec<Named>,
    /// What was not.
    pub unknown: Option<Unknown>,
    /// What could have been seen.
    #[serde(default)]
    pub detection_limits: Vec<Limit>,
    /// Sentences.
    #[serde(default)]
    pub reasons: Vec<String>,
}

/// An effect that was named.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Named {
    /// As in the contract.
    pub id: String,
    /// What explains as much.
    #[serde(default)]
    pub tied_with: Vec<String>,
    /// Shapes without a name that explain as much.
    #[serde(default)]
    pub tied_with_shapes: Vec<String>,
    /// With sigmas.
    #[serde(default)]
    pub parameters: Vec<Value>,
}

impl Named {
    /// Whether this id is the name, or tied with it.
    pub fn says(&self, id: &str) -> bool {
        self.id == id || self.tied_with.iter().any(|tied| tied == id)
    }
}

/// A number. What is not finite is written as null.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Value {
    /// Of the parameter.
    pub name: String,
    /// In its unit.
    pub value: Option<f64>,
    /// One sigma.
    pub sigma: Option<f64>,
    /// Of both.
    #[serde(default)]
    pub unit: String,
}

/// Something is left.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Unknown {
    /// Effects that it is like.
    #[serde(default)]
    pub resembles: Vec<String>,
}

/// What could have been seen.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Limit {
    /// As in the contract.
    pub id: String,
    /// Size.
    pub limit: Option<f64>,
    /// Of the limit.
    #[serde(default)]
    pub unit: String,
    /// Over the Fisher bound.
    #[serde(default)]
    pub fisher_sigmas: Option<f64>,
    /// Could it have shown?
    #[serde(default)]
    pub testable: bool,
    /// Why not.
    #[serde(default)]
    pub why: String,
}

/// What came of asking.
#[derive(Clone, Debug)]
pub struct Asked {
    /// Wall time, s.
    pub seconds: f64,
    /// None: `trouble` says why.
    pub answer: Option<Answer>,
    /// Exit status, signal, time-out, what was on standard error.
    pub trouble: String,
}
