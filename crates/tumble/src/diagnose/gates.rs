//! Gates: what the samples themselves show before any physics is fitted. They explain much that looks like exotic physics.

use super::diagnosis::{Found, Limit};
use super::twin::data::Raw;
use crate::recording::{Inference, Recording};
use tumble_core::tape::Segment;

/// What gates look at.
pub struct Scene<'a> {
    /// The recording with its metadata and own units.
    pub recording: &'a Recording,
    /// What it says of its ranges and rate.
    pub inference: &'a Inference,
    /// SI, time from the first sample.
    pub samples: &'a [Raw],
    /// As the board's segmenter found them.
    pub segments: &'a [Segment],
}

/// What they found.
#[derive(Default)]
pub struct Gated {
    /// Effects.
    pub found: Vec<Found>,
    /// Samples to be corrected or masked: index and what to put there (None: linear from its neighbours).
    pub repaired: Vec<usize>,
    /// Reason why nothing further can be said, if so.
    pub stop: Option<String>,
    /// A constant matrix that raw rates (first) and forces (second) must be multiplied by before anything fits: axis
    /// mapping and full scale.
    pub remap: Option<(nalgebra::Matrix3<f64>, nalgebra::Matrix3<f64>)>,
    /// Structural effects that what was found here imitates: they are not to be named.
    pub imitated: Vec<String>,
    /// Detection limits.
    pub limits: Vec<Limit>,
}

/// All gates.
pub fn examine(_scene: &Scene) -> Gated {
    Gated::default()
}
