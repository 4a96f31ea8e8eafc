//! One pass of the linearised filter over the recording: rows out, every candidate's response along with them.
//!
//! The physics is that of `docs/method.md` §4, in `f64`, from samples, with force residuals in frame b:
//! `A (f − a) − Rᵀ g ẑ = −δA (f − a) + A δa + g Rᵀ (ẑ × φ) + L (l + pivot)`.

use std::ops::Range;

use nalgebra::{DMatrix, Vector3};
use tumble_core::face::Face;

use super::Pass;
use super::column::Column;
use super::data::{Deed, Stretch};
use super::influence::Influence;
use super::noise::Noise;
use super::rows::{Address, Class, Rows};
use super::state::{self, Drive, Observation, State, Whitened};
use super::step::Step;
use super::trajectory::Moment;
use super::visit::{Rested, Visit};

/// The pass's memory.
pub(super) struct Walk<'a> {
    pass: &'a Pass<'a>,
    columns: &'a [&'a Column],
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
    pub fn new(pass: &'a Pass<'a>, columns: &'a [&'a Column]) -> Self {
        let state = pass.prior.apply(State::new(columns.len()), pass.nominal);
        Self {
            pass,
            columns,
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
        let steps = self.pass.steps;
        let stretches = self.pass.stretches.iter().zip(&steps.of_stretch);
        for ((stretch, steps), levelled) in stretches.zip(&self.pass.trajectory.levelled) {
            if stretch.is_rest() {
                self.rest(stretch, steps.clone(), levelled);
            } else {
                self.motion(stretch, steps.clone());
            }
        }
        let (rows, columns) = (self.values.len(), self.columns.len());
        let responses = DMatrix::from_row_slice(rows, columns, &self.responses);
        (Rows { at: self.at, values: state::column(&self.values), responses, log_sigma: self.log_sigma }, self.state)
    }

    fn rest(&mut self, stretch: &Stretch, steps: Range<usize>, levelled: &Vector3<f64>) {
        if !self.aligned || self.bridge {
            self.begin_chain();
        } else {
            self.state.relevel(levelled);
        }
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        for index in steps {
            let step = &self.pass.steps.all[index];
            self.wander(step.middle_s, [1.0; 2]);
            if solid {
                self.observe_rate(stretch, index, step);
            }
            self.observe_force(stretch, index, step);
            // On something solid the box turns with the Earth, and so does frame n: φ stands still.
            if !solid {
                self.propagate(index, step, self.pass.noise.hand_scale);
            }
            self.wander(step.end_s, [1.0; 2]);
            self.moved = false;
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

    fn motion(&mut self, stretch: &Stretch, steps: Range<usize>) {
        self.moved = true;
        self.bridge |= stretch.broken;
        let turn = matches!(stretch.deed, Deed::Turn { .. }) && !stretch.excluded;
        match (&mut self.visit, stretch.deed) {
            (Some(visit), Deed::Turn { angle_rad, .. }) if turn => visit.turn(stretch.number, angle_rad),
            (visit, _) => *visit = None,
        }
        if turn {
            self.state.reset(state::PIVOT, 3, self.pass.noise.pivot_sigma_m);
            self.state.reset(state::SLIDE, 2, self.pass.noise.slide_rad);
        }
        let in_hand = matches!(stretch.deed, Deed::Move);
        let scale = if in_hand { self.pass.noise.hand_scale } else { self.pass.noise.turn_scale };
        for index in steps {
            let step = &self.pass.steps.all[index];
            self.wander(step.middle_s, self.pass.noise.walk_in_motion);
            if turn && self.aligned && !self.bridge {
                self.observe_force(stretch, index, step);
            }
            self.propagate(index, step, scale);
            self.wander(step.end_s, self.pass.noise.walk_in_motion);
            if turn {
                self.slide(step.duration_s);
            }
        }
    }

    fn slide(&mut self, duration_s: f64) {
        let Noise { slide_rad: sigma, slide_s, .. } = *self.pass.noise;
        if sigma > 0.0 {
            let factor = (-duration_s / slide_s).exp();
            self.state.fade(state::SLIDE, 2, factor, (1.0 - factor * factor) * sigma * sigma);
        }
    }

    fn moment(&self, index: usize) -> &'a Moment {
        &self.pass.trajectory.moments[index]
    }

    fn wander(&mut self, now_s: f64, [gyro, accel]: [f64; 2]) {
        let dt_s = (now_s - self.last_s).max(0.0);
        self.last_s = now_s;
        self.state.wander(state::GYRO_BIAS, 3, gyro * self.pass.noise.bias_walk * dt_s);
        self.state.wander(state::ACCEL_BIAS, 3, accel * self.pass.noise.force_walk * dt_s);
    }

    fn propagate(&mut self, index: usize, step: &Step, scale: f64) {
        let variance = self.pass.noise.rate_density * scale * step.duration_s;
        let columns = self.columns;
        self.state.propagate(&step.drive, variance, |c| columns[c].pushed(index).attitude);
    }

    fn observe_rate(&mut self, stretch: &Stretch, index: usize, step: &Step) {
        let columns = self.columns;
        let variance = self.pass.noise.rate_mean(step.duration_s);
        for axis in 0..3 {
            // δM times a rate near zero is left out.
            let observation = Observation::new(step.rate[axis], variance)
                .with(state::GYRO_BIAS, self.pass.nominal.gyro.row(axis).iter().copied())
                .with(state::EARTH, step.to_b.row(axis).iter().copied());
            // Earth's influence on the residual: the true rate is there, `M (raw − b) = Rᵀ Ω`.
            let push = |c: usize| match columns[c].influence {
                Influence::Earth(along, unit) => unit * step.to_b[(axis, along)],
                _ => columns[c].pushed(index).rate[axis],
            };
            let whitened = self.state.observe(&observation, push);
            self.push(whitened, Class::RestRate, axis, stretch, step.middle_s, step.late);
        }
    }

    fn observe_force(&mut self, stretch: &Stretch, index: usize, step: &Step) {
        let columns = self.columns;
        let turning = matches!(stretch.deed, Deed::Turn { .. });
        let scale = self.pass.force_scale.get(stretch.number).copied().unwrap_or(1.0);
        let variance = self.pass.noise.force_mean(step.duration_s, scale);
        let drift =
            if matches!(stretch.deed, Deed::Rest { .. }) { Drive::zeros() } else { step.tilt * step.mean_drive };
        let class = match (turning, self.moved) {
            (true, _) => Class::TurnForce,
            (false, true) => Class::Hinge,
            (false, false) => Class::RestForce,
        };
        let late = if class == Class::Hinge { self.alternating() } else { step.late };
        for axis in 0..3 {
            let mut observation = Observation::new(step.force[axis], variance)
                .with(state::ATTITUDE, step.tilt.row(axis).iter().copied())
                .with(state::ACCEL_BIAS, self.pass.nominal.accel.row(axis).iter().copied())
                .with(state::ACCEL + 3 * axis, (-step.gravity).iter().copied());
            if turning || drift != Drive::zeros() {
                observation = observation.with(state::GYRO, drift.row(axis).iter().copied());
            }
            if turning {
                observation = observation
                    .with(state::LEVER, step.lever.row(axis).iter().copied())
                    .with(state::PIVOT, step.lever.row(axis).iter().copied())
                    .with(state::SLIDE, [step.tilt[(axis, 0)], step.tilt[(axis, 1)]]);
            }
            let push = |c: usize| match columns[c].influence {
                Influence::Lever(along, unit) if turning => unit * step.lever[(axis, along)],
                _ => columns[c].pushed(index).force[axis],
            };
            let whitened = self.state.observe(&observation, push);
            self.push(whitened, class, 3 + axis, stretch, step.middle_s, late);
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
        let samples = &stretch.samples;
        let middle_s = 0.5 * (self.moment(samples.start).t_s + self.moment(samples.end - 1).t_s);
        let kept = self.visit.take().filter(|visit| visit.face == face);
        let fresh = kept.is_none();
        let mut visit = kept.unwrap_or_else(|| Visit::begin(face));
        match visit.rest(&attitude, &normal_n) {
            Rested::Closed(left, _) => self.close(&visit, left, stretch, &normal_n, middle_s),
            Rested::Between => {}
            Rested::First => self.state.clone_heading(&normal_n, self.pass.noise.stop_sigma_rad),
        }
        self.visit = Some(visit);
        if let Some(facet) = self.pass.noise.facet_sigma_rad {
            if fresh {
                self.state.reset(state::FACET, 2, facet);
            }
            self.plate(stretch, face, &normal_n, middle_s);
        }
    }

    /// Whole turns since the visit's first stop end at it.
    fn close(&mut self, visit: &Visit, left: f64, stretch: &Stretch, normal_n: &Vector3<f64>, middle_s: f64) {
        let sigma = self.pass.noise.stop_sigma_rad;
        let observation = Observation::new(left, sigma * sigma)
            .with(state::ATTITUDE, (-normal_n).iter().copied())
            .with(state::FENCE, [1.0]);
        let columns = self.columns;
        let ends = |c: usize| match &columns[c].influence {
            Influence::Stop(turns) => {
                turns.iter().filter(|(stretch, _)| *stretch == visit.last_turn).map(|(_, unit)| unit).sum()
            }
            _ => 0.0,
        };
        let whitened = self.state.observe(&observation, ends);
        let late = self.alternating();
        self.push(whitened, Class::Closure, visit.face.axis(), stretch, middle_s, late);
    }

    /// `(R n)ₓᵧ = −(φ × R n)ₓᵧ + p − (R e)ₓᵧ`.
    fn plate(&mut self, stretch: &Stretch, face: Face, normal_n: &Vector3<f64>, middle_s: f64) {
        let end = self.moment(stretch.samples.end - 1);
        let (attitude, t_s) = (end.attitude, end.t_s);
        let along = |k: usize| attitude * Vector3::ith((face.axis() + k) % 3, 1.0);
        let cross = normal_n.cross_matrix();
        let (columns, late) = (self.columns, self.alternating());
        for axis in 0..2 {
            let observation = Observation::new(normal_n[axis], self.pass.noise.contact_sigma_rad.powi(2))
                .with(state::ATTITUDE, cross.row(axis).iter().copied())
                .with(state::TABLE + axis, [1.0])
                .with(state::FACET, [-along(1)[axis], -along(2)[axis]]);
            let leans = |c: usize| match columns[c].influence {
                Influence::Table(from_s, n, unit) if n == axis && t_s > from_s => unit,
                _ => 0.0,
            };
            let whitened = self.state.observe(&observation, leans);
            self.push(whitened, Class::Plate, axis, stretch, middle_s, late);
        }
    }

    fn push(&mut self, whitened: Whitened, class: Class, channel: usize, stretch: &Stretch, t_s: f64, late: bool) {
        self.at.push(Address { class, channel, stretch: stretch.number, t_s, late });
        self.values.push(whitened.value);
        self.log_sigma += whitened.sigma.ln();
        self.responses.extend(whitened.response);
    }
}
