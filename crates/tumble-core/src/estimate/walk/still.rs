//! What a rest tells: gravity, the resting rate, the plate and the fence.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::Walk;
use super::pass::Visit;
use crate::estimate::facets::Facets;
use crate::estimate::hinge::Hinge;
use crate::estimate::model::{self, Observation};
use crate::estimate::noise::{self, Noise, ROUNDED};
use crate::estimate::scatter::scatter;
use crate::estimate::state::Block;
use crate::face::Face;
use crate::motion::path::{NUDGE, WHOLE_TURN};
use crate::tape::{ANGLE_UNIT_RAD, FORCE_UNIT_MPS2, Record, Segment, Tape};

/// A face's contact with the table is taken for no better than this share of the prior's sigma: `f32` resolves a 6e-8th of a
/// variance, which is 15 µrad beside 0.06, and thirty roundings' worth of that is 80.
const RESOLVED: f32 = 1.0 / 600.0;
/// Prior of one component of the Earth's rotation, rad/s (its whole is 7.29e-5).
pub(in crate::estimate) const EARTH_SIGMA: f32 = 5e-5;
/// Level error of an attitude taken from an uncalibrated accelerometer, rad (80 mg of offset, sheet).
const LEVEL_SIGMA: f32 = 0.1;
/// A record at rest whose rate is further than this from the rest's own is no rest: noise does that once in 5000 sessions of 300 numbers.
const UNSTEADY_SIGMAS: f32 = 5.0;
/// The level's prior in sigmas of the rest's own noise: as wide as `prior::narrow` makes the others.
const LEVEL_WIDTH: f32 = 30.0;

impl<const S: usize> Walk<S> {
    pub(super) fn enter_still<const R: usize>(&mut self, tape: &Tape<R, S>, segment: &Segment, noise: &Noise) {
        let (first, end) = (usize::from(segment.first), usize::from(segment.end));
        let force = crate::motion::means::mean_force(tape, first, end);
        let solid = noise::is_solid(segment, noise.quiet_variance);
        if !solid {
            let own = scatter(tape, segment).force / noise.force_density;
            self.noise[self.pass.segment].force_scale = own.max(1.0);
        }
        let (scale, duration_s) = (self.noise[self.pass.segment].force_scale, segment.duration_s());
        let own = noise.force_density * scale / duration_s + noise.force_rounding;
        let variance = own / (self.gravity * self.gravity);
        let force = self.pass.nominal.accel.compensate(&force);
        self.level(&force, variance, duration_s, noise);
        if solid {
            self.compare(tape, segment, &force, own, noise);
        }
    }

    /// What a rest's means say of biases that drift and wander: its specific force, `own` the variance of a component.
    fn compare<const R: usize>(
        &mut self,
        tape: &Tape<R, S>,
        segment: &Segment,
        force: &Vector3<f32>,
        own: f32,
        noise: &Noise,
    ) {
        let (first, end, duration_s) = (usize::from(segment.first), usize::from(segment.end), segment.duration_s());
        let records = || (first..end).filter_map(|index| tape.record(index));
        let noisiest = records().map(|record| rate_variance(&record, noise)).fold(0.0, f32::max);
        let limit = UNSTEADY_SIGMAS * libm::sqrtf(noisiest);
        self.pass.steady = (crate::motion::means::mean_rate(tape, first, end), limit);
        let (sum, time_s) = records()
            .filter(|record| self.is_steady(record))
            .fold((Vector3::zeros(), 0.0), |(sum, time_s), record| (sum + record.rotation_rad, time_s + record.dt_s));
        let t_s = self.pass.time_s + 0.5 * duration_s;
        if time_s > 0.0 {
            let to_b = self.pass.attitude.to_rotation_matrix().into_inner().transpose();
            let left = sum / time_s - self.pass.nominal.gyro.bias;
            let variance = noise.rate_density / time_s + noise.rate_rounding;
            let anew = self.pass.visit.is_none();
            self.pass.resting.take((&left, variance), &to_b, t_s, &(force / self.gravity), anew);
            let left = left - to_b * self.pass.nominal.earth_rad_s;
            for (walk, account) in self.pass.rate_walks.iter_mut().zip(&self.pass.accounts) {
                if let Some(account) = account {
                    walk.take(&(left - account.rate(t_s, force)).into(), variance, t_s);
                }
            }
        }
        // On another face every number of the accelerometer is another.
        if self.pass.visit.is_none() {
            self.pass.force_walk.restart();
        }
        self.pass.force_walk.take(&[force.norm() - self.gravity], own, t_s);
    }

    /// Does a record show the rest's own rate? A hand's last touch may be slower than what ends a rest.
    fn is_steady(&self, record: &Record) -> bool {
        let (mean, limit) = self.pass.steady;
        (record.rotation_rad / record.dt_s - mean).amax() < limit
    }

    /// What a face on the table tells, after its gravity has narrowed the attitude: a plate is so sharp an observation
    /// that against a wide covariance it would be lost in `f32`.
    pub(super) fn leave_still(&mut self, face: Option<Face>, noise: &Noise) {
        if let Some(face) = face {
            self.plate(face, noise);
            self.stop(face, noise);
        } else {
            self.end_visit();
        }
    }

    /// Its closures are counted.
    pub(super) fn end_visit(&mut self) {
        self.pass.visit = None;
        self.pass.closures.end_visit();
    }

    /// Turns the nominal attitude so that it agrees with gravity: the shift is known, so nothing is fed back into the
    /// linearisation but the still's own noise (0.1 mrad, whose square is nothing).
    ///
    /// What is expected of the move before has what biases that walk make of it: the nominal attitude is carried with the nominal bias, about
    /// which a walk has a mean square of q T/6. The accelerometer's is another at each rest: on the same face by what it has walked since; in
    /// another pose it leans another way, and both rests are off the nominal one, which is the last pass's at its end, by q T/2 in the mean.
    fn level(&mut self, force: &Vector3<f32>, variance: f32, duration_s: f32, noise: &Noise) {
        let turn = model::levelling(&(self.pass.attitude * force));
        self.pass.attitude = UnitQuaternion::new_normalize((turn * self.pass.attitude).into_inner());
        let before = core::mem::replace(&mut self.pass.level_variance, variance);
        if !self.pass.aligned {
            self.align();
            return;
        }
        let turn = turn.scaled_axis();
        self.filter.shift(Block::Attitude, &-turn);
        if let Some(hinge) = self.pass.hinge.take() {
            let move_s = self.pass.move_s;
            let session_s = self.pass.session_s;
            let apart_s = if self.pass.in_hand { session_s } else { move_s + duration_s };
            let walked = noise.total_bias_walk() * session_s / 6.0 * move_s * move_s
                + noise.force_walk * apart_s / (self.gravity * self.gravity);
            let moved = noise.rate_density * move_s;
            let [square, level, walked] = [turn.norm_squared(), before + variance, walked].map(|part| part / moved);
            self.noise[hinge].hinge = Some(Hinge { square, level, walked, in_hand: self.pass.in_hand });
        }
    }

    /// Starts anew: heading is zero here by definition, and what is known in frame n is known no longer.
    fn align(&mut self) {
        self.pass.aligned = true;
        // No wider than what it was levelled by: the accelerometer under this pass's prior, and the rest's own noise.
        let own = LEVEL_WIDTH * libm::sqrtf(self.pass.level_variance);
        let level = libm::hypotf(2.0 * self.pass.width, own).min(LEVEL_SIGMA);
        self.filter.reset(Block::Attitude, 0, 0.0, level);
        self.filter.reset(Block::Attitude, 1, 0.0, level);
        self.filter.reset(Block::Attitude, 2, 0.0, 0.0);
        self.pass.table_known = false;
        self.pass.chains += 1;
        if self.pass.chains > 1 {
            // The first still's heading is lost, and with it where the Earth's rotation points.
            self.pass.nominal.earth_rad_s = Vector3::zeros();
            self.pass.agreed |= self.pass.facets.agree_or_not();
            self.pass.facets = Facets::default();
        }
        for axis in 0..3 {
            self.filter.reset(Block::Earth, axis, -self.pass.nominal.earth_rad_s[axis], EARTH_SIGMA);
        }
        self.filter.reset(Block::Fence, 0, 0.0, 0.0);
    }

    fn plate(&mut self, face: Face, noise: &Noise) {
        let Some(sigma) = noise.facet_sigma_rad else { return };
        let normal = self.pass.attitude * face.normal();
        if !self.pass.facets.admits(&normal) {
            return;
        }
        let anew = self.pass.visit.is_none_or(|visit| visit.face != face);
        // By the nominal alone, which is levelled by this rest: the state is still under its wide prior on the first faces.
        let to_n = self.pass.attitude.to_rotation_matrix().into_inner();
        // A bias that walks is off by q T/6 about its own mean, which leans what is levelled by it.
        let walked = noise.force_walk * self.pass.session_s / (6.0 * self.gravity * self.gravity);
        let level = self.pass.level_variance + walked;
        self.pass.facets.take(anew, &face.normal(), &to_n, level, [sigma, noise.contact_sigma_rad]);
        if anew {
            (0..2).for_each(|axis| self.filter.reset(Block::Facet, axis, 0.0, sigma));
        }
        let plane = face.plane().map(|axis| self.pass.attitude * axis);
        let contact = noise.contact_sigma_rad.max(RESOLVED * self.pass.width);
        let variance = contact * contact;
        if !self.pass.plated {
            return;
        }
        let plate = model::plate(&normal, &plane);
        for (axis, Observation { residual, row }) in plate.into_iter().enumerate() {
            if self.pass.table_known {
                self.filter.observe(&row.negated().with(Block::Table, axis, 1.0), residual, variance);
            } else {
                self.filter.copy_to(Block::Table, axis, &row, residual, variance);
            }
        }
        self.pass.table_known = true;
    }

    fn stop(&mut self, face: Face, noise: &Noise) {
        let normal = self.pass.attitude * face.normal();
        let variance = noise.stop_sigma_rad * noise.stop_sigma_rad;
        if let Some(visit) = self.pass.visit.as_mut().filter(|visit| visit.face == face) {
            let turned = libm::fabsf(visit.turned_rad);
            let observation = model::fence(&self.pass.attitude, &visit.first_stop, &normal);
            if turned > core::f32::consts::PI && libm::fabsf(observation.residual) < WHOLE_TURN {
                let whole = libm::roundf(visit.turned_rad / core::f32::consts::TAU) * core::f32::consts::TAU;
                let own = core::mem::take(&mut visit.noise);
                visit.turned_rad = 0.0;
                let left = observation.residual - core::mem::replace(&mut visit.residual, observation.residual);
                self.pass.closures.take(face.axis(), -whole, left, own, variance);
                self.close(&observation, variance);
            }
            // Between a nudge, which may have left the fence, and a whole turn lies a turn made in steps.
            if turned > NUDGE {
                return;
            }
        }
        self.end_visit();
        self.filter.copy_to(Block::Fence, 0, &model::heading(&normal), 0.0, variance);
        self.pass.visit =
            Some(Visit { face, first_stop: self.pass.attitude, turned_rad: 0.0, noise: 0.0, residual: 0.0 });
    }

    fn close(&mut self, observation: &Observation, variance: f32) {
        self.filter.observe(&observation.row, observation.residual, variance);
        self.pass.sums.closed.0 += observation.residual * observation.residual;
        self.pass.sums.closed.1 += 1.0;
    }

    pub(super) fn rest(&mut self, segment: &Segment, record: &Record, noise: &Noise) {
        let solid = noise::is_solid(segment, noise.quiet_variance) && self.is_steady(record);
        if !solid {
            self.turn(record, &Vector3::zeros(), None);
            let variance = noise.rate_density * record.dt_s;
            core::mem::take(&mut self.pass.group).propagate(&mut self.filter, variance);
        }
        let to_n = self.pass.attitude.to_rotation_matrix().into_inner();
        let own = noise.force_density / record.dt_s * self.noise[self.pass.segment].force_scale;
        // Coherent over the rest: as white noise it has its variance times the number of records.
        let rounding = noise.force_rounding * segment.duration_s() / record.dt_s;
        let variance = own + rounding + ROUNDED * FORCE_UNIT_MPS2 * FORCE_UNIT_MPS2;
        let parts = self.pass.now.gravity(record, &to_n, self.gravity, &Matrix3::zeros());
        let observation = parts.observation(self.gravity, None);
        let innovations = self.filter.observe_vector(&observation.rows, &observation.residual, variance);
        if self.pass.record > 0 {
            for innovation in &innovations {
                self.pass.sums.rest.0 += innovation.nis();
                self.pass.sums.rest.1 += 1.0;
            }
        }
        if solid {
            self.rest_rate(record, &to_n.transpose(), noise);
        }
    }

    fn rest_rate(&mut self, record: &Record, to_b: &Matrix3<f32>, noise: &Noise) {
        let variance = rate_variance(record, noise) + noise.rate_rounding * noise.solid_s / record.dt_s;
        let observation = self.pass.now.rest_rate(record, to_b);
        self.filter.observe_vector(&observation.rows, &observation.residual, variance);
    }
}

/// Of a record's mean rate, (rad/s)².
fn rate_variance(record: &Record, noise: &Noise) -> f32 {
    let rounded = ANGLE_UNIT_RAD / record.dt_s;
    noise.rate_density / record.dt_s + ROUNDED * rounded * rounded
}
