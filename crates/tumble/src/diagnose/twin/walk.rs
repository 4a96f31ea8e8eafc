//! One pass of the linearised filter over the recording: rows out, every candidate's response along with them.
//!
//! The physics is that of `docs/method.md` §4, in `f64`, from samples, with force residuals in frame b:
//! `A (f − a) − Rᵀ g ẑ = −δA (f − a) + A δa + g Rᵀ (ẑ × φ) + L (l + pivot)`.

use nalgebra::{DMatrix, Matrix3, Vector3};
use tumble_core::face::Face;
use tumble_core::motion::path::WHOLE_TURN;

use super::data::{Deed, Stretch};
use super::influence::Influence;
use super::rows::{Address, Class, Rows};
use super::state::{self, Drive, Observation, State, Whitened};
use super::trajectory::Moment;
use super::{Pass, noise};

mod sums;

use sums::Sums;

/// Longest step in a turn and in a rest, s.
const TURN_STEP_S: f64 = 0.25;
const REST_STEP_S: f64 = 0.5;

struct Visit {
    face: Face,
    first: nalgebra::UnitQuaternion<f64>,
    turned_rad: f64,
    last_turn: usize,
}

/// The pass's memory.
pub(super) struct Walk<'a> {
    pass: &'a Pass<'a>,
    influences: &'a [Influence],
    pub state: State,
    at: Vec<Address>,
    values: Vec<f64>,
    responses: Vec<f64>,
    log_sigma: f64,
    aligned: bool,
    moved: bool,
    bridge: bool,
    visit: Option<Visit>,
    alternate: bool,
    last_s: f64,
}

impl<'a> Walk<'a> {
    pub fn new(pass: &'a Pass<'a>, influences: &'a [Influence]) -> Self {
        let state = pass.prior.apply(State::new(influences.len()), pass.nominal);
        Self {
            pass,
            influences,
            state,
            at: Vec::new(),
            values: Vec::new(),
            responses: Vec::new(),
            log_sigma: 0.0,
            aligned: false,
            moved: false,
            bridge: false,
            visit: None,
            alternate: false,
            last_s: 0.0,
        }
    }

    pub fn run(mut self) -> (Rows, State) {
        for (stretch, levelled) in self.pass.stretches.iter().zip(&self.pass.trajectory.levelled) {
            if stretch.is_rest() {
                self.rest(stretch, levelled);
            } else {
                self.motion(stretch);
            }
        }
        let (rows, columns) = (self.values.len(), self.influences.len());
        let responses = DMatrix::from_row_slice(rows, columns, &self.responses);
        (Rows { at: self.at, values: state::column(&self.values), responses, log_sigma: self.log_sigma }, self.state)
    }

    fn rest(&mut self, stretch: &Stretch, levelled: &Vector3<f64>) {
        if !self.aligned || self.bridge {
            self.begin_chain();
        } else {
            self.state.relevel(levelled);
        }
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        let end = stretch.samples.end - 1;
        let middle_s = 0.5 * (self.moment(stretch.samples.start).t_s + self.moment(end).t_s);
        let mut first = stretch.samples.start;
        while first < end {
            let last = self.step_end(first, end, REST_STEP_S);
            let sums = self.sums(first, last, stretch);
            self.wander(self.moment(last).t_s, [1.0; 2]);
            let late = 0.5 * (self.moment(first).t_s + self.moment(last).t_s) > middle_s;
            if solid {
                self.observe_rate(stretch, first, last, &sums, late);
            }
            self.observe_force(stretch, first, last, &sums, late);
            // On something solid the box turns with the Earth, and so does frame n: φ stands still.
            if !solid {
                self.propagate(&sums);
            }
            self.moved = false;
            first = last;
        }
        self.stand(stretch);
    }

    fn begin_chain(&mut self) {
        self.state.reset(state::ATTITUDE, 3, 0.1);
        self.state.reset(state::ATTITUDE + 2, 1, 0.0);
        self.state.reset(state::EARTH, 3, self.pass.prior.earth_sigma);
        self.state.reset(state::TABLE, 2, 0.1);
        (self.aligned, self.bridge, self.moved, self.visit) = (true, false, false, None);
    }

    fn motion(&mut self, stretch: &Stretch) {
        self.moved = true;
        self.bridge |= stretch.broken;
        let turn = matches!(stretch.deed, Deed::Turn { .. }) && !stretch.excluded;
        match (&mut self.visit, stretch.deed) {
            (Some(visit), Deed::Turn { angle_rad, .. }) if turn => {
                visit.turned_rad += angle_rad;
                visit.last_turn = stretch.number;
            }
            (visit, _) => *visit = None,
        }
        if turn {
            self.state.reset(state::PIVOT, 3, self.pass.noise.pivot_sigma_m);
        }
        let end = stretch.samples.end - 1;
        let middle_s = 0.5 * (self.moment(stretch.samples.start).t_s + self.moment(end).t_s);
        let mut first = stretch.samples.start;
        while first < end {
            let last = self.step_end(first, end, TURN_STEP_S);
            let sums = self.sums(first, last, stretch);
            self.wander(self.moment(last).t_s, self.pass.noise.walk_in_motion);
            if turn && self.aligned && !self.bridge {
                let late = 0.5 * (self.moment(first).t_s + self.moment(last).t_s) > middle_s;
                self.observe_force(stretch, first, last, &sums, late);
            }
            self.propagate(&sums);
            first = last;
        }
    }

    pub(super) fn moment(&self, index: usize) -> &'a Moment {
        &self.pass.trajectory.moments[index]
    }

    fn step_end(&self, first: usize, end: usize, step_s: f64) -> usize {
        let limit_s = self.moment(first).t_s + step_s + 1e-6;
        let mut last = first + 1;
        while last < end && self.moment(last + 1).t_s <= limit_s {
            last += 1;
        }
        // No crumb at the end.
        if end - last < (last - first) / 2 { end } else { last }
    }

    fn wander(&mut self, now_s: f64, [gyro, accel]: [f64; 2]) {
        let dt_s = (now_s - self.last_s).max(0.0);
        self.last_s = now_s;
        self.state.wander(state::GYRO_BIAS, 3, gyro * self.pass.noise.bias_walk * dt_s);
        self.state.wander(state::ACCEL_BIAS, 3, accel * self.pass.noise.force_walk * dt_s);
    }

    fn propagate(&mut self, sums: &Sums) {
        let variance = self.pass.noise.rate_density * self.pass.noise.motion_scale * sums.duration_s;
        self.state.propagate(&sums.drive, variance, &sums.push);
    }

    fn observe_rate(&mut self, stretch: &Stretch, first: usize, last: usize, sums: &Sums, late: bool) {
        let nominal = self.pass.nominal;
        let mean = self.mean(first, last, |index| nominal.rate(&self.pass.samples[index]));
        let to_b = self.moment(first).attitude.inverse().to_rotation_matrix().into_inner();
        let residual = mean - to_b * nominal.earth;
        let variance = self.pass.noise.rate_density / sums.duration_s;
        for axis in 0..3 {
            // δM times a rate near zero is left out.
            let observation = Observation::new(residual[axis], variance)
                .with(state::GYRO_BIAS, nominal.gyro.row(axis).iter().copied())
                .with(state::EARTH, to_b.row(axis).iter().copied());
            let earth = |c: usize| match self.influences[c] {
                Influence::Earth(along, unit) => unit * to_b[(axis, along)],
                _ => sums.push[c].rate[axis],
            };
            // Earth's influence on the residual: the true rate is there, `M (raw − b) = Rᵀ Ω`.
            let whitened = self.state.observe(&observation, earth);
            self.push(whitened, Class::RestRate, axis, stretch, (first, last), late);
        }
    }

    fn observe_force(&mut self, stretch: &Stretch, first: usize, last: usize, sums: &Sums, late: bool) {
        let pass = self.pass;
        let nominal = pass.nominal;
        let gravity = pass.gravity_mps2;
        let up = Vector3::z() * gravity;
        let to_b = |index: usize| self.moment(index).attitude.inverse().to_rotation_matrix().into_inner();
        let turning = matches!(stretch.deed, Deed::Turn { .. });
        let residual = self.mean(first, last, |i| nominal.force(&pass.samples[i]) - to_b(i) * up);
        // The coefficients of δA by prediction, not as measured: noise that stands in residual and coefficient alike would
        // pass for information about elements of which nothing is known yet.
        let inverse = nominal.accel.try_inverse().unwrap_or_else(Matrix3::identity);
        let raw = inverse * self.mean(first, last, |i| to_b(i) * up);
        let tilt = self.mean_matrix(first, last, |i| to_b(i) * Vector3::z().cross_matrix() * gravity);
        let lever = self.mean_matrix(first, last, |i| lever(self.moment(i)));
        let scale = pass.force_scale.get(stretch.number).copied().unwrap_or(1.0);
        let variance = pass.noise.force_density * scale / sums.duration_s;
        let drift = if matches!(stretch.deed, Deed::Rest { .. }) { Drive::zeros() } else { tilt * sums.mean_drive };
        let class = match (turning, self.moved) {
            (true, _) => Class::TurnForce,
            (false, true) => Class::Hinge,
            (false, false) => Class::RestForce,
        };
        let late = if class == Class::Hinge { self.alternating() } else { late };
        for axis in 0..3 {
            let mut observation = Observation::new(residual[axis], variance)
                .with(state::ATTITUDE, tilt.row(axis).iter().copied())
                .with(state::ACCEL_BIAS, nominal.accel.row(axis).iter().copied())
                .with(state::ACCEL + 3 * axis, (-raw).iter().copied());
            if turning || drift != Drive::zeros() {
                observation = observation.with(state::GYRO, drift.row(axis).iter().copied());
            }
            if turning {
                observation = observation
                    .with(state::LEVER, lever.row(axis).iter().copied())
                    .with(state::PIVOT, lever.row(axis).iter().copied());
            }
            let push = |c: usize| match self.influences[c] {
                Influence::Lever(along, unit) if turning => unit * lever[(axis, along)],
                _ => sums.push[c].force[axis],
            };
            let whitened = self.state.observe(&observation, push);
            self.push(whitened, class, 3 + axis, stretch, (first, last), late);
        }
    }

    fn alternating(&mut self) -> bool {
        self.alternate = !self.alternate;
        self.alternate
    }

    /// What a face on the table tells at the end of a rest: its stop, and the plate.
    fn stand(&mut self, stretch: &Stretch) {
        let attitude = self.moment(stretch.samples.end - 1).attitude;
        let Some(face) = stretch.face() else {
            self.visit = None;
            return;
        };
        let normal_n = attitude * face.normal().cast::<f64>();
        let sigma = self.pass.noise.stop_sigma_rad;
        let span = (stretch.samples.start, stretch.samples.end - 1);
        let fresh = match self.visit.take().filter(|visit| visit.face == face) {
            None => {
                self.state.clone_heading(&normal_n, sigma);
                self.visit = Some(Visit { face, first: attitude, turned_rad: 0.0, last_turn: stretch.number });
                true
            }
            Some(mut visit) => {
                let left = (attitude * visit.first.inverse()).scaled_axis().dot(&normal_n);
                let turned = visit.turned_rad.abs();
                if turned > std::f64::consts::PI && left.abs() < f64::from(WHOLE_TURN) {
                    visit.turned_rad = 0.0;
                    let observation = Observation::new(left, sigma * sigma)
                        .with(state::ATTITUDE, (-normal_n).iter().copied())
                        .with(state::FENCE, [1.0]);
                    let turn = visit.last_turn;
                    let ends = |c: usize| match &self.influences[c] {
                        Influence::Stop(turns) => {
                            turns.iter().filter(|(stretch, _)| *stretch == turn).map(|(_, unit)| unit).sum()
                        }
                        _ => 0.0,
                    };
                    let whitened = self.state.observe(&observation, ends);
                    let late = self.alternating();
                    self.push(whitened, Class::Closure, face.axis(), stretch, span, late);
                }
                self.visit = Some(visit);
                false
            }
        };
        if let Some(facet) = self.pass.noise.facet_sigma_rad {
            if fresh {
                self.state.reset(state::FACET, 2, facet);
            }
            self.plate(stretch, face, &normal_n, span);
        }
    }

    /// `(R n)ₓᵧ = −(φ × R n)ₓᵧ + p − (R e)ₓᵧ`.
    fn plate(&mut self, stretch: &Stretch, face: Face, normal_n: &Vector3<f64>, span: (usize, usize)) {
        let attitude = self.moment(span.1).attitude;
        let along = |k: usize| attitude * Vector3::ith((face.axis() + k) % 3, 1.0);
        let cross = normal_n.cross_matrix();
        let t_s = self.moment(span.1).t_s;
        let late = self.alternating();
        for axis in 0..2 {
            let observation = Observation::new(normal_n[axis], noise::CONTACT_SIGMA_RAD.powi(2))
                .with(state::ATTITUDE, cross.row(axis).iter().copied())
                .with(state::TABLE + axis, [1.0])
                .with(state::FACET, [-along(1)[axis], -along(2)[axis]]);
            let leans = |c: usize| match self.influences[c] {
                Influence::Table(from_s, n, unit) if n == axis && t_s > from_s => unit,
                _ => 0.0,
            };
            let whitened = self.state.observe(&observation, leans);
            self.push(whitened, Class::Plate, axis, stretch, span, late);
        }
    }

    fn push(
        &mut self,
        whitened: Whitened,
        class: Class,
        channel: usize,
        stretch: &Stretch,
        (first, last): (usize, usize),
        late: bool,
    ) {
        let t_s = 0.5 * (self.moment(first).t_s + self.moment(last).t_s);
        self.at.push(Address { class, channel, stretch: stretch.number, t_s, late });
        self.values.push(whitened.value);
        self.log_sigma += whitened.sigma.ln();
        self.responses.extend(whitened.response);
    }

    fn mean(&self, first: usize, last: usize, f: impl Fn(usize) -> Vector3<f64>) -> Vector3<f64> {
        let (mut sum, mut time) = (Vector3::zeros(), 0.0);
        for index in first..last {
            let dt_s = self.moment(index + 1).t_s - self.moment(index).t_s;
            sum += (f(index) + f(index + 1)) * (0.5 * dt_s);
            time += dt_s;
        }
        sum / time
    }

    fn mean_matrix(&self, first: usize, last: usize, f: impl Fn(usize) -> Matrix3<f64>) -> Matrix3<f64> {
        let sum: Matrix3<f64> = (first..=last).map(f).sum();
        sum / (last + 1 - first) as f64
    }
}

/// `[ω×]² + [ω̇×]`.
fn lever(moment: &Moment) -> Matrix3<f64> {
    let rate = moment.rate.cross_matrix();
    rate * rate + moment.acceleration.cross_matrix()
}
