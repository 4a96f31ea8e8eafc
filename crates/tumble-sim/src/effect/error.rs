//! What can be wrong with an effect that was asked for.

use super::Effect;
use super::kind::Kind;
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
    },
    /// The magnitude is not one that can be simulated.
    OutOfRange {
        /// Of the effect.
        id: &'static str,
        /// As it was asked for.
        magnitude: f64,
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
            Self::NotANumber { id, text } => {
                write!(f, "effect {id}: '{text}' is not a number; ")?;
                range(f, id)
            }
            Self::OutOfRange { id, magnitude } => {
                write!(f, "effect {id}: {magnitude} cannot be simulated; ")?;
                range(f, id)
            }
            Self::NotInjectable { id } => write!(
                f,
                "effect {id} changes the motion or needs its exact course: it can be simulated but not added to a recording"
            ),
            Self::Lacks { what } => write!(f, "the recording has {what}"),
        }
    }
}

/// What the magnitude must be.
fn range(f: &mut fmt::Formatter<'_>, id: &str) -> fmt::Result {
    match Effect::kinds().find(|kind| kind.id == id) {
        Some(Kind { values, unit, meaning, .. }) => {
            write!(f, "it must be {values} {unit}, {meaning}")
        }
        None => Ok(()),
    }
}

impl std::error::Error for EffectError {}

/// The ids most like `id`: those that contain it or share most of its pairs of letters, at most four.
pub(super) fn near(id: &str) -> Vec<&'static str> {
    let mut found: Vec<(f64, &'static str)> =
        Effect::kinds().map(|kind| (likeness(id, kind.id), kind.id)).filter(|(score, _)| *score >= 0.45).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(4).map(|(_, id)| id).collect()
}

/// Sørensen–Dice over pairs of neighbouring letters, 0 to 1; 0.9 if one contains the other.
fn likeness(a: &str, b: &str) -> f64 {
    let (a, b) = (a.to_ascii_lowercase(), b.to_ascii_lowercase());
    if a.len() >= 3 && (b.contains(&a) || a.contains(&b)) {
        return 0.9;
    }
    let pairs = |text: &str| text.as_bytes().windows(2).map(<[u8]>::to_vec).collect::<Vec<_>>();
    let (of_a, mut of_b) = (pairs(&a), pairs(&b));
    let whole = of_a.len() + of_b.len();
    let mut shared = 0;
    for pair in &of_a {
        if let Some(at) = of_b.iter().position(|other| other == pair) {
            of_b.swap_remove(at);
            shared += 1;
        }
    }
    if whole == 0 { 0.0 } else { 2.0 * f64::from(shared) / whole as f64 }
}
