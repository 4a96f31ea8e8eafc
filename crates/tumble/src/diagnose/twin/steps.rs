//! The recording in steps of the filter: what samples and trajectory say in each, whatever the noise. Made once about a
//! nominal; every pass, at any noise and for any candidates, reads them.

use std::ops::Range;
use std::sync::OnceLock;

use nalgebra::{Matrix3, Vector3};

use super::Twin;
use super::data::{Deed, Raw, Stretch};
use super::nodes::{Node, nodes, trapezoid_s};
use super::state::Drive;
use super::step::Step;
use super::trajectory::{Moment, Nominal, Trajectory};

/// Longest step in a turn and in a rest, s.
const TURN_STEP_S: f64 = 0.25;
const REST_STEP_S: f64 = 0.5;

/// Smooth candidates are evaluated about this often in a second: hands move below 12 Hz.
const NODES_HZ: f64 = 50.0;

/// All of them.
#[derive(Default)]
pub struct Steps {
    /// In order of time.
    pub all: Vec<Step>,
    /// Which belong to each stretch.
    pub of_stretch: Vec<Range<usize>>,
    smooth: OnceLock<Vec<Vec<Node>>>,
    every: OnceLock<Vec<Vec<Node>>>,
}

/// What steps are summed over.
struct Ground<'a> {
    samples: &'a [Raw],
    moments: &'a [Moment],
    nominal: &'a Nominal,
    gravity_mps2: f64,
}

impl Steps {
    /// About a nominal and its trajectory.
    pub fn new(
        samples: &[Raw],
        stretches: &[Stretch],
        trajectory: &Trajectory,
        nominal: &Nominal,
        gravity_mps2: f64,
    ) -> Self {
        let ground = Ground { samples, moments: &trajectory.moments, nominal, gravity_mps2 };
        let mut steps = Self::default();
        for stretch in stretches {
            let begin = steps.all.len();
            let step_s = if stretch.is_rest() { REST_STEP_S } else { TURN_STEP_S };
            let end = stretch.samples.end - 1;
            let mut first = stretch.samples.start;
            while first < end {
                let last = ground.step_end(first, end, step_s);
                steps.all.push(ground.step(stretch, first, last));
                first = last;
            }
            steps.of_stretch.push(begin..steps.all.len());
        }
        steps
    }

    /// Where smooth candidates are evaluated, step by step.
    pub fn smooth(&self, twin: &Twin) -> &[Vec<Node>] {
        self.smooth.get_or_init(|| nodes(twin, NODES_HZ))
    }

    /// Where those are that change from sample to sample.
    pub fn every(&self, twin: &Twin) -> &[Vec<Node>] {
        self.every.get_or_init(|| nodes(twin, f64::INFINITY))
    }
}

impl Ground<'_> {
    fn step_end(&self, first: usize, end: usize, step_s: f64) -> usize {
        let limit_s = self.moments[first].t_s + step_s + 1e-6;
        let mut last = first + 1;
        while last < end && self.moments[last + 1].t_s <= limit_s {
            last += 1;
        }
        // No crumb at the end.
        if end - last < (last - first) / 2 { end } else { last }
    }

    fn step(&self, stretch: &Stretch, first: usize, last: usize) -> Step {
        let at = |index: usize| &self.moments[index];
        let (start_s, end_s) = (at(first).t_s, at(last).t_s);
        let middle_s = 0.5 * (start_s + end_s);
        let whole = &stretch.samples;
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        let turning = matches!(stretch.deed, Deed::Turn { .. });
        let to_b = |index: usize| at(index).to_n.transpose();
        let mut step = Step {
            first,
            last,
            solid,
            duration_s: end_s - start_s,
            middle_s,
            end_s,
            late: middle_s > 0.5 * (at(whole.start).t_s + at(whole.end - 1).t_s),
            drive: Drive::zeros(),
            mean_drive: Drive::zeros(),
            to_b: to_b(first),
            rate: Vector3::zeros(),
            force: Vector3::zeros(),
            gravity: Vector3::zeros(),
            tilt: Matrix3::zeros(),
            lever: Matrix3::zeros(),
        };
        if solid {
            let rate = self.mean(first, last, |i| self.nominal.rate(&self.samples[i]));
            step.rate = rate - step.to_b * self.nominal.earth;
        } else {
            self.sum_drive(&mut step);
        }
        if stretch.is_rest() || turning {
            let up = Vector3::z() * self.gravity_mps2;
            let inverse = self.nominal.accel.try_inverse().unwrap_or_else(Matrix3::identity);
            let gravity = self.mean(first, last, |i| to_b(i) * up);
            step.force = self.mean(first, last, |i| self.nominal.force(&self.samples[i])) - gravity;
            step.gravity = inverse * gravity;
            step.tilt = mean_matrix(first, last, |i| to_b(i) * Vector3::z().cross_matrix() * self.gravity_mps2);
        }
        if turning {
            step.lever = mean_matrix(first, last, |i| lever(at(i)));
        }
        step
    }

    /// Sample by sample; an interval's values are the means of its ends.
    fn sum_drive(&self, step: &mut Step) {
        for index in step.first..=step.last {
            let dt_s = trapezoid_s(self.moments, (step.first, step.last), index, 1);
            let moment = &self.moments[index];
            let more = drive(&moment.to_n, self.nominal, moment, dt_s);
            step.mean_drive += (step.drive + more * 0.5) * (dt_s / step.duration_s);
            step.drive += more;
        }
    }

    fn mean(&self, first: usize, last: usize, f: impl Fn(usize) -> Vector3<f64>) -> Vector3<f64> {
        let (mut sum, mut time) = (Vector3::zeros(), 0.0);
        let mut before = f(first);
        for index in first..last {
            let dt_s = self.moments[index + 1].t_s - self.moments[index].t_s;
            let after = f(index + 1);
            sum += (before + after) * (0.5 * dt_s);
            time += dt_s;
            before = after;
        }
        sum / time
    }
}

fn mean_matrix(first: usize, last: usize, f: impl Fn(usize) -> Matrix3<f64>) -> Matrix3<f64> {
    let sum: Matrix3<f64> = (first..=last).map(f).sum();
    sum / (last + 1 - first) as f64
}

/// `[ω×]² + [ω̇×]`.
fn lever(moment: &Moment) -> Matrix3<f64> {
    let rate = moment.rate.cross_matrix();
    rate * rate + moment.acceleration.cross_matrix()
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
