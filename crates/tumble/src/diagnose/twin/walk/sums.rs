//! What a step adds up: how attitude errors grow, and what candidates put in.

use nalgebra::{Matrix3, Vector3};

use super::Walk;
use crate::diagnose::twin::data::{Deed, Stretch};
use crate::diagnose::twin::influence::Influence;
use crate::diagnose::twin::state::{Drive, Pushed};
use crate::diagnose::twin::trajectory::{Moment, Nominal};

/// Candidates are evaluated about this often in a second.
const NODES_HZ: f64 = 50.0;

/// A step's sums.
pub(super) struct Sums {
    pub drive: Drive,
    pub mean_drive: Drive,
    /// −R M δω summed, per candidate.
    pub push: Vec<Pushed>,
    pub duration_s: f64,
}

/// A moment in a step.
struct Node {
    dt_s: f64,
    share: f64,
    to_n: Matrix3<f64>,
    tilt: Matrix3<f64>,
    solid: bool,
}

impl Sums {
    /// A candidate's push (calibrated, frame b) at a node.
    fn add(&mut self, c: usize, rate: Vector3<f64>, mut force: Vector3<f64>, node: &Node) {
        let pushed = &mut self.push[c];
        let any_rate = rate != Vector3::zeros();
        if !node.solid {
            let step = if any_rate { node.to_n * rate * -node.dt_s } else { Vector3::zeros() };
            let middle = Vector3::from(pushed.attitude) + step * 0.5;
            force += node.tilt * middle;
            pushed.attitude = (Vector3::from(pushed.attitude) + step).into();
        } else if any_rate {
            pushed.rate = (Vector3::from(pushed.rate) + rate * node.share).into();
        }
        pushed.force = (Vector3::from(pushed.force) + force * node.share).into();
    }
}

impl Walk<'_> {
    /// Sums over the intervals from sample `first` to `last`; an interval's values are the means of its ends.
    pub(super) fn sums(&self, first: usize, last: usize, stretch: &Stretch) -> Sums {
        let columns = self.influences.len();
        let mut sums = Sums {
            drive: Drive::zeros(),
            mean_drive: Drive::zeros(),
            push: vec![Pushed::default(); columns],
            duration_s: self.moment(last).t_s - self.moment(first).t_s,
        };
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        self.sum_drive(&mut sums, first, last, solid);
        self.sum_pushes(&mut sums, first, last, solid);
        sums
    }

    /// How attitude errors grow, sample by sample.
    fn sum_drive(&self, sums: &mut Sums, first: usize, last: usize, solid: bool) {
        if solid {
            return;
        }
        for index in first..=last {
            let dt_s = self.trapezoid_s(first, index, last, 1);
            let moment = self.moment(index);
            let to_n = moment.attitude.to_rotation_matrix().into_inner();
            let step = drive(&to_n, self.pass.nominal, moment, dt_s);
            sums.mean_drive += (sums.drive + step * 0.5) * (dt_s / sums.duration_s);
            sums.drive += step;
        }
    }

    /// What candidates put in: those that are smooth at no more than `NODES_HZ`, for hands move below 12 Hz.
    fn sum_pushes(&self, sums: &mut Sums, first: usize, last: usize, solid: bool) {
        if self.influences.is_empty() {
            return;
        }
        let rate_hz = (last - first) as f64 / sums.duration_s;
        let stride = ((rate_hz / NODES_HZ) as usize).max(1);
        let span = (first, last);
        self.walk_nodes(sums, span, stride, solid, |influence| !matches!(influence, Influence::EverySample(_)));
        if self.influences.iter().any(|influence| matches!(influence, Influence::EverySample(_))) {
            self.walk_nodes(sums, span, 1, solid, |influence| matches!(influence, Influence::EverySample(_)));
        }
    }

    fn walk_nodes(
        &self,
        sums: &mut Sums,
        (first, last): (usize, usize),
        stride: usize,
        solid: bool,
        chosen: impl Fn(&Influence) -> bool,
    ) {
        let nominal = self.pass.nominal;
        let chosen: Vec<(usize, &Influence)> = self.influences.iter().enumerate().filter(|(_, i)| chosen(i)).collect();
        let mut index = first;
        loop {
            let dt_s = self.trapezoid_s(first, index, last, stride);
            let moment = self.moment(index);
            let to_n = moment.attitude.to_rotation_matrix().into_inner();
            let tilt = to_n.transpose() * Vector3::z().cross_matrix() * self.pass.gravity_mps2;
            let node = Node { dt_s, share: dt_s / sums.duration_s, to_n, tilt, solid };
            for &(c, influence) in &chosen {
                if let (Influence::Earth(along, unit), false) = (influence, solid) {
                    // The nominal carries its own Earth; what it lacks turns frame n under the box.
                    sums.push[c].attitude[*along] -= unit * dt_s;
                }
                let Some(reading) = influence.reading() else { continue };
                let push = reading(moment);
                if solid && push.is_nothing() {
                    continue;
                }
                sums.add(c, nominal.gyro * push.rate, nominal.accel * push.force, &node);
            }
            if index == last {
                return;
            }
            index = (index + stride).min(last);
        }
    }

    /// The time that a node stands for: half of what lies on either side.
    fn trapezoid_s(&self, first: usize, index: usize, last: usize, stride: usize) -> f64 {
        // The last stride may be shorter.
        let previous =
            if index == last { last - 1 - (last - first - 1) % stride } else { index.saturating_sub(stride) };
        let before_s = if index > first { self.moment(index).t_s - self.moment(previous).t_s } else { 0.0 };
        let next = (index + stride).min(last);
        let after_s = self.moment(next).t_s - self.moment(index).t_s;
        0.5 * (before_s + after_s)
    }
}

/// `R (δM (ω_raw − b) − M δb) dt − Ω dt`.
fn drive(to_n: &Matrix3<f64>, nominal: &Nominal, moment: &Moment, dt_s: f64) -> Drive {
    let raw = moment.raw_rate - nominal.gyro_bias;
    let mut drive = Drive::zeros();
    for row in 0..3 {
        for column in 0..3 {
            drive.set_column(3 * row + column, &(to_n.column(row) * (raw[column] * dt_s)));
        }
    }
    drive.fixed_view_mut::<3, 3>(0, 9).copy_from(&(to_n * nominal.gyro * -dt_s));
    drive.fixed_view_mut::<3, 3>(0, 12).copy_from(&(Matrix3::identity() * -dt_s));
    drive
}
