//! The estimator: passes of a linearised Kalman filter over the tape, each about the last one's result.
//!
//! A filter that feeds its estimate back within a pass rectifies attitude noise into scale (up to −340 ppm, `design.md`
//! §2). Here a pass is linear about a fixed nominal, which makes the passes Gauss–Newton steps of the maximum a posteriori
//! problem; the prior stays where the first pass had it.

use nalgebra::SMatrix;

use super::conditions::Conditions;
use super::facets::{CONTACT, SQUARE};
use super::model::Nominal;
use super::moves;
use super::noise::{Noise, PIVOT_FLOOR};
use super::prior::{self, CORRECTION_SIGMA};
use super::resting::{Account, FELT};
use super::start;
use super::state::Block;
use super::sums::SegmentNoise;
use super::walk::Walk;
use super::walk::still::EARTH_SIGMA;
use super::wander::Found;
use crate::calibration::Calibration;
use crate::tape::Tape;

/// At least this many passes: three to come near, one to judge the noise, one to confirm.
const MIN_PASSES: u32 = 5;
/// At most this many, so that any session is done in ten seconds at 96 MHz: a full tape takes some 48 M instructions a pass in
/// the bench's build (`docs/bench.md`) and a sixth more in the product's, 16 of them 0.9 G. Nineteen of twenty need 12 or fewer.
const MAX_PASSES: u32 = 16;
/// Converged when no parameter moved by more than this many of its sigma.
const CONVERGED: f32 = 0.05;
/// Passes before noise is judged by residuals, and the last that judges it: then it stands, so that the rest converge.
const SETTLED: u32 = 3;
const LAST_ADAPTING: u32 = 14;
/// The noise has settled when no part of it changed by more than this share in a pass.
const NOISE_SETTLED: f32 = 0.1;

/// Order of [`Estimate::covariance`]: accelerometer bias 3, correction 9 by rows, gyroscope bias 3, correction 9.
pub const PARAMETERS: usize = 24;

/// What comes out.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Numbers with sigmas.
    pub calibration: Calibration,
    /// Of the parameters, in the order of [`PARAMETERS`].
    pub covariance: SMatrix<f32, PARAMETERS, PARAMETERS>,
    /// Noise that the session showed.
    pub noise: Noise,
    /// Moves that were down-weighted: segment, and by what factor of variance. The eight first.
    pub outliers: heapless::Vec<(u16, f32), 8>,
    /// Did enough faces lie on the table for a square box's axes to be seen?
    pub plated: bool,
    /// Passes made.
    pub passes: u32,
    /// False if parameters still moved in the last pass.
    pub converged: bool,
    /// The most that a parameter moved by in the last pass, sigmas.
    pub moved: f32,
}

/// The arithmetic broke down at this place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Breakdown(pub &'static str);

/// Runs in slices.
#[derive(Clone, Debug)]
pub struct Estimator<const S: usize> {
    pub(super) conditions: Conditions,
    pub(super) noise: Noise,
    start: Nominal,
    pub(super) walk: Walk<S>,
    pub(super) passes: u32,
    /// By what factors the last pass changed the sigmas of wobble and stops.
    steps: [f32; 3],
    /// … and of a face.
    facet_step: f32,
    /// The gyroscope's bias has probably wandered, though perhaps not certainly enough for the filter.
    pub(super) bias_wanders: bool,
    /// What the last pass made of the rates at rest, without and with a sensitivity to force, …
    accounts: [Option<Account>; 2],
    /// … and which of the two stands.
    pub(super) felt: bool,
}

/// Where a run stands.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "no heap to box an estimate into, and there is one at a time")]
pub enum Progress {
    /// Part of the work done, if it takes the least number of passes.
    Working(f32),
    /// Done.
    Done(Estimate),
}

impl<const S: usize> Estimator<S> {
    /// Prepares the first pass, in `place`: an estimator takes 13 KB, and every move of it on its way would take as much again of a
    /// microcontroller's stack.
    pub fn begin<'p, const R: usize>(
        place: &'p mut Option<Self>,
        tape: &Tape<R, S>,
        conditions: Conditions,
    ) -> &'p mut Self {
        let noise = Noise::from_rests(tape, conditions.stops, conditions.faces);
        let start = start::nominal(tape, conditions.gravity_mps2);
        let new = place.insert(Self {
            conditions,
            noise,
            start,
            walk: Walk::new(start, conditions.gravity_mps2),
            passes: 0,
            steps: [1.0; 3],
            facet_step: 1.0,
            bias_wanders: false,
            accounts: [Some(Account::default()), None],
            felt: false,
        });
        prior::begin(&mut new.walk.filter, &conditions, &start, &start);
        new.walk.restart(start);
        new
    }

    /// Walks up to `records` further.
    pub fn work<const R: usize>(&mut self, tape: &Tape<R, S>, records: usize) -> Result<Progress, Breakdown> {
        let noise = self.noise.at_least(self.walk.width() / CORRECTION_SIGMA);
        if !self.walk.advance(tape, &noise, records) {
            let share = self.walk.segments_done() as f32 / tape.segments().len().max(1) as f32;
            return Ok(Progress::Working((self.passes as f32 + share) / MIN_PASSES as f32));
        }
        self.passes += 1;
        let nominal = prior::improved(self.walk.nominal(), &self.walk.filter);
        if !prior::is_finite(&nominal) {
            return Err(Breakdown("estimate"));
        }
        let converged = self.passes >= MIN_PASSES && !self.walk.adapting && self.largest_move() < CONVERGED;
        if converged || self.passes >= MAX_PASSES {
            if !self.walk.filter.covariance().diagonal().all(|variance| variance >= 0.0) {
                return Err(Breakdown("covariance"));
            }
            return Ok(Progress::Done(self.estimate(tape, &nominal, converged)));
        }
        self.adapt(tape);
        let begin = if self.passes >= 2 { prior::begin_narrow } else { prior::begin };
        begin(&mut self.walk.filter, &self.conditions, &self.start, &nominal);
        let plated = self.walk.pass.agreed || self.walk.pass.facets.agree_or_not();
        self.walk.restart(nominal);
        self.walk.pass.accounts = self.accounts;
        self.walk.pass.plated = plated;
        self.walk.pass.coarse = self.passes < 2;
        Ok(Progress::Working(self.passes as f32 / MIN_PASSES as f32))
    }

    /// What the passes so far say of each segment.
    pub fn segment_noise(&self) -> &[SegmentNoise] {
        &self.walk.noise
    }

    /// The largest step of this pass over its sigma.
    pub(super) fn largest_move(&self) -> f32 {
        let (state, covariance) = (self.walk.filter.state(), self.walk.filter.covariance());
        let blocks = [Block::GyroCorrection, Block::AccelCorrection, Block::AccelBias];
        blocks.into_iter().flat_map(Block::range).fold(0.0, |largest, index| {
            let sigma = libm::sqrtf(covariance[(index, index)]);
            if sigma > 0.0 { largest.max(libm::fabsf(state[index]) / sigma) } else { largest }
        })
    }

    /// Noise as this pass's innovations show it; the first passes are too far from the truth to tell.
    fn adapt<const R: usize>(&mut self, tape: &Tape<R, S>) {
        if !self.walk.adapting {
            return;
        }
        let before = self.noise;
        self.straighten(tape);
        if self.passes < SETTLED {
            return;
        }
        self.wander();
        if let Some(variance) = self.walk.pass.sums.pivot.mean(PIVOT_FLOOR) {
            self.noise.pivot_sigma_m = libm::sqrtf(variance);
        }
        self.settle();
        let steady = moves::weigh(&mut self.noise, &mut self.walk.noise, NOISE_SETTLED);
        self.walk.adapting = self.passes < LAST_ADAPTING && !(steady && before.is_near(&self.noise, NOISE_SETTLED));
    }

    /// Biases that walk. To believe in a walk that is not there costs the accelerometer a factor of four.
    fn wander(&mut self) {
        let (rate, force) =
            (self.walk.pass.rate_walks[usize::from(self.felt)].found(), self.walk.pass.force_walk.found());
        self.bias_wanders = rate.is_some_and(|walk| walk.probable());
        let certain = |walk: Option<Found>| walk.filter(Found::certain).map_or(0.0, |walk| walk.density);
        self.noise.set_bias_walk(certain(rate));
        self.noise.set_force_walk(certain(force));
    }

    /// Which account of the rates at rest stands: the one with a sensitivity to force has nine numbers more, each of them free under the
    /// walk that fits it best, so that twice the logarithm of the likelihoods' ratio is χ²₉ of noise or of a walk alone.
    ///
    /// Not inlined: its sums and accounts (6 KB) would lie on the stack through the whole walk.
    #[inline(never)]
    fn weigh_accounts(&mut self, session_s: f32) {
        let pass = &self.walk.pass;
        let [plain, felt] = [0, 1].map(|k| pass.accounts[k].and(pass.rate_walks[k].found()));
        self.felt =
            plain.zip(felt).is_some_and(|(plain, felt)| 2.0 * (felt.log_likelihood - plain.log_likelihood) > FELT);
        let resting = &pass.resting;
        let gravity = self.conditions.gravity_mps2;
        self.accounts = [resting.plain(EARTH_SIGMA), resting.felt(EARTH_SIGMA, gravity)];
        if let Some(account) = &mut self.accounts[1] {
            account.sensitivity.widen(self.noise.bias_walk * session_s / (gravity * gravity));
        }
        if let Some(account) = &self.accounts[usize::from(self.felt)] {
            self.noise.set_account(account, session_s, resting.visits, gravity);
        }
    }

    /// The one that stands.
    pub(super) fn account(&self) -> Option<&Account> {
        self.accounts[usize::from(self.felt)].as_ref()
    }

    /// What other noise would otherwise be blamed for: a bias that drifts or follows force, a box that is not square.
    fn straighten<const R: usize>(&mut self, tape: &Tape<R, S>) {
        if let [first, .., last] = tape.segments() {
            self.weigh_accounts((last.end_us - first.start_us) as f32 * 1e-6);
        }
        // The start is 20 mrad off, which is no box's fault; the first pass leaves its square, 0.4 mrad.
        let shear = self.shear_variance();
        if self.passes > 1
            && let Some(sigma) = &mut self.noise.facet_sigma_rad
        {
            let (found, crooked) = self.walk.pass.facets.variance(*sigma, shear).unwrap_or((SQUARE * SQUARE, false));
            damp(sigma, libm::sqrtf(found), &mut self.facet_step);
            self.noise.crooked = crooked;
            self.noise.contact_sigma_rad = self.walk.pass.facets.contact().map_or(CONTACT, libm::sqrtf);
        }
    }

    /// Variance of one component of the accelerometer's shear, `(A_ij + A_ji)/2`, in the mean over the three, 1.
    fn shear_variance(&self) -> f32 {
        let covariance = self.walk.filter.covariance();
        let at = |i: usize, j: usize| Block::AccelCorrection.start() + 3 * i + j;
        [(0, 1), (0, 2), (1, 2)].into_iter().fold(0.0, |sum, (i, j)| {
            let (a, b) = (at(i, j), at(j, i));
            sum + (covariance[(a, a)] + covariance[(b, b)] + 2.0 * covariance[(a, b)]).max(0.0) / 12.0
        })
    }

    /// Both parts of a wobble, and stops. A plate or a fence believed less shows smaller residuals, and then is believed more: where
    /// a step would take the last one back, half of it is made (in the logarithm), which ends the swing.
    fn settle(&mut self) {
        let found = [self.walk.pass.wobble.turning(), self.walk.pass.wobble.rest(), self.stops()];
        let noise = &mut self.noise;
        let sigmas = [&mut noise.wobble_sigma_rad, &mut noise.rocking_sigma_rad, &mut noise.stop_sigma_rad];
        for ((sigma, found), last) in sigmas.into_iter().zip(found).zip(&mut self.steps) {
            if let Some(found) = found {
                damp(sigma, libm::sqrtf(found), last);
            }
        }
    }

    fn stops(&self) -> Option<f32> {
        let filter = &self.walk.filter;
        let scales = core::array::from_fn(|axis| {
            let index = Block::GyroCorrection.start() + 4 * axis;
            (filter.state()[index], filter.covariance()[(index, index)])
        });
        self.walk.pass.closures.variance(self.conditions.stops, &scales)
    }
}

/// Brings a sigma to what was found; `last` is the last pass's factor.
fn damp(sigma: &mut f32, found: f32, last: &mut f32) {
    let step = found / *sigma;
    let back = (step - 1.0) * (*last - 1.0) < 0.0;
    *last = if back { libm::sqrtf(step) } else { step };
    *sigma *= *last;
}
