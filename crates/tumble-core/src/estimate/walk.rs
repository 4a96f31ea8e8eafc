//! One pass of the linearised filter over the tape, a record at a time, so that a microcontroller can do other things.

pub(super) mod still;

use heapless::Vec;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::closures::Closures;
use super::drift::Drift;
use super::facets::Facets;
use super::filter::{Filter, Innovation};
use super::group::Group;
use super::model::{self, Nominal, Observation};
use super::noise::Noise;
use super::state::Block;
use super::sums::{Excess, SegmentNoise, Sums};
use super::wobble::Wobble;
use crate::face::Face;
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

/// The pass's memory.
#[derive(Clone, Debug)]
pub struct Walk<const S: usize> {
    /// The error state.
    pub filter: Filter,
    /// Per segment.
    pub noise: Vec<SegmentNoise, S>,
    /// Over the pass.
    pub sums: Sums,
    /// What stops, faces and rates at rest say of their variances and of the bias's drift.
    pub closures: Closures,
    /// See [`Self::closures`].
    pub facets: Facets,
    /// See [`Self::closures`].
    pub drift: Drift,
    /// See [`Self::closures`].
    pub wobble: Wobble,
    /// Do turns still learn their own noise?
    pub adapting: bool,
    /// Are there faces enough for the plate to be believed?
    pub plated: bool,
    /// Is the prior still wide?
    pub coarse: bool,
    nominal: Nominal,
    /// The same with the bias as it is now.
    now: Nominal,
    /// Time since the session's middle, s.
    time_s: f32,
    gravity: f32,
    segment: usize,
    record: usize,
    attitude: UnitQuaternion<f32>,
    aligned: bool,
    table_known: bool,
    chains: u16,
    visit: Option<Visit>,
    group: Group,
    /// How much noisier its readings are than they are taken to be.
    turn_noise: Excess,
    /// What the last pass's turns had in common of that: see [`Pool::prior`](super::sums::Pool::prior).
    turn_prior: Option<(f32, f32)>,
    /// Groups of this turn since the plate was last looked at.
    unplated: u16,
    last_rest_us: u64,
    /// The move since the last rest: its segment, its length, and that rest's levelling variance, rad².
    hinge: Option<usize>,
    move_s: f32,
    level_variance: f32,
    /// The widest prior sigma of a correction or, over gravity, of the accelerometer's bias, 1.
    width: f32,
}

/// The widest sigma of a correction in a prior or, over gravity, of the accelerometer's bias, 1.
fn widest(prior: &Filter, gravity: f32) -> f32 {
    let widest = |block: Block| block.range().fold(0.0f32, |widest, i| widest.max(prior.covariance()[(i, i)]));
    let corrections = widest(Block::GyroCorrection).max(widest(Block::AccelCorrection));
    libm::sqrtf(corrections.max(widest(Block::AccelBias) / (gravity * gravity)))
}

/// A stay on one face.
#[derive(Clone, Copy, Debug)]
struct Visit {
    face: Face,
    first_stop: UnitQuaternion<f32>,
    /// Rotation since the last stop that counted, rad, and the gyroscope's variance in it, rad².
    turned_rad: f32,
    noise: f32,
    /// What the last closure left, rad.
    residual: f32,
}

impl<const S: usize> Walk<S> {
    /// Nothing walked yet; `filter` holds the prior about the nominal.
    pub fn new(nominal: Nominal, gravity: f32, filter: Filter) -> Self {
        Self {
            width: widest(&filter, gravity),
            filter,
            noise: Vec::new(),
            sums: Sums::default(),
            closures: Closures::default(),
            facets: Facets::default(),
            drift: Drift::default(),
            wobble: Wobble::default(),
            adapting: true,
            plated: true,
            coarse: true,
            nominal,
            now: nominal,
            time_s: 0.0,
            gravity,
            segment: 0,
            record: 0,
            attitude: UnitQuaternion::identity(),
            aligned: false,
            table_known: false,
            chains: 0,
            visit: None,
            group: Group::default(),
            turn_noise: Excess::default(),
            turn_prior: None,
            unplated: 0,
            last_rest_us: 0,
            hinge: None,
            move_s: 0.0,
            level_variance: 0.0,
        }
    }

    /// The parameters it linearises about.
    pub fn nominal(&self) -> &Nominal {
        &self.nominal
    }

    /// Starts the next pass about new parameters; `filter` holds the prior about them. What is known of each segment's noise stays,
    /// and whether it is still learnt. In place: a new `Walk` on the stack would take 11 KB, twice where moves are not elided.
    pub fn restart(&mut self, nominal: Nominal, prior: &Filter) {
        self.filter.clone_from(prior);
        self.width = widest(prior, self.gravity);
        self.turn_prior = self.sums.turn_noise.prior();
        (self.sums, self.closures, self.facets) = (Sums::default(), Closures::default(), Facets::default());
        (self.drift, self.wobble) = (Drift::default(), Wobble::default());
        (self.plated, self.coarse, self.aligned, self.table_known) = (true, true, false, false);
        (self.nominal, self.now, self.time_s) = (nominal, nominal, 0.0);
        (self.segment, self.record, self.chains, self.unplated) = (0, 0, 0, 0);
        (self.attitude, self.visit, self.hinge) = (UnitQuaternion::identity(), None, None);
        (self.group, self.turn_noise) = (Group::default(), Excess::default());
        (self.last_rest_us, self.move_s, self.level_variance) = (0, 0.0, 0.0);
    }

    /// The widest prior sigma of this pass, 1.
    pub fn width(&self) -> f32 {
        self.width
    }

    /// Segments walked, for a progress display.
    pub fn segments_done(&self) -> usize {
        self.segment
    }

    /// Walks up to `records` further. True when the tape is at its end.
    pub fn advance<const R: usize>(&mut self, tape: &Tape<R, S>, noise: &Noise, records: usize) -> bool {
        for _ in 0..records {
            let Some(segment) = tape.segments().get(self.segment) else { return true };
            let index = usize::from(segment.first) + self.record;
            if self.record == 0 {
                self.enter(tape, segment, noise);
            }
            if index >= usize::from(segment.end) {
                self.leave(segment, noise);
                self.segment += 1;
                self.record = 0;
                continue;
            }
            if let Some(record) = tape.record(index) {
                self.step(tape, segment, index, &record, noise);
            }
            self.record += 1;
        }
        false
    }

    fn enter<const R: usize>(&mut self, tape: &Tape<R, S>, segment: &Segment, noise: &Noise) {
        let scale = if matches!(segment.kind, Kind::OnTable { .. }) { TURN_FORCE_SCALE } else { 1.0 };
        while self.noise.len() <= self.segment {
            // As many as the tape has segments: there is room.
            let _ = self.noise.push(SegmentNoise { force_scale: scale, rate_scale: 1.0, hinge_nis: f32::NAN });
        }
        let middle_us = tape.segments().last().map_or(0, |last| (tape.segments()[0].start_us + last.end_us) / 2);
        self.time_s = (segment.start_us as i64 - middle_us as i64) as f32 * 1e-6;
        self.group = Group::default();
        self.turn_noise = Excess::default();
        self.unplated = 0;
        if segment.is_usable_still() {
            self.enter_still(tape, segment, noise);
            return;
        }
        self.hinge = self.aligned.then_some(self.segment);
        if matches!(segment.kind, Kind::OnTable { .. }) {
            (0..3).for_each(|axis| self.filter.reset(Block::Pivot, axis, 0.0, noise.pivot_sigma_m));
            (0..2).for_each(|axis| self.filter.reset(Block::Wobble, axis, 0.0, noise.wobble_sigma_rad));
        } else {
            self.end_visit();
        }
        self.move_s = 0.0;
        if matches!(segment.exclusion, Exclusion::Clipped | Exclusion::Gap) {
            self.aligned = false;
            self.hinge = None;
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
        if !self.aligned {
            return;
        }
        self.now.gyro.bias = self.nominal.gyro.bias + noise.bias_slope * (self.time_s + 0.5 * record.dt_s);
        self.time_s += record.dt_s;
        self.filter.diffuse(Block::GyroBias, noise.total_bias_walk() * record.dt_s);
        self.filter.diffuse(Block::AccelBias, noise.force_walk * record.dt_s);
        if segment.is_usable_still() {
            self.rest(segment, record, noise);
            return;
        }
        self.move_s += record.dt_s;
        let on_table = matches!(segment.kind, Kind::OnTable { .. }) && segment.exclusion == Exclusion::None;
        let slope = slope(tape, index, record);
        let lever = on_table.then(|| {
            let turn = self.now.rotation(record) / record.dt_s;
            model::lever(&turn, &(self.now.gyro.correction * slope))
        });
        self.turn(record, &slope, lever.as_ref());
        if on_table && self.group.records == GROUP {
            self.close_group(segment, noise);
        }
    }

    /// Carries the nominal attitude over a record and adds the record to the group.
    fn turn(&mut self, record: &Record, slope: &Vector3<f32>, lever: Option<&Matrix3<f32>>) {
        let rotation = self.now.rotation(record) + self.now.coning(record, slope);
        let middle = self.attitude * UnitQuaternion::from_scaled_axis(rotation * 0.5);
        let to_n = middle.to_rotation_matrix().into_inner();
        let gravity = lever.map(|lever| self.now.gravity(record, &to_n, self.gravity, lever));
        let face = self.visit.map_or_else(Vector3::zeros, |visit| to_n * visit.face.normal());
        self.group.take(&self.now.drive(record, &to_n), gravity.as_ref(), &face, record.dt_s);
        let earth = UnitQuaternion::from_scaled_axis(self.nominal.earth_rad_s * -record.dt_s);
        let next = earth * self.attitude * UnitQuaternion::from_scaled_axis(rotation);
        self.attitude = UnitQuaternion::new_normalize(next.into_inner());
    }

    fn close_group(&mut self, segment: &Segment, noise: &Noise) {
        let group = core::mem::take(&mut self.group);
        if group.records == 0 {
            return;
        }
        let density = self.rate_density(segment, noise);
        group.propagate(&mut self.filter, density);
        let own = &self.noise[self.segment];
        if matches!(segment.kind, Kind::OnTable { .. }) && segment.exclusion == Exclusion::None {
            let variance = noise.force_density / group.seconds * own.force_scale;
            let rounding = noise.force_rounding * segment.duration_s() / group.seconds;
            let innovations = group.observe(&mut self.filter, self.gravity, variance + rounding);
            innovations.iter().for_each(|innovation| self.turn_noise.take(innovation, variance));
            self.plate_in_turn(segment, &group, noise);
        }
    }

    /// Variance of a rotation per second of this move. A steady turn holds its rates as a rest does, and what rounding leaves in
    /// them is coherent: as white noise it has its variance times the turn's length. A hand's move sweeps over many steps.
    fn rate_density(&self, segment: &Segment, noise: &Noise) -> f32 {
        let own = noise.rate_density * noise.motion_scale * self.noise[self.segment].rate_scale;
        let steady = matches!(segment.kind, Kind::OnTable { .. });
        own + if steady { noise.rate_rounding * segment.duration_s() } else { 0.0 }
    }

    /// The face that a turn is made on stays in the table's plane but for a wobble. What of that does not turn with the box is
    /// coherent all the same: as white noise it must be given its variance times the number of readings, for their mean
    /// to be no surer than one.
    fn plate_in_turn(&mut self, segment: &Segment, group: &Group, noise: &Noise) {
        self.unplated += 1;
        let Some(visit) = self.visit.filter(|_| self.unplated >= PLATED && group.records == GROUP) else { return };
        self.unplated = 0;
        let (normal, since) = group.mean_face();
        let square = noise.facet_sigma_rad.is_some() && !noise.crooked;
        let known = self.plated && !self.coarse && self.table_known && square;
        if !known || !self.facets.admits(&normal) {
            return;
        }
        let readings = f32::from(segment.end - segment.first) / f32::from(GROUP * PLATED);
        let [wobble, rocking] = [noise.wobble_sigma_rad, noise.rocking_sigma_rad].map(|sigma| sigma * sigma);
        let rocking = (rocking + UNSTEADY * wobble) * readings.max(1.0);
        let loose = self.loose(segment, noise);
        let plane = visit.face.plane().map(|axis| self.attitude * axis);
        for Observation { residual, row } in model::plate_in_turn(&normal, &plane, &since) {
            let innovation = self.filter.observe(&row, residual, WHITE * WHITE + rocking);
            self.wobble.take(&innovation, rocking, loose);
        }
    }

    /// What gyroscope and gravity alone leave unknown of the attitude in a turn, rad²: `√(q r)`. That the wobble is given more variance
    /// than it has, and K a prior thirty sigma wide, makes the filter's own variances larger than errors are.
    fn loose(&self, segment: &Segment, noise: &Noise) -> f32 {
        let force = noise.force_density * self.noise[self.segment].force_scale;
        let force = force + noise.force_rounding * segment.duration_s();
        libm::sqrtf(self.rate_density(segment, noise) * force) / self.gravity
    }

    fn learn_wobble(&mut self, segment: &Segment, noise: &Noise) {
        let loose = self.loose(segment, noise);
        for index in Block::Wobble.range() {
            let (mean, variance) = (self.filter.state()[index], self.filter.covariance()[(index, index)]);
            self.wobble.take_turn(mean, variance, noise.wobble_sigma_rad * noise.wobble_sigma_rad, loose);
        }
    }

    fn leave(&mut self, segment: &Segment, noise: &Noise) {
        if let Kind::Still { face, .. } = segment.kind
            && segment.exclusion == Exclusion::None
        {
            self.leave_still(face, noise);
        }
        if self.aligned {
            self.close_group(segment, noise);
        }
        if let Kind::OnTable { angle_rad, .. } = segment.kind
            && segment.exclusion == Exclusion::None
        {
            self.learn_pivot(noise);
            self.learn_wobble(segment, noise);
            self.learn_turn_noise();
            let own = self.rate_density(segment, noise) * self.move_s;
            if let Some(visit) = &mut self.visit {
                visit.turned_rad += angle_rad;
                visit.noise += own;
            }
        }
    }

    /// In logarithms, the turn's own factor between what the turns of the last pass had in common and what it shows itself.
    fn learn_turn_noise(&mut self) {
        let Some((excess, sigma)) = self.turn_noise.value().filter(|_| self.adapting) else { return };
        let scale = &mut self.noise[self.segment].force_scale;
        // A turn of ten seconds knows its factor to a sixth; a tenth is far off, where the logarithm is no longer straight.
        let own = (1.0 + excess).max(0.1);
        let (value, variance) = (libm::logf(*scale * own), sigma * sigma / (own * own));
        self.sums.turn_noise.take(value, variance);
        let (mean, apart) = self.turn_prior.unwrap_or((value, f32::INFINITY));
        let share = if apart < f32::INFINITY { apart / (apart + variance) } else { 1.0 };
        *scale = libm::expf(mean + share * (value - mean) + 0.5 * share * variance).clamp(1.0, 1e6);
    }

    /// A pivot's estimate has variance `σ² − P` if pivots have variance σ², P being what is left of it.
    fn learn_pivot(&mut self, noise: &Noise) {
        let prior = noise.pivot_sigma_m * noise.pivot_sigma_m;
        for index in Block::Pivot.range() {
            let expected = prior - self.filter.covariance()[(index, index)];
            // A component along the axis learns nothing, and nothing is learnt from it.
            if expected > 0.1 * prior {
                let innovation = Innovation { value: self.filter.state()[index], variance: expected };
                self.sums.pivot.take(&innovation, expected / prior);
            }
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
