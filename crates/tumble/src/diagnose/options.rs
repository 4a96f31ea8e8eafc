//! What a diagnosis may be asked for.

use tumble_core::estimate::Conditions;

/// What may be asked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Effects that the search is not to know.
    pub without: Vec<String>,
    /// Of the draws that set thresholds.
    pub seed: u64,
    /// Table and box, instead of what the recording states.
    pub conditions: Option<Conditions>,
}
