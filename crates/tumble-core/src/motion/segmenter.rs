//! Cuts the stream into stills and what lies between, onto the tape, and tells the procedure.
//!
//! A still is confirmed by three quiet blocks in a row and ends with the first that is not. The block next to either edge
//! counts as motion: a turn's tail taken for rest moved one published tool's scale by 0.7 % (`design.md` §2).

use heapless::Vec;
use nalgebra::Vector3;

use super::block::{Accumulator, Block, Completed};
use super::means::{mean_force, mean_rate};
use super::path::{ON_TABLE, trace};
use super::standstill::{Standstill, strike_turns};
use super::stillness::{Excess, Stillness};
use super::{MotionEvent, RevolutionCheck};
use crate::DEGREE_RAD;
use crate::face::Face;
use crate::sample::Sample;
use crate::tape::{Exclusion, Full, Kind, Segment, Tape};

/// Quiet blocks that confirm a still.
const CONFIRM_BLOCKS: u32 = 3;
/// A merged record at rest, s.
const REST_RECORD_S: f32 = 0.45;
/// A block that is quiet but for its mean rate proves earlier "rests" to have been steady turns after this many.
const DISPROOF_BLOCKS: u32 = 6;

/// A gyroscope feels less between two faces, rad/s: ten times the 0.1 °/s a g of a sibling's sheet, either way.
const MOST_FELT: f32 = 2.0 * DEGREE_RAD;

/// What one sample tells.
pub type Events = Vec<MotionEvent, 6>;

#[derive(Clone, Copy, Debug)]
enum State {
    Moving { quiet: u32, candidate_first: usize, candidate_us: u64 },
    Still { blocks: u32, pending_first: usize, pending_us: u64, variance_sum: f32 },
}

/// The stream's state. It writes to a [`Tape`] that is handed to each call.
#[derive(Clone, Debug)]
pub struct Segmenter {
    accumulator: Accumulator,
    stillness: Stillness,
    standstill: Standstill,
    state: State,
    first: usize,
    start_us: u64,
    started: bool,
    clipped: u8,
    clipped_samples: u16,
    block_first: usize,
    block_start_us: u64,
    moving_blocks: u32,
    disproof: u32,
    jumped: bool,
    last_up: Option<Vector3<f32>>,
    visit: RevolutionCheck,
    full: bool,
}

impl Segmenter {
    /// `tolerance` as in [`Stillness::new`].
    pub const fn new(tolerance: f32) -> Self {
        Self {
            accumulator: Accumulator::new(),
            stillness: Stillness::new(tolerance),
            standstill: Standstill::new(),
            state: State::Moving { quiet: 0, candidate_first: 0, candidate_us: 0 },
            first: 0,
            start_us: 0,
            started: false,
            clipped: 0,
            clipped_samples: 0,
            block_first: 0,
            block_start_us: 0,
            moving_blocks: 0,
            disproof: 0,
            jumped: false,
            last_up: None,
            visit: RevolutionCheck::new(),
            full: false,
        }
    }

    /// Ends the still or move in progress and starts another of the same kind: what lies before can be struck out.
    pub fn cut<const R: usize, const S: usize>(&mut self, tape: &mut Tape<R, S>) {
        if let State::Still { pending_us, pending_first, .. } = self.state
            && self.close_still(tape, pending_us).is_ok()
        {
            // Two more blocks confirm the new one.
            self.state = State::Moving { quiet: 1, candidate_first: pending_first, candidate_us: pending_us };
        }
        self.visit = RevolutionCheck::default();
    }

    /// Empties the tape of all but the still or move in progress: nobody is recording.
    pub fn drop_closed<const R: usize, const S: usize>(&mut self, tape: &mut Tape<R, S>) {
        let dropped = self.first;
        if dropped == 0 {
            return;
        }
        tape.drop_front(dropped);
        self.first = 0;
        self.block_first -= dropped;
        match &mut self.state {
            State::Moving { candidate_first, .. } => *candidate_first = candidate_first.saturating_sub(dropped),
            State::Still { pending_first, .. } => *pending_first -= dropped,
        }
    }

    /// The resting rate of the last still, rad/s.
    pub fn resting_rate(&self) -> Option<Vector3<f32>> {
        self.stillness.resting_rate()
    }

    /// Takes one sample. `clipped`: channels at an end of their range, as in [`Segment::clipped`].
    pub fn step<const R: usize, const S: usize>(
        &mut self,
        sample: &Sample,
        clipped: u8,
        tape: &mut Tape<R, S>,
    ) -> Events {
        let mut events = Events::new();
        if !self.started {
            self.started = true;
            self.start_us = sample.t_us;
            self.block_start_us = sample.t_us;
        }
        tape.grain.see(sample);
        let less_jump =
            Sample { angular_rate_rad_s: sample.angular_rate_rad_s - tape.bias_jumps.total_rad_s, ..*sample };
        let completed = self.accumulator.push(&less_jump, clipped);
        if let Some(gap_s) = completed.gap_s {
            self.gap(sample, gap_s, tape, &mut events);
        }
        if self.take(&completed, tape, &mut events).is_err() && !self.full {
            self.full = true;
            let _ = events.push(MotionEvent::TapeFull);
        }
        events
    }

    /// Ends the stream: closes the still or move that is open.
    pub fn finish<const R: usize, const S: usize>(&mut self, tape: &mut Tape<R, S>) {
        let end_us = match self.state {
            State::Still { pending_us, .. } => pending_us,
            State::Moving { candidate_us, .. } => candidate_us.max(self.start_us),
        };
        let closed = match self.state {
            State::Still { .. } => self.close_still(tape, end_us).map(|_| ()),
            State::Moving { .. } => Ok(()),
        };
        self.full |= closed.is_err();
        self.state = State::Moving { quiet: 0, candidate_first: tape.len(), candidate_us: end_us };
    }

    fn take<const R: usize, const S: usize>(
        &mut self,
        completed: &Completed,
        tape: &mut Tape<R, S>,
        events: &mut Events,
    ) -> Result<(), Full> {
        if let Some(record) = &completed.record {
            tape.push(record)?;
        }
        let Some(block) = &completed.block else { return Ok(()) };
        let excess = self.stillness.judge(block, matches!(self.state, State::Still { .. }));
        let rest = self.stillness.resting_rate();
        match self.standstill.step(block, self.block_start_us, &excess, rest) {
            Some(by) => self.rests_otherwise(&by, block, tape),
            None => self.disprove(block, &excess, tape),
        }
        let result = match self.state {
            State::Moving { .. } => self.while_moving(block, &excess, tape, events),
            State::Still { .. } => self.while_still(block, &excess, tape, events),
        };
        // A block ends with a record.
        if let Some(rate) = self.stillness.resting_rate() {
            self.accumulator.set_resting_rate(rate);
        }
        self.block_first = tape.len();
        self.block_start_us = block.end_us;
        result
    }

    fn while_moving<const R: usize, const S: usize>(
        &mut self,
        block: &Block,
        excess: &Excess,
        tape: &mut Tape<R, S>,
        events: &mut Events,
    ) -> Result<(), Full> {
        let State::Moving { mut quiet, mut candidate_first, mut candidate_us } = self.state else { return Ok(()) };
        self.clipped |= block.clipped;
        self.clipped_samples = self.clipped_samples.saturating_add(block.clipped_samples);
        self.moving_blocks += 1;
        if self.moving_blocks.is_multiple_of(2) {
            let _ = events.push(MotionEvent::Moving { excess: excess.of_entering() });
        }
        if excess.of_entering() > 1.0 {
            self.state = State::Moving { quiet: 0, candidate_first, candidate_us };
            return Ok(());
        }
        quiet += 1;
        if quiet == 1 {
            // The first quiet block is an edge: the still begins with the second.
            candidate_first = tape.len();
            candidate_us = block.end_us;
        }
        self.state = State::Moving { quiet, candidate_first, candidate_us };
        if quiet < CONFIRM_BLOCKS {
            return Ok(());
        }
        self.confirm(block, candidate_first, candidate_us, tape, events)
    }

    /// Closes the move before and opens a still.
    fn confirm<const R: usize, const S: usize>(
        &mut self,
        block: &Block,
        first: usize,
        start_us: u64,
        tape: &mut Tape<R, S>,
        events: &mut Events,
    ) -> Result<(), Full> {
        let up = mean_force(tape, first, tape.len());
        let face = Face::from_specific_force(&up);
        let resting = self.stillness.resting_rate().unwrap_or(block.mean_rate);
        let path = self.last_up.map(|from| trace(tape, self.first..first, &resting, &from, &up));
        let jumped = core::mem::take(&mut self.jumped);
        if jumped {
            self.visit = RevolutionCheck::default();
        }
        let kind = match (path, face) {
            (Some(path), Some(face)) if path.on_table && !jumped => Kind::OnTable { face, angle_rad: path.angle_rad },
            _ => Kind::Hand,
        };
        self.close(tape, kind, first, start_us)?;
        if jumped && let Some(segment) = tape.segments_mut().last_mut() {
            segment.exclusion = Exclusion::BiasJump;
        }
        let _ = events.push(MotionEvent::StillBegan { face });
        if let Some(event) = self.visit.arrive(&kind, face) {
            let _ = events.push(event);
        }
        self.last_up = Some(up);
        tape.merge(first, tape.len() - self.block_first);
        self.state = State::Still {
            blocks: 2,
            pending_first: first + 1,
            pending_us: self.block_start_us,
            variance_sum: 2.0 * block.rate_variance,
        };
        Ok(())
    }

    fn while_still<const R: usize, const S: usize>(
        &mut self,
        block: &Block,
        excess: &Excess,
        tape: &mut Tape<R, S>,
        events: &mut Events,
    ) -> Result<(), Full> {
        let State::Still { blocks, pending_first, pending_us, variance_sum } = self.state else { return Ok(()) };
        if excess.of_leaving() > 1.0 {
            let (face, held_s) = self.close_still(tape, pending_us)?;
            self.clipped = block.clipped;
            self.clipped_samples = block.clipped_samples;
            self.moving_blocks = 0;
            self.state = State::Moving { quiet: 0, candidate_first: tape.len(), candidate_us: block.end_us };
            let _ = events.push(MotionEvent::StillEnded { face, held_s });
            return Ok(());
        }
        tape.grain.rest(block);
        let new_first = self.merge_pending(tape, pending_first);
        self.state = State::Still {
            blocks: blocks + 1,
            pending_first: new_first,
            pending_us: self.block_start_us,
            variance_sum: variance_sum + block.rate_variance,
        };
        if blocks.is_multiple_of(2) {
            let up = mean_force(tape, self.first, tape.len());
            let held_s = (block.end_us - self.start_us) as f32 * 1e-6;
            let _ = events.push(MotionEvent::StillHeld { face: Face::from_specific_force(&up), held_s });
        }
        Ok(())
    }

    /// Turns the block before, now known to be rest, into half-second records; the newest block stays fine-grained.
    fn merge_pending<const R: usize, const S: usize>(&self, tape: &mut Tape<R, S>, pending_first: usize) -> usize {
        let newest = tape.len() - self.block_first;
        let short = pending_first > self.first
            && tape.record(pending_first - 1).is_some_and(|record| record.dt_s < REST_RECORD_S);
        tape.merge(if short { pending_first - 1 } else { pending_first }, newest);
        tape.len() - newest
    }

    fn close_still<const R: usize, const S: usize>(
        &mut self,
        tape: &mut Tape<R, S>,
        end_us: u64,
    ) -> Result<(Option<Face>, f32), Full> {
        let State::Still { blocks, pending_first, variance_sum, .. } = self.state else { return Err(Full) };
        let up = mean_force(tape, self.first, pending_first);
        let face = Face::from_specific_force(&up);
        let held_s = (end_us - self.start_us) as f32 * 1e-6;
        self.last_up = Some(up);
        self.stillness.set_resting_rate(mean_rate(tape, self.first, pending_first));
        self.clipped = 0;
        self.clipped_samples = 0;
        let rate_variance = variance_sum / blocks as f32;
        tape.grain.end_rest(rate_variance);
        self.close(tape, Kind::Still { face, rate_variance }, pending_first, end_us)?;
        Ok((face, held_s))
    }

    fn close<const R: usize, const S: usize>(
        &mut self,
        tape: &mut Tape<R, S>,
        kind: Kind,
        end: usize,
        end_us: u64,
    ) -> Result<(), Full> {
        let exclusion = if self.clipped > 0 { Exclusion::Clipped } else { Exclusion::None };
        tape.close(Segment {
            kind,
            first: self.first as u16,
            end: end as u16,
            start_us: self.start_us,
            end_us,
            exclusion,
            clipped: self.clipped,
            clipped_samples: self.clipped_samples,
        })?;
        self.first = end;
        self.start_us = end_us;
        self.clipped = 0;
        self.clipped_samples = 0;
        Ok(())
    }

    /// A gap ends a still and makes the move that holds it useless.
    fn gap<const R: usize, const S: usize>(
        &mut self,
        sample: &Sample,
        gap_s: f32,
        tape: &mut Tape<R, S>,
        events: &mut Events,
    ) {
        self.stillness.interrupt();
        let before_us = sample.t_us - (gap_s * 1e6) as u64;
        if let State::Still { pending_us, .. } = self.state
            && let Ok((face, held_s)) = self.close_still(tape, pending_us)
        {
            let _ = events.push(MotionEvent::StillEnded { face, held_s });
        }
        let end = tape.len();
        let bridged = self.close(tape, Kind::Hand, end, sample.t_us.max(before_us));
        if let (Ok(()), Some(segment)) = (bridged, tape.segments_mut().last_mut()) {
            segment.exclusion = Exclusion::Gap;
        }
        self.visit = RevolutionCheck::default();
        self.last_up = None;
        self.block_first = end;
        self.block_start_us = sample.t_us;
        self.state = State::Moving { quiet: 0, candidate_first: end, candidate_us: sample.t_us };
    }

    /// It rests with another rate than the rest before. On the same face the bias has jumped: what follows is put on the tape less the jump, and is
    /// held against the rests before as ever. On another one it may be what the sensor feels of force, which the estimator tells.
    fn rests_otherwise<const R: usize, const S: usize>(
        &mut self,
        by: &Vector3<f32>,
        block: &Block,
        tape: &mut Tape<R, S>,
    ) {
        self.disproof = 0;
        let felt = by.norm() < MOST_FELT && self.last_up.is_none_or(|up| up.angle(&block.mean_force) > ON_TABLE);
        if !felt {
            tape.bias_jumps.take(by);
            self.jumped = true;
            self.stillness.interrupt();
        } else if let Some(rest) = self.stillness.resting_rate() {
            self.stillness.set_resting_rate(rest + by);
        }
    }

    /// Where a later rest is quiet but for its mean rate, and lies nearer to zero, the earlier ones may have been steady turns.
    fn disprove<const R: usize, const S: usize>(&mut self, block: &Block, excess: &Excess, tape: &mut Tape<R, S>) {
        let contradicts = excess.variance.max(excess.wander) <= 1.0 && excess.offset > 1.0;
        let nearer = self.stillness.resting_rate().is_some_and(|rest| block.mean_rate.norm() < rest.norm());
        self.disproof = if contradicts && nearer { self.disproof + 1 } else { 0 };
        if self.disproof == DISPROOF_BLOCKS && strike_turns(tape, &block.mean_rate) {
            self.disproof = 0;
            self.stillness.set_resting_rate(block.mean_rate);
        }
    }
}
