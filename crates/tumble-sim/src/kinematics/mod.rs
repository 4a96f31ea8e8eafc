//! Exact motion: values with their first two derivatives, and rotations composed of turns about fixed axes.

mod jet;
mod profile;
mod spin;

pub use jet::Jet;
pub use profile::{bump, cruise, ease, window};
pub use spin::{Path, Spin};
