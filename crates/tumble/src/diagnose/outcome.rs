//! What a diagnosis ends with.

use super::diagnosis::Diagnosis;
use super::exhibits::Exhibits;

/// The answer and its pictures.
pub struct Outcome {
    /// The contract's object.
    pub diagnosis: Diagnosis,
    /// None where no physics could be fitted.
    pub exhibits: Option<Exhibits>,
}
