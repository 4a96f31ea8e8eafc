//! A candidate's column: how its unit shows, and what that adds to every step of the filter about the present nominal.

use nalgebra::Vector3;

use super::Twin;
use super::influence::{Influence, Reading};
use super::steps::{Step, trapezoid_s};

/// Smooth candidates are evaluated about this often in a second: hands move below 12 Hz.
const NODES_HZ: f64 = 50.0;

/// What a candidate's unit does in a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pushed {
    /// To φ over the whole step: −R M δω summed.
    pub attitude: [f64; 3],
    /// To the mean calibrated rate at rest, rad/s.
    pub rate: [f64; 3],
    /// To the mean calibrated force less what attitude explains, m/s².
    pub force: [f64; 3],
}

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
        self.pushed = match &self.influence {
            Influence::Reading(reading) => steps.iter().map(|step| summed(twin, step, reading, NODES_HZ)).collect(),
            Influence::EverySample(reading) => {
                steps.iter().map(|step| summed(twin, step, reading, f64::INFINITY)).collect()
            }
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

/// A reading's push over a step, by trapezoids: an interval's values are the means of its ends.
fn summed(twin: &Twin, step: &Step, reading: &Reading, nodes_hz: f64) -> Pushed {
    let rate_hz = (step.last - step.first) as f64 / step.duration_s;
    let stride = ((rate_hz / nodes_hz) as usize).max(1);
    let mut sum = Pushed::default();
    let mut index = step.first;
    loop {
        let push = reading(&twin.trajectory.moments[index]);
        if !(step.solid && push.is_nothing()) {
            let dt_s = trapezoid_s(&twin.trajectory.moments, (step.first, step.last), index, stride);
            let (rate, force) = (twin.nominal.gyro * push.rate, twin.nominal.accel * push.force);
            add(&mut sum, twin, step, (index, dt_s), rate, force);
        }
        if index == step.last {
            return sum;
        }
        index = (index + stride).min(step.last);
    }
}

/// A push (calibrated, frame b) at a node.
fn add(
    sum: &mut Pushed,
    twin: &Twin,
    step: &Step,
    (index, dt_s): (usize, f64),
    rate: Vector3<f64>,
    force: Vector3<f64>,
) {
    let share = dt_s / step.duration_s;
    let any_rate = rate != Vector3::zeros();
    let mut force = force;
    if step.solid {
        if any_rate {
            sum.rate = (Vector3::from(sum.rate) + rate * share).into();
        }
    } else {
        let to_n = twin.trajectory.moments[index].to_n;
        let more = if any_rate { to_n * rate * -dt_s } else { Vector3::zeros() };
        let middle = Vector3::from(sum.attitude) + more * 0.5;
        force += to_n.tr_mul(&Vector3::z().cross(&middle)) * twin.gravity_mps2;
        sum.attitude = (Vector3::from(sum.attitude) + more).into();
    }
    sum.force = (Vector3::from(sum.force) + force * share).into();
}
