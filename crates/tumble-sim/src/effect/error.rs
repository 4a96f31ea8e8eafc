//! What can be wrong with an effect that was asked for.

use core::fmt;

/// An effect that cannot be had.
#[derive(Debug, Clone, PartialEq)]
pub enum EffectError {
    /// No effect has this id.
    Unknown {
        /// As it was written.
        id: String,
        /// Ids that look like it.
        near: Vec<&'static str>,
    },
    /// What stands behind `=` is no number.
    NotANumber {
        /// Of the effect.
        id: &'static str,
        /// As it was written.
        text: String,
        /// What it must be.
        must: String,
    },
    /// The magnitude is not one that can be simulated.
    OutOfRange {
        /// Of the effect.
        id: &'static str,
        /// As it was asked for.
        magnitude: f64,
        /// What it must be.
        must: String,
    },
    /// The effect needs a simulated motion.
    NotInjectable {
        /// Of the effect.
        id: &'static str,
    },
    /// The real recording lacks what the effect acts on.
    Lacks {
        /// What is missing.
        what: &'static str,
    },
}

impl fmt::Display for EffectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { id, near } => {
                write!(f, "there is no effect '{id}'")?;
                if !near.is_empty() {
                    write!(f, "; near to it: {}", near.join(", "))?;
                }
                write!(f, " (--list-effects has all)")
            }
            Self::NotANumber { id, text, must } => {
                write!(f, "effect {id}: '{text}' is not a number; it must be {must}")
            }
            Self::OutOfRange { id, magnitude, must } => {
                write!(f, "effect {id}: {magnitude} cannot be simulated; it must be {must}")
            }
            Self::NotInjectable { id } => write!(
                f,
                "effect {id} changes the motion or needs its exact course: it can be simulated but not added to a recording"
            ),
            Self::Lacks { what } => write!(f, "the recording has {what}"),
        }
    }
}

impl std::error::Error for EffectError {}
