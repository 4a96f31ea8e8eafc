//! Where candidates are evaluated in a step, and what a push there does: made once about a nominal for all of them.

use nalgebra::{Matrix3, Matrix3x2, Vector3};

use super::Twin;
use super::influence::Push;
use super::step::Step;
use super::trajectory::{Moment, Nominal};

/// A moment in a step.
pub struct Node {
    /// Of the sample.
    pub index: usize,
    /// Of the step's time.
    share: f64,
    /// −R M dt: a raw rate's push into φ. Unused on something solid.
    turn: Matrix3<f64>,
    /// What φ's horizontal components do to the step's mean force: columns 0 and 1 of `g Rᵀ ẑ×`, times the share.
    level: Matrix3x2<f64>,
}

/// What a candidate's unit does in a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pushed {
    /// To φ over the whole step: −R M δω summed.
    pub attitude: Vector3<f64>,
    /// To the mean calibrated rate at rest, rad/s.
    pub rate: Vector3<f64>,
    /// To the mean calibrated force less what attitude explains, m/s².
    pub force: Vector3<f64>,
}

/// Nodes of every step, `nodes_hz` of them in a second or every sample.
pub fn nodes(twin: &Twin, nodes_hz: f64) -> Vec<Vec<Node>> {
    let moments = &twin.trajectory.moments;
    let of = |step: &Step| {
        let rate_hz = (step.last - step.first) as f64 / step.duration_s;
        let stride = ((rate_hz / nodes_hz) as usize).max(1);
        let at = (step.first..step.last).step_by(stride).chain([step.last]);
        at.map(|index| {
            let dt_s = trapezoid_s(moments, (step.first, step.last), index, stride);
            let (to_n, share) = (moments[index].to_n, dt_s / step.duration_s);
            let tilt = to_n.transpose() * Vector3::z().cross_matrix() * (twin.gravity_mps2 * share);
            let level = tilt.fixed_columns::<2>(0).into_owned();
            Node { index, share, turn: to_n * twin.nominal.gyro * -dt_s, level }
        })
        .collect()
    };
    twin.steps.all.iter().map(of).collect()
}

/// A reading's pushes over a step's nodes, by trapezoids: an interval's values are the means of its ends.
pub fn summed(step: &Step, nodes: &[Node], nominal: &Nominal, push: impl Fn(usize) -> Push) -> Pushed {
    let (mut attitude, mut rate, mut force) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let mut level = [0.0; 3];
    for node in nodes {
        let push = push(node.index);
        if step.solid {
            (0..3).for_each(|i| rate[i] += push.rate[i] * node.share);
        } else {
            let more: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| node.turn[(i, j)] * push.rate[j]).sum());
            let middle = [attitude[0] + 0.5 * more[0], attitude[1] + 0.5 * more[1]];
            (0..3).for_each(|i| level[i] += node.level[(i, 0)] * middle[0] + node.level[(i, 1)] * middle[1]);
            (0..3).for_each(|i| attitude[i] += more[i]);
        }
        (0..3).for_each(|i| force[i] += push.force[i] * node.share);
    }
    Pushed {
        attitude: attitude.into(),
        rate: nominal.gyro * Vector3::from(rate),
        force: nominal.accel * Vector3::from(force) + Vector3::from(level),
    }
}

/// The time that a sample stands for when every `stride`-th of a step's is taken: half of what lies on either side.
pub(super) fn trapezoid_s(moments: &[Moment], (first, last): (usize, usize), index: usize, stride: usize) -> f64 {
    // The last stride may be shorter.
    let previous = if index == last { last - 1 - (last - first - 1) % stride } else { index.saturating_sub(stride) };
    let before_s = if index > first { moments[index].t_s - moments[previous].t_s } else { 0.0 };
    let next = (index + stride).min(last);
    0.5 * (before_s + moments[next].t_s - moments[index].t_s)
}
