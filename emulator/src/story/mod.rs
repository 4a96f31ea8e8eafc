//! The story that `cargo xtask demo` tells, and that the tests tell in other ways: the firmware image on the emulated
//! board, a simulated person before it, and a host that listens and keeps score.
//!
//! [`stage`] has the board, the world and the person; [`acts`] is what happens on it; [`score`] and [`inertial`] compare
//! what came out with the truth; [`replay`] has a recording in the person's place.

pub mod acts;
pub mod checks;
pub mod frames;
pub mod host_path;
pub mod inertial;
pub mod levelling;
pub mod line;
pub mod narrator;
pub mod parameters;
pub mod replay;
pub mod replay_world;
pub mod score;
pub mod stage;
pub mod tally;
pub mod theatre;
pub mod whole;

use crate::BoardError;

/// Why a story cannot go on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure(pub String);

impl std::fmt::Display for Failure {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for Failure {}

impl From<BoardError> for Failure {
    fn from(error: BoardError) -> Self {
        Self(error.to_string())
    }
}

impl From<tumble_sim::SimError> for Failure {
    fn from(error: tumble_sim::SimError) -> Self {
        Self(error.to_string())
    }
}
