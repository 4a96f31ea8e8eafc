//! The answer: the contract's JSON object, and what pictures and words are made of.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize, Serializer};

/// Stands for "none of any size" where JSON needs a number: beyond every size that occurs, and safe to compare with.
/// (JSON has no infinity, `serde_json` would write null, and `f64::MAX` overflows where it is read in decimal.)
pub const BEYOND: f64 = 1e99;

/// A number that JSON can hold: what is infinite or more becomes ±[`BEYOND`], what is not a number 0.
pub fn number(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value.clamp(-BEYOND, BEYOND) }
}

fn as_number<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(number(*value))
}

/// For a sigma or a limit: what is not a number says nothing, which is [`BEYOND`], not 0.
fn as_bound<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(if value.is_nan() { BEYOND } else { number(*value) })
}

/// For a probability: what is not a number proves nothing, which is 1.
fn as_probability<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(if value.is_nan() { 1.0 } else { value.clamp(0.0, 1.0) })
}

/// In one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The nominal model explains the recording.
    NothingMissing,
    /// Effects of the catalogue explain what the nominal model does not.
    EffectFound,
    /// Something is left that no effect of the catalogue explains.
    UnknownEffect,
    /// The recording supports no verdict.
    NotTestable,
}

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub struct Diagnosis {
    /// `tumble-diagnosis`.
    pub format: &'static str,
    /// 1.
    pub version: u32,
    /// In one word.
    pub verdict: Verdict,
    /// The strongest first.
    pub effects: Vec<Found>,
    /// What is left.
    pub unknown: Option<Unknown>,
    /// Mean squared whitened residuals.
    pub fit: FitReport,
    /// What could have been seen.
    pub detection_limits: Vec<Limit>,
    /// Sentences, the most important first.
    pub reasons: Vec<String>,
}

impl Diagnosis {
    /// A verdict, and nothing else yet.
    pub fn new(verdict: Verdict) -> Self {
        Self {
            format: "tumble-diagnosis",
            version: 1,
            verdict,
            effects: Vec::new(),
            unknown: None,
            fit: FitReport::default(),
            detection_limits: Vec::new(),
            reasons: Vec::new(),
        }
    }
}

/// An effect.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    /// As in the contract.
    pub id: String,
    /// For a person.
    pub name: String,
    /// As a formula.
    pub equation: String,
    /// ln of the Bayes factor against the model without it.
    #[serde(serialize_with = "as_number")]
    pub evidence: f64,
    /// What explains nearly as much.
    pub runner_up: Option<RunnerUp>,
    /// What explains as much.
    pub tied_with: Vec<String>,
    /// Shapes without a name that explain as much: of time, heading, or what was before. Left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tied_with_shapes: Vec<String>,
    /// The experiment that would tell them apart.
    pub separate_by: String,
    /// With sigmas.
    pub parameters: Vec<Value>,
    /// Place.
    #[serde(rename = "where")]
    pub place: Place,
    /// What the data sheet says.
    pub typical: String,
    /// Mean squared residual of rows left out of the fit, by halves of every position, both ways; none for gates.
    pub held_out: Option<HeldOut>,
    /// Tried with these very numbers on further recordings; empty where there were none or it does not carry over.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub other_recordings: Vec<OtherRecording>,
}

/// An effect on a recording that it was not found in, its parameters as found in the first.
#[derive(Clone, Debug, Serialize)]
pub struct OtherRecording {
    /// As it was named.
    pub file: String,
    /// Mean squared whitened residual without this effect, the others that were found taken out.
    #[serde(serialize_with = "as_number")]
    pub before: f64,
    /// With it.
    #[serde(serialize_with = "as_number")]
    pub after: f64,
    /// Half the fall of the sum of squares: ln of a Bayes factor, as nothing is fitted.
    #[serde(serialize_with = "as_number")]
    pub gain: f64,
}

/// Before and after, on data that the parameters were not fitted to.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct HeldOut {
    /// Without the effect.
    #[serde(serialize_with = "as_number")]
    pub before: f64,
    /// With it.
    #[serde(serialize_with = "as_number")]
    pub after: f64,
    /// Probability of parameters as different between the halves, if they are constant (Chow).
    #[serde(serialize_with = "as_probability")]
    pub constancy_p: f64,
}

/// A rival.
#[derive(Clone, Debug, Serialize)]
pub struct RunnerUp {
    /// As in the contract.
    pub id: String,
    /// By how much its evidence is less.
    #[serde(serialize_with = "as_number")]
    pub gap: f64,
}

/// A number.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Value {
    /// Of the parameter.
    pub name: String,
    /// In its unit.
    #[serde(serialize_with = "as_number")]
    pub value: f64,
    /// One sigma.
    #[serde(serialize_with = "as_bound")]
    pub sigma: f64,
    /// Of both.
    pub unit: String,
}

/// Channel, segment, time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Place {
    /// `gyro_x` … `accel_z`.
    pub channels: Vec<String>,
    /// Numbers as `tumble calibrate --json` has them.
    pub segments: Vec<usize>,
    /// By the recording's own stamps.
    #[serde(serialize_with = "as_number")]
    pub start_s: f64,
    /// Likewise.
    #[serde(serialize_with = "as_number")]
    pub end_s: f64,
}

/// What no effect explains.
#[derive(Clone, Debug, Serialize)]
pub struct Unknown {
    /// Place.
    #[serde(rename = "where")]
    pub place: Place,
    /// What it follows.
    pub correlates_with: Vec<String>,
    /// Effects that it is like.
    pub resembles: Vec<String>,
    /// Of so much by chance.
    #[serde(serialize_with = "as_probability")]
    pub p_value: f64,
}

/// One figure on the data fitted, one on the data left out.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Pair {
    /// Fitted to.
    #[serde(serialize_with = "as_number")]
    pub train: f64,
    /// Left out of the fit.
    #[serde(serialize_with = "as_number")]
    pub held_out: f64,
}

/// Before and after.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FitReport {
    /// The nominal model.
    pub before: Pair,
    /// With what was found.
    pub after: Pair,
    /// Mean squares by channel.
    pub per_channel: BTreeMap<String, ChannelFit>,
}

/// Of one channel.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct ChannelFit {
    /// The nominal model.
    #[serde(serialize_with = "as_number")]
    pub before: f64,
    /// With what was found.
    #[serde(serialize_with = "as_number")]
    pub after: f64,
}

/// What this recording could have shown.
#[derive(Clone, Debug, Serialize)]
pub struct Limit {
    /// As in the contract.
    pub id: String,
    /// Size found with 95 % certainty; [`BEYOND`] in JSON where no size would be.
    #[serde(serialize_with = "as_bound")]
    pub limit: f64,
    /// Of the limit.
    pub unit: String,
    /// The limit over the Fisher bound of that number, the effect's other numbers free, under the most noise that the null may choose; none
    /// of what gates find and of walks.
    pub fisher_sigmas: Option<f64>,
    /// Could it have shown at a size that occurs?
    pub testable: bool,
    /// Why not, or what it is mistaken for.
    pub why: String,
}
