//! Forward selection with refit, removal and swap: every candidate against the one nominal fit, given what is accepted.

use std::sync::Arc;

use super::bench::{Accepted, Bench, HEALTHY, WANDERING, with_walks};
use super::ledger::{Ledger, Term, log_mean};
use super::null;
use super::sharpen::sharpen;
use super::slide::slide;
use crate::diagnose::numbers::walk_density;
use crate::diagnose::twin::noise::{Noise, walk_floor};
use crate::diagnose::twin::rows::Rows;

/// Effects that one recording can be asked to tell apart.
const MOST_EFFECTS: usize = 5;

/// A candidate's gain in evidence over what is accepted.
#[derive(Clone, Debug)]
pub struct Score {
    /// Which.
    pub candidate: usize,
    /// ln of the Bayes factor.
    pub gain: f64,
    /// Its best variant.
    pub variant: usize,
    /// That variant's best widening.
    pub widening: f64,
    /// Noise at which it is best.
    pub noise: Noise,
}

/// What the search ended with.
pub struct Selection {
    /// Evidence that chance reaches in [`null::FALSE_ALARMS`] of cases.
    pub threshold: f64,
    /// Scores of the first round, best first: each candidate alone.
    pub first: Vec<Score>,
    /// Rows before anything was accepted, at the null's best noise.
    pub before: Arc<Rows>,
    /// Their evidence as they are.
    pub null_scales: [f64; 6],
    /// Noise of the null.
    pub null_noise: Noise,
    /// Rows at the end.
    pub after: Arc<Rows>,
    /// ln p at the end.
    pub evidence: f64,
    /// Noise at the end.
    pub noise: Noise,
}

/// The null's noise, by evidence: stops, faces and moves as the device found them or as good as they can be, and biases that wander as
/// far as healthy ones do.
pub fn settle_walks(bench: &mut Bench) -> (Noise, f64) {
    let terms = bench.accepted_terms(&[]);
    best_noise(bench, &terms)
}

/// All of it together: what one base takes for wander the other takes for moves. Pushes in turns are looked for about the best of it, and all else
/// once more beside them.
fn best_noise(bench: &mut Bench, terms: &[Term]) -> (Noise, f64) {
    let still = steady_noise(bench, terms, (0.0, 1.0));
    let pushed = slide(bench, terms, still);
    if pushed.0.slide_rad == 0.0 {
        return still;
    }
    let again = steady_noise(bench, terms, (pushed.0.slide_rad, pushed.0.slide_s));
    if again.1 > pushed.1 { again } else { pushed }
}

fn steady_noise(bench: &mut Bench, terms: &[Term], (slide_rad, slide_s): (f64, f64)) -> (Noise, f64) {
    let mut best = (bench.given, f64::NEG_INFINITY);
    for base in [bench.given, bench.given.trusting(bench.twin.stops)] {
        for (gyro, accel) in HEALTHY.iter().flat_map(|gyro| HEALTHY.iter().map(move |accel| (gyro, accel))) {
            let base = Noise { slide_rad, slide_s, ..base };
            let noise = bench.with_accepted_walks(&with_walks(&base, *gyro, *accel), &[]);
            let evidence = bench.fit_alone(noise, terms).evidence;
            if evidence > best.1 {
                best = (noise, evidence);
            }
        }
    }
    best
}

/// Runs the search to its end; `progress` hears what is being done.
pub fn select(bench: &mut Bench, seed: u64, progress: &mut dyn FnMut(&str, f32)) -> Selection {
    progress("the nominal model", 0.1);
    let (null_noise, _) = settle_walks(bench);
    let before = bench.rows(null_noise);
    let null_scales = Ledger::new(&before, |_| true).fit(&[]).scales;
    progress("what chance does", 0.2);
    let threshold = null::threshold(bench, &before, &null_scales, seed);
    let first = forward(bench, threshold, progress);
    challenge_walks(bench, threshold, progress);
    refine_walks(bench);
    prune(bench, threshold);
    let (noise, evidence) = settle_walks(bench);
    let after = bench.rows(noise);
    Selection { threshold, first, before, null_scales, null_noise, after, evidence, noise }
}

/// Takes in the best, one after the other, while it pays; the scores of the first round.
fn forward(bench: &mut Bench, threshold: f64, progress: &mut dyn FnMut(&str, f32)) -> Vec<Score> {
    let mut first = Vec::new();
    for round in 0..=MOST_EFFECTS {
        progress("candidates", 0.3 + 0.1 * round as f32);
        let scores = score(bench);
        if round == 0 {
            first.clone_from(&scores);
        }
        let room = bench.accepted.len() < MOST_EFFECTS && round < MOST_EFFECTS;
        let Some(best) = scores.first().filter(|best| best.gain > threshold && room) else { break };
        if accept(bench, best, threshold) {
            prune(bench, threshold);
        }
    }
    first
}

/// A walk can stand for two effects at once, and then leaves neither anything to explain: the search once more without walks.
/// Names that explain more by the odds that each further one needs take the walk's place.
fn challenge_walks(bench: &mut Bench, threshold: f64, progress: &mut dyn FnMut(&str, f32)) {
    if !(bench.wanders(true) || bench.wanders(false)) {
        return;
    }
    let evidence = settle_walks(bench).1;
    let kept = (bench.accepted.clone(), bench.wander);
    let known: Vec<_> = bench.candidates.iter().map(|c| (c.variants.clone(), c.walk, c.absent)).collect();
    bench.candidates.iter_mut().for_each(|candidate| candidate.walk = None);
    bench.accepted.clear();
    bench.take_out(&[]);
    bench.fit_nominal();
    forward(bench, threshold, progress);
    let more = bench.accepted.len().saturating_sub(kept.0.len());
    let better = settle_walks(bench).1 > evidence + threshold * more as f64;
    for (candidate, (variants, walk, absent)) in bench.candidates.iter_mut().zip(known) {
        // What was struck out comes back; what was moved to its time stays there, for its columns did.
        if candidate.variants.is_empty() {
            candidate.variants = variants;
        }
        (candidate.walk, candidate.absent) = (walk, absent);
    }
    if better && !bench.accepted.is_empty() {
        // A walk may yet be there beside them.
        forward(bench, threshold, progress);
    } else {
        (bench.accepted, bench.wander) = kept;
        bench.refit();
    }
}

/// Walks stand at levels a factor of four apart in variance, and what the level lacks another name may seem to have: each at its
/// own maximum before what no longer pays goes.
fn refine_walks(bench: &mut Bench) {
    let walks: Vec<_> = bench.accepted.iter().filter_map(|accepted| bench.candidate(accepted).walk).collect();
    for (gyro, ..) in walks {
        let noise = settle_walks(bench).0;
        let found = walk_density(bench, noise, gyro).density;
        bench.set_wander(gyro, found);
    }
}

/// Takes a candidate in, unless its non-linear refit does not hold what the linear score promised, or its numbers have no
/// meaning: then it is out for good.
fn accept(bench: &mut Bench, best: &Score, threshold: f64) -> bool {
    let before = settle_walks(bench).1;
    let parameters = bench.candidates[best.candidate].variants.get(best.variant).map_or(0, |v| v.parameters.len());
    let Score { candidate, variant, widening, .. } = *best;
    bench.accepted.push(Accepted { candidate, variant, widening, taken: vec![0.0; parameters] });
    bench.twin.noise = best.noise;
    if let Some((gyro, ..)) = bench.candidates[candidate].walk {
        bench.set_wander(gyro, best.noise.walk(gyro));
    }
    sharpen(bench);
    bench.refit();
    let (noise, after) = settle_walks(bench);
    bench.twin.noise = noise;
    if after - before > threshold.min(0.5 * best.gain) && is_meaningful(bench) {
        return true;
    }
    bench.accepted.pop();
    bench.candidates[candidate].variants.clear();
    bench.candidates[candidate].walk = None;
    bench.candidates[candidate].absent = Some("a full fit of it does not hold what the first look promised");
    bench.refit();
    false
}

/// Are the last one's numbers possible? What cannot be negative must not be so by three sigma.
fn is_meaningful(bench: &mut Bench) -> bool {
    let Some(last) = bench.accepted.last().cloned() else { return true };
    let Some(placed) = bench.placed(&last).cloned() else { return true };
    let terms = bench.accepted_terms(&[]);
    let fit = bench.fit_alone(bench.twin.noise, &terms);
    let first = terms.len() - placed.parameters.len();
    placed.parameters.iter().enumerate().all(|(i, parameter)| {
        let sigma = fit.covariance[(first + i, first + i)].sqrt();
        !parameter.positive || fit.theta[first + i] + last.taken[i] > -3.0 * sigma
    })
}

/// What no longer pays, given what came later, goes.
fn prune(bench: &mut Bench, threshold: f64) {
    while !bench.accepted.is_empty() {
        let whole = settle_walks(bench).1;
        let losses: Vec<f64> = (0..bench.accepted.len()).map(|k| whole - without(bench, k)).collect();
        let Some((k, _)) =
            losses.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).filter(|(_, loss)| **loss < threshold)
        else {
            return;
        };
        bench.accepted.remove(k);
        bench.refit();
    }
}

/// ln p without one of the accepted.
pub fn without(bench: &mut Bench, k: usize) -> f64 {
    let removed = bench.accepted.remove(k);
    let noise = bench.twin.noise;
    // Its share is still taken out of the samples: its columns put it back at exactly that size.
    let mut terms = bench.accepted_terms(&[]);
    terms.extend(bench.put_back(&removed));
    let best = best_noise(bench, &terms).1;
    bench.twin.noise = noise;
    bench.accepted.insert(k, removed);
    best
}

/// Gains of all candidates that are not accepted yet, best first.
pub fn score(bench: &mut Bench) -> Vec<Score> {
    let (settled, whole) = settle_walks(bench);
    let terms = bench.accepted_terms(&[]);
    let least = bench.least_noise(&[]);
    let mut noises = vec![settled];
    if least != settled {
        noises.push(least);
    }
    let mut scores: Vec<Score> = Vec::new();
    for noise in noises {
        let rows = bench.rows(noise);
        let ledger = Ledger::new(&rows, |_| true);
        for candidate in 0..bench.candidates.len() {
            if bench.candidates[candidate].variants.is_empty() || is_accepted(bench, candidate) {
                continue;
            }
            let (evidence, variant, widening) = bench.weigh(&ledger, &terms, candidate);
            let score = Score { candidate, gain: evidence - whole, variant, widening, noise };
            match scores.iter_mut().find(|score| score.candidate == candidate) {
                Some(old) if old.gain < score.gain => *old = score,
                Some(_) => {}
                None => scores.push(score),
            }
        }
    }
    bench.twin.noise = settled;
    for candidate in 0..bench.candidates.len() {
        if bench.candidates[candidate].walk.is_some() && !is_accepted(bench, candidate) {
            scores.push(score_walk(bench, candidate, settled, whole));
        }
    }
    bench.twin.noise = settled;
    scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    scores
}

fn is_accepted(bench: &Bench, candidate: usize) -> bool {
    bench.accepted.iter().any(|accepted| accepted.candidate == candidate)
}

fn score_walk(bench: &mut Bench, candidate: usize, settled: Noise, whole: f64) -> Score {
    let gyro = bench.candidates[candidate].walk.is_some_and(|walk| walk.0);
    let terms = bench.accepted_terms(&[]);
    let found = WANDERING.map(|level| {
        let noise = settled.with_walk(gyro, level * walk_floor(gyro));
        (bench.fit_alone(noise, &terms).evidence, noise)
    });
    let best = found.iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or(settled, |best| best.1);
    let gain = log_mean(&found.map(|(evidence, _)| evidence)) - whole;
    Score { candidate, gain, variant: 0, widening: 1.0, noise: best }
}
