//! A candidate's column: how its unit shows, and what that adds to every step of the filter about the present nominal.

use super::Twin;
use super::influence::{Influence, Reading};
use super::nodes::{Node, Pushed, summed};
use super::step::Step;

/// An influence and its pushes.
pub struct Column {
    /// How it shows.
    pub influence: Influence,
    /// Step by step; empty until a twin made them.
    pushed: Vec<Pushed>,
}

impl From<Influence> for Column {
    fn from(influence: Influence) -> Self {
        Self { influence, pushed: Vec::new() }
    }
}

impl Column {
    /// In a step.
    pub(super) fn pushed(&self, step: usize) -> &Pushed {
        &self.pushed[step]
    }

    /// Are its pushes made?
    pub fn is_made(&self) -> bool {
        !self.pushed.is_empty()
    }

    /// The nominal has changed, and its pushes with it.
    pub fn forget(&mut self) {
        self.pushed.clear();
    }

    /// Makes its pushes about a twin's nominal.
    pub fn make(&mut self, twin: &Twin) {
        let steps = &twin.steps.all;
        let read = |reading: &Reading, nodes: &[Vec<Node>]| {
            let push = |index: usize| reading(&twin.trajectory.moments[index]);
            let each = steps.iter().zip(nodes);
            each.map(|(step, nodes)| summed(step, nodes, &twin.nominal, push)).collect()
        };
        self.pushed = match &self.influence {
            Influence::Reading(reading) => read(reading, twin.steps.smooth(twin)),
            Influence::EverySample(reading) => read(reading, twin.steps.every(twin)),
            Influence::Earth(along, unit) => steps.iter().map(|step| turned(step, *along, *unit)).collect(),
            Influence::Stop(_) | Influence::Table(..) | Influence::Lever(..) => vec![Pushed::default(); steps.len()],
        };
    }
}

/// The nominal carries its own Earth; what it lacks turns frame n under the box.
fn turned(step: &Step, along: usize, unit: f64) -> Pushed {
    let mut pushed = Pushed::default();
    if !step.solid {
        pushed.attitude[along] = -unit * step.duration_s;
    }
    pushed
}
