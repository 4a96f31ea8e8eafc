//! From a gate's numbers to what is told.

use crate::diagnose::catalogue::Card;
use crate::diagnose::diagnosis::{Found, Limit, Place, Value};

/// What one gate came to.
#[derive(Default)]
pub struct Outcome {
    /// If it fired.
    pub found: Option<Found>,
    /// What it could have seen.
    pub limit: Option<Limit>,
    /// Samples to be replaced.
    pub repaired: Vec<usize>,
    /// Samples that stand at a level, with their channels (bits as in `Reading::clipped`).
    pub clipped: Vec<(usize, u8)>,
    /// Structural effects that this one looks like.
    pub imitated: &'static [&'static str],
}

impl Outcome {
    /// Not told where another gate's finding explains it; what it could have seen stands.
    pub fn unless(self, explained: bool) -> Self {
        let clipped = if explained { Vec::new() } else { self.clipped };
        Self { found: self.found.filter(|_| !explained), clipped, ..self }
    }
}

/// An effect by its card. `evidence` is ln of one over the probability of as much by chance.
pub fn found(card: &Card, evidence: f64, parameters: Vec<Value>, place: Place) -> Found {
    Found {
        id: card.id.into(),
        name: card.name.into(),
        equation: card.equation.into(),
        evidence,
        runner_up: None,
        tied_with: Vec::new(),
        tied_with_shapes: Vec::new(),
        separate_by: card.separate_by.into(),
        parameters,
        place,
        typical: card.typical.into(),
        held_out: None,
        other_recordings: Vec::new(),
    }
}

/// A number.
pub fn value(name: &str, value: f64, sigma: f64, unit: &str) -> Value {
    Value { name: name.into(), value, sigma, unit: unit.into() }
}

/// A limit of a gate that can fire here.
pub fn limit(card: &Card, limit: f64, unit: &str, why: &str) -> Option<Limit> {
    let (limit, testable) = if limit.is_finite() { (limit, true) } else { (0.0, false) };
    Some(Limit { id: card.id.into(), limit, unit: unit.into(), fisher_sigmas: None, testable, why: why.into() })
}

/// A limit of a gate that cannot.
pub fn untestable(card: &Card, unit: &str, why: &str) -> Option<Limit> {
    Some(Limit {
        id: card.id.into(),
        limit: 0.0,
        unit: unit.into(),
        fisher_sigmas: None,
        testable: false,
        why: why.into(),
    })
}
