//! One pass of the linearised filter over the tape, a record at a time, so that a microcontroller can do other things.

pub mod pass;
pub(super) mod still;

use heapless::Vec;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use self::pass::Pass;
use super::filter::Filter;
use super::group::Group;
use super::model::{self, Nominal, Observation};
use super::noise::{Noise, PIVOT_FLOOR};
use super::stand::standing;
use super::state::Block;
use super::sums::SegmentNoise;
use super::turn_noise::TurnNoise;
use crate::tape::{Exclusion, Kind, Record, Segment, Tape};

/// Records of a turn that make one step of the filter: half a second.
pub const GROUP: u16 = 6;
/// Groups from one look at the plate to the next, 1.5 s: gyroscope and gravity together forget an attitude error in 1.7 s, so that
/// more looks would tell little more.
pub const PLATED: u16 = 3;
/// What a hand's tremor leaves in a group's mean normal, rad: 0.005° at 8–12 Hz, seen twelve times a second.
pub const WHITE: f32 = 30e-6;
/// A wobble fades in and out and has overtones: this share of the variance of what turns with the box does not.
pub const UNSTEADY: f32 = 0.25;
/// How much noisier than rest a turn is taken for before its innovations are seen.
const TURN_FORCE_SCALE: f32 = 25.0;

/// The walk's memory.
#[derive(Clone, Debug)]
pub struct Walk<const S: usize> {
    /// The error state.
    pub filter: Filter,
    /// Per segment.
    pub noise: Vec<SegmentNoise, S>,
    /// Do turns still learn their own noise?
    pub adapting: bool,
    /// What a pass begins anew with.
    pub pass: Pass,
    gravity: f32,
}

impl<const S: usize> Walk<S> {
    /// Nothing walked yet; nothing is known until [`Self::filter`] is given a prior and the first pass begun by [`Self::restart`].
    pub fn new(nominal: Nominal, gravity: f32) -> Self {
        let pass = Pass::new(nominal, 0.0, None);
        Self { filter: Filter::default(), noise: Vec::new(), adapting: true, pass, gravity }
    }

    /// The parameters it linearises about.
    pub fn nominal(&self) -> &Nominal {
        &self.pass.nominal
    }

    /// Starts the next pass about new parameters; [`Self::filter`] holds the prior about them. What is known of each segment's noise stays,
    /// and whether it is still learnt.
    pub fn restart(&mut self, nominal: Nominal) {
        let width = pass::widest(&self.filter, self.gravity);
        self.pass = Pass::new(nominal, width, self.pass.sums.turn_noise.prior());
    }

    /// The widest prior sigma of this pass, 1.
    pub fn width(&self) -> f32 {
        self.pass.width
    }

    /// Segments walked, for a progress display.
    pub fn segments_done(&self) -> usize {
        self.pass.segment
    }

    /// Walks up to `records` further. True when the tape is at its end.
    pub fn advance<const R: usize>(&mut self, tape: &Tape<R, S>, noise: &Noise, records: usize) -> bool {
        for _ in 0..records {
            let Some(segment) = tape.segments().get(self.pass.segment) else { return true };
            let index = usize::from(segment.first) + self.pass.record;
            if self.pass.record == 0 {
                self.enter(tape, segment, noise);
            }
            if index >= usize::from(segment.end) {
                self.leave(tape, segment, noise);
                self.pass.segment += 1;
                self.pass.record = 0;
                continue;
            }
            if let Some(record) = tape.record(index) {
                self.step(tape, segment, index, &record, noise);
            }
            self.pass.record += 1;
        }
        false
    }

    fn enter<const R: usize>(&mut self, tape: &Tape<R, S>, segment: &Segment, noise: &Noise) {
        let scale = if matches!(segment.kind, Kind::OnTable { .. }) { TURN_FORCE_SCALE } else { 1.0 };
        while self.noise.len() <= self.pass.segment {
            // As many as the tape has segments: there is room.
            let _ = self.noise.push(SegmentNoise { force_scale: scale, rate_scale: 1.0, hinge: None });
        }
        let (start_us, end_us) =
            tape.segments().last().map_or((0, 0), |last| (tape.segments()[0].start_us, last.end_us));
        self.pass.session_s = (end_us - start_us) as f32 * 1e-6;
        self.pass.time_s = (segment.start_us - start_us) as f32 * 1e-6 - 0.5 * self.pass.session_s;
        self.pass.group = Group::default();
        self.pass.turn_noise = TurnNoise::default();
        self.pass.unplated = 0;
        if segment.is_usable_still() {
            self.enter_still(tape, segment, noise);
            return;
        }
        self.pass.hinge = self.pass.aligned.then_some(self.pass.segment);
        self.pass.in_hand = matches!(segment.kind, Kind::Hand);
        if matches!(segment.kind, Kind::OnTable { .. }) {
            (0..3).for_each(|axis| self.filter.reset(Block::Pivot, axis, 0.0, noise.pivot_sigma_m));
            (0..2).for_each(|axis| self.filter.reset(Block::Wobble, axis, 0.0, noise.wobble_sigma_rad));
        } else {
            self.end_visit();
        }
        self.pass.move_s = 0.0;
        if matches!(segment.exclusion, Exclusion::Clipped | Exclusion::Gap | Exclusion::BiasJump) {
            self.pass.aligned = false;
            self.pass.hinge = None;
            self.end_visit();
        }
    }

    fn step<const R: usize>(
        &mut self,
        tape: &Tape<R, S>,
        segment: &Segment,
        index: usize,
        record: &Record,
        noise: &Noise,
    ) {
        if !self.pass.aligned {
            return;
        }
        self.pass.now.gyro.bias = self.pass.nominal.gyro.bias
            + noise.bias_slope * (self.pass.time_s + 0.5 * record.dt_s)
            + noise.g_sensitivity * self.pass.nominal.force(record);
        self.pass.time_s += record.dt_s;
        self.filter.diffuse(Block::GyroBias, noise.total_bias_walk() * record.dt_s);
        self.filter.diffuse(Block::AccelBias, noise.force_walk * record.dt_s);
        if segment.is_usable_still() {
            self.rest(segment, record, noise);
            return;
        }
        self.pass.move_s += record.dt_s;
        let on_table = matches!(segment.kind, Kind::OnTable { .. }) && segment.exclusion == Exclusion::None;
        let slope = slope(tape, index, record);
        let lever = on_table.then(|| {
            let turn = self.pass.now.rotation(record) / record.dt_s;
            model::lever(&turn, &(self.pass.now.gyro.correction * slope), record.dt_s)
        });
        self.turn(record, &slope, lever.as_ref());
        if on_table && self.pass.group.records == GROUP {
            self.close_group(segment, noise);
        }
    }

    /// Carries the nominal attitude over a record and adds the record to the group.
    fn turn(&mut self, record: &Record, slope: &Vector3<f32>, lever: Option<&Matrix3<f32>>) {
        let rotation = self.pass.now.rotation(record) + self.pass.now.coning(record, slope);
        let middle = self.pass.attitude * UnitQuaternion::from_scaled_axis(rotation * 0.5);
        let to_n = middle.to_rotation_matrix().into_inner();
        let gravity = lever.map(|lever| self.pass.now.gravity_in_turn(record, &rotation, &to_n, self.gravity, lever));
        self.pass.group.take(&self.pass.now.drive(record, &to_n), gravity.as_ref(), &to_n, record.dt_s);
        let earth = UnitQuaternion::from_scaled_axis(self.pass.nominal.earth_rad_s * -record.dt_s);
        let next = earth * self.pass.attitude * UnitQuaternion::from_scaled_axis(rotation);
        self.pass.attitude = UnitQuaternion::new_normalize(next.into_inner());
    }

    fn close_group(&mut self, segment: &Segment, noise: &Noise) {
        let group = core::mem::take(&mut self.pass.group);
        if group.records == 0 {
            return;
        }
        // What a Wiener process adds over a group, its mean shares with the end by a half: half of the noise is there before the mean is
        // looked at, half comes after. (Of itself the mean has a third. The sixth too much is 1 % of a gravity reading's variance, and
        // leaves K's sigma 2 % wider by the plate's: docs/method.md, "Against the batch solution".)
        let half = 0.5 * self.rate_density(segment, noise) * group.seconds;
        group.propagate(&mut self.filter, half);
        let own = &self.noise[self.pass.segment];
        if matches!(segment.kind, Kind::OnTable { .. }) && segment.exclusion == Exclusion::None {
            let variance = noise.force_density / group.seconds * own.force_scale;
            let rounding = noise.force_rounding * segment.duration_s() / group.seconds;
            let innovations = group.observe(&mut self.filter, self.gravity, variance + rounding);
            self.pass.turn_noise.take(&innovations, variance);
            self.plate_in_turn(segment, &group, noise);
        }
        self.filter.diffuse(Block::Attitude, half);
    }

    /// Variance of a rotation per second of this move. A steady turn holds its rates as a rest does, and what rounding leaves in
    /// them is coherent: as white noise it has its variance times the turn's length. A hand's move sweeps over many steps.
    fn rate_density(&self, segment: &Segment, noise: &Noise) -> f32 {
        let own = noise.rate_density * noise.moving(segment) * self.noise[self.pass.segment].rate_scale;
        let steady = matches!(segment.kind, Kind::OnTable { .. });
        own + if steady { noise.rate_rounding * segment.duration_s() } else { 0.0 }
    }

    /// The face that a turn is made on stays in the table's plane but for a wobble. What of that does not turn with the box is
    /// coherent all the same: as white noise it must be given its variance times the number of readings, for their mean
    /// to be no surer than one.
    fn plate_in_turn(&mut self, segment: &Segment, group: &Group, noise: &Noise) {
        self.pass.unplated += 1;
        let Some(visit) = self.pass.visit.filter(|_| self.pass.unplated >= PLATED && group.records == GROUP) else {
            return;
        };
        self.pass.unplated = 0;
        let (to_n, since) = group.mean_attitude();
        let normal = to_n * visit.face.normal();
        let boxed = noise.facet_sigma_rad.is_some();
        let known = self.pass.plated && !self.pass.coarse && self.pass.table_known && boxed;
        if !known || !self.pass.facets.admits(&normal) {
            return;
        }
        let readings = f32::from(segment.end - segment.first) / f32::from(GROUP * PLATED);
        let [wobble, rocking] = [noise.wobble_sigma_rad, noise.rocking_sigma_rad].map(|sigma| sigma * sigma);
        let rocking = (rocking + UNSTEADY * wobble) * readings.max(1.0);
        let loose = self.loose(segment, noise);
        let plane = visit.face.plane().map(|axis| to_n * axis);
        for Observation { residual, row } in model::plate_in_turn(&normal, &plane, &since) {
            let innovation = self.filter.observe(&row, residual, WHITE * WHITE + rocking);
            self.pass.wobble.take(&innovation, rocking, loose);
        }
    }

    /// What gyroscope and gravity alone leave unknown of the attitude in a turn, rad²: `√(q r)`. That the wobble is given more variance
    /// than it has, and K a prior thirty sigma wide, makes the filter's own variances larger than errors are.
    fn loose(&self, segment: &Segment, noise: &Noise) -> f32 {
        let force = noise.force_density * self.noise[self.pass.segment].force_scale;
        let force = force + noise.force_rounding * segment.duration_s();
        libm::sqrtf(self.rate_density(segment, noise) * force) / self.gravity
    }

    fn learn_wobble(&mut self, segment: &Segment, noise: &Noise) {
        let loose = self.loose(segment, noise);
        for index in Block::Wobble.range() {
            let (mean, variance) = (self.filter.state()[index], self.filter.covariance()[(index, index)]);
            self.pass.wobble.take_turn(mean, variance, noise.wobble_sigma_rad * noise.wobble_sigma_rad, loose);
        }
    }

    fn leave<const R: usize>(&mut self, tape: &Tape<R, S>, segment: &Segment, noise: &Noise) {
        if segment.is_usable_still() {
            self.leave_still(standing(tape.segments(), self.pass.segment), noise);
        }
        if self.pass.aligned {
            self.close_group(segment, noise);
        }
        if let Kind::OnTable { angle_rad, .. } = segment.kind
            && segment.exclusion == Exclusion::None
        {
            self.learn_pivot(noise);
            self.learn_wobble(segment, noise);
            self.learn_turn_noise();
            let own = self.rate_density(segment, noise) * self.pass.move_s;
            if let Some(visit) = &mut self.pass.visit {
                visit.turned_rad += angle_rad;
                visit.noise += own;
            }
        }
    }

    /// The turn's own factor between what the turns of the last pass had in common and what it shows itself; never quieter than rest.
    fn learn_turn_noise(&mut self) {
        let Some((excess, variance)) = self.pass.turn_noise.value().filter(|_| self.adapting) else { return };
        let scale = &mut self.noise[self.pass.segment].force_scale;
        let value = *scale * (1.0 + excess);
        self.pass.sums.turn_noise.take(value, variance);
        let (mean, apart) = self.pass.turn_prior.unwrap_or((value, 0.0));
        *scale = (mean + apart / (apart + variance) * (value - mean)).clamp(1.0, 1e6);
    }

    fn learn_pivot(&mut self, noise: &Noise) {
        let prior = noise.pivot_sigma_m * noise.pivot_sigma_m;
        for index in Block::Pivot.range() {
            let (mean, variance) = (self.filter.state()[index], self.filter.covariance()[(index, index)]);
            self.pass.sums.pivot.take_state(mean, variance, prior, f32::INFINITY, PIVOT_FLOOR);
        }
    }
}

/// Slope of the raw rate over a record and its neighbours, rad/s².
fn slope<const R: usize, const S: usize>(tape: &Tape<R, S>, index: usize, record: &Record) -> Vector3<f32> {
    let rate = |record: &Record| record.rotation_rad / record.dt_s;
    let before = index.checked_sub(1).and_then(|index| tape.record(index)).unwrap_or(*record);
    let after = tape.record(index + 1).unwrap_or(*record);
    let span = 0.5 * (before.dt_s + after.dt_s) + record.dt_s;
    (rate(&after) - rate(&before)) / span
}
