//! The covariance of what is read while the gyroscope's noise walks on.

use nalgebra::{DMatrix, Vector3};

/// A component of a mean over a group of intervals, or of the attitude where the motion ends: `axis · ε` and noise of its own, ε
/// being the attitude's error in frame n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    /// The group's number; the end's is one past the last.
    pub group: usize,
    pub axis: Vector3<f64>,
    /// Variance.
    pub own: f64,
}

/// How far attitude noise has walked, rad²: before a group, and in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walked {
    pub before: f64,
    pub own: f64,
}

/// Whose share of a group's own noise its mean sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeanNoise {
    /// That of the mean of a Wiener process: `own/3`, and `own/2` in common with all that comes after.
    Exact,
    /// Half of it, as if that were there from the group's beginning, and the rest came at its end: the device's.
    Halved,
}

impl Walked {
    fn mean(&self, kind: MeanNoise) -> f64 {
        self.before + if kind == MeanNoise::Exact { self.own / 3.0 } else { self.own / 2.0 }
    }

    fn later(&self) -> f64 {
        self.before + self.own / 2.0
    }
}

/// Of all readings; `end` is the walk's variance where it ends.
pub(super) fn covariance(readings: &[Reading], groups: &[Walked], end: f64, kind: MeanNoise) -> DMatrix<f64> {
    let shared = |a: usize, b: usize| match groups.get(a.min(b)) {
        Some(group) if a == b => group.mean(kind),
        Some(group) => group.later(),
        None => end,
    };
    let count = readings.len();
    DMatrix::from_fn(count, count, |i, j| {
        let (a, b) = (&readings[i], &readings[j]);
        let own = if i == j { a.own } else { 0.0 };
        own + a.axis.dot(&b.axis) * shared(a.group, b.group)
    })
}
