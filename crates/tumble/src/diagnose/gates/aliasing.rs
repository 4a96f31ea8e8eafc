//! Sampled too slowly for what moves (`undersampling`).
//!
//! Statistic: the rotation over pieces of 4 s in which it turns from all samples against that from every other one, the mean of both
//! halves. Noise makes them differ by σ·dt·√N (alternate samples, weighted ±dt), known from rests; the sum of squares over M pieces is a mean
//! of 3·M squared normals, its tail Chernoff's. A trapezoid's own error is a third of the difference or less (Richardson). Beyond
//! noise there is always something: tremor, knocks, rounding. So the difference must also matter, and the recording be slow:
//! fewer than 40 samples a second, where a hand's tremor of 8 to 12 Hz has fewer than four a period, and rms above 0.15° in 4 s
//! (well filtered moves at 50 Hz have 0.06 to 0.09°, sim). Above 40 Hz it does not fire: that no clean recording there raises an alarm is
//! by construction.
//!
//! Limit: this very recording is thinned to every n-th sample, from every place to begin; the fastest rate below 40 Hz at which 95 of 100 of
//! them are told. What folds at 28 to 80 Hz (a put-down rings at 25 to 45 Hz, which a sensor's filter of 41 Hz lets pass) looks
//! like slow motion and leaves no trace in the samples themselves; where it spoils the physics, `second.rs` tells.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use super::chance::{LN_ALARM, ln_mean_square_tail};
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;
use crate::diagnose::diagnosis::{Found, Place};
use crate::integrate::rotation;

const IMITATED: &[&str] = &["gyro_scale_cubic", "gyro_scale_quadratic", "gyro_scale_asymmetry", "gyro_accel_lag"];
const SLOW_HZ: f64 = 40.0;
const LEAST_DEG: f64 = 0.15;
/// The slowest rate that is tried for the limit. Below it a tremor of 8 to 12 Hz folds to 4 Hz and less, where every other sample
/// shows it as well: then both integrals are wrong alike.
const SLOWEST_HZ: f64 = 16.0;
/// Pieces that are compared, s, and what must be turned in one for it to count.
const CHUNK_S: f64 = 4.0;
const LEAST_TURNED_DEG: f64 = 30.0;

pub(super) const CARD: Card = Card {
    id: "undersampling",
    name: "sampled too slowly for its bandwidth",
    equation: "the rotation integral changes when every other sample is left out",
    typical: "41 Hz of bandwidth (MPU-9250, CONFIG = 3) asks for more than 82 Hz; tremor reaches 12 Hz",
    shows: "fast moves",
    confounded: IMITATED,
    separate_by: "record at 100 Hz or more, or narrow the sensor's filter to a quarter of the rate",
};

/// What every `every`-th sample from `first` on says.
struct Thinned<'a> {
    view: &'a View<'a>,
    first: usize,
    every: usize,
}

/// What pieces of motion differ by.
struct Differs {
    rms_deg: f64,
    ln_p: f64,
    pieces: f64,
    samples: Range<usize>,
}

impl Differs {
    /// It matters, and is not noise.
    fn told(&self) -> bool {
        self.rms_deg > LEAST_DEG && self.ln_p < LN_ALARM
    }
}

impl Thinned<'_> {
    fn len(&self) -> usize {
        (self.view.len() - self.first).div_ceil(self.every)
    }

    fn dt_s(&self) -> f64 {
        self.view.dt_s * self.every as f64
    }

    fn t_s(&self, index: usize) -> f64 {
        self.view.t_s[self.first + index * self.every]
    }

    /// rad/s, less the offset.
    fn rate(&self, index: usize) -> Vector3<f64> {
        (self.view.rate(self.first + index * self.every) - self.view.resting).map(f64::to_radians)
    }

    /// All pieces; none without motion.
    fn differs(&self) -> Option<Differs> {
        let length = ((CHUNK_S / self.dt_s()).round() as usize).max(16);
        let turned = |range: &Range<usize>| {
            range.clone().map(|i| self.rate(i).norm()).sum::<f64>() * self.dt_s() > LEAST_TURNED_DEG.to_radians()
        };
        let starts = (0..self.len().saturating_sub(length)).step_by(length);
        let moves: Vec<Range<usize>> = starts.map(|start| start..start + length + 1).filter(turned).collect();
        let sigma_rad = self.view.sigma[..3].iter().copied().filter(|s| s.is_finite()).fold(0.0, f64::max).to_radians();
        if moves.len() < 3 || sigma_rad == 0.0 {
            return None;
        }
        let (mut squares, mut whitened) = (0.0, 0.0);
        for range in &moves {
            let differs = self.piece(range).norm_squared();
            squares += differs;
            whitened += differs / (sigma_rad * sigma_rad * self.dt_s() * self.dt_s() * range.len() as f64);
        }
        let pieces = moves.len() as f64;
        let at = |index: usize| self.first + index * self.every;
        Some(Differs {
            rms_deg: (squares / pieces).sqrt().to_degrees(),
            ln_p: ln_mean_square_tail(whitened / (3.0 * pieces), 3.0 * pieces),
            pieces,
            samples: at(moves[0].start)..at(moves[moves.len() - 1].end - 1),
        })
    }

    /// Rotation vector between the integral of all samples and the integral of every other one.
    fn piece(&self, range: &Range<usize>) -> Vector3<f64> {
        let end = range.start + (range.len() - 1) / 2 * 2;
        let integral = |every: usize| {
            (range.start..end).step_by(every).fold(UnitQuaternion::identity(), |attitude, i| {
                let dt_s = self.t_s(i + every) - self.t_s(i);
                let (a, b) = (self.rate(i), self.rate(i + every));
                attitude * rotation(&a, &b, &Vector3::zeros(), dt_s)
            })
        };
        (integral(1).inverse() * integral(2)).scaled_axis()
    }
}

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let rate_hz = 1.0 / view.dt_s;
    let Some(differs) = (Thinned { view, first: 0, every: 1 }).differs() else {
        return Outcome { limit: untestable(&CARD, "Hz", "no motion"), ..Outcome::default() };
    };
    let limit = match slowest_told_hz(view) {
        Some(hz) => limit(&CARD, hz, "Hz", "this rate or less, down to 16 Hz: what is slower is the larger effect"),
        None => untestable(&CARD, "Hz", "the moves are so smooth that a slow rate does no harm"),
    };
    let mut outcome = Outcome { limit, ..Outcome::default() };
    if rate_hz < SLOW_HZ && differs.told() {
        let error_deg = differs.rms_deg / 3.0;
        let parameters = vec![
            value("rate", rate_hz, 1e-3 * rate_hz, "Hz"),
            value("rotation_error", error_deg, error_deg / (2.0 * differs.pieces).sqrt(), "deg"),
        ];
        outcome.found = Some(found(&CARD, -differs.ln_p, parameters, view.place(7, differs.samples)));
        outcome.imitated = IMITATED;
    }
    outcome
}

/// The fastest rate at which this motion would be told, and every slower one.
fn slowest_told_hz(view: &View) -> Option<f64> {
    let first = (1.0 / (SLOW_HZ * view.dt_s)).floor() as usize + 1;
    let last = (1.0 / (SLOWEST_HZ * view.dt_s)).ceil() as usize;
    let told = |every: usize| {
        // At most eight places to begin: they share their motion.
        let starts: Vec<usize> = (0..every).step_by(every.div_ceil(8)).collect();
        let thinned = starts.iter().filter_map(|first| Thinned { view, first: *first, every }.differs());
        thinned.filter(Differs::told).count() as f64 >= 0.95 * starts.len() as f64
    };
    let slower = (first..=last).rev().take_while(|every| told(*every)).last()?;
    Some(1.0 / (slower as f64 * view.dt_s))
}

/// What makes the physics contradict itself in a slow recording, but only where the box was moved from face to face: knocks of
/// put-downs that fold. `evidence` is ln of the odds of the contradiction, `instead` what was named for it.
pub fn in_moves(rate_hz: f64, evidence: f64, instead: Vec<String>, place: Place) -> Found {
    let mut found = found(&CARD, evidence, vec![value("rate", rate_hz, 1e-3 * rate_hz, "Hz")], place);
    found.tied_with = instead;
    found
}

/// Resting rate nearest to a sample, °/s; where no rest is long enough to tell, what the axes read most of the time.
pub fn nearest_rest(view: &View, index: usize) -> Vector3<f64> {
    let distance = |rest: &&super::view::Rest| rest.samples.start.abs_diff(index).min(rest.samples.end.abs_diff(index));
    view.rests.iter().min_by_key(distance).map_or(view.resting, |rest| rest.rate)
}
