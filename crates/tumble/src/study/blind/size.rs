//! A size that an effect was made with.

use serde::{Deserialize, Serialize};

/// Instead of a limit, where another effect takes all that could show this one.
pub const HIDDEN: &str = "no size shows beside the other";

/// A size, and what it rests on.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Size {
    /// Of this effect.
    pub id: String,
    /// In the simulation's unit.
    pub magnitude: f64,
    /// The detection limit in that unit, where it made the size.
    pub limit: Option<f64>,
    /// The same as the diagnosis states it, in its own unit.
    #[serde(default)]
    pub stated: Option<f64>,
    /// `limit`, or why it was drawn from the effect's own range.
    pub by: String,
}

impl Size {
    /// Is it less than what would show? Of something outside the catalogue, of which more is more.
    pub fn is_below_limit(&self) -> bool {
        self.limit.is_some_and(|limit| self.magnitude < limit)
    }
}
