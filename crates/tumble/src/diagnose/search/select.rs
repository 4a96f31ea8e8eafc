//! Forward selection with refit, removal and swap: every candidate against the one nominal fit, given what is accepted.

use std::sync::Arc;

use super::bench::{Accepted, Bench, HEALTHY, WANDERING, with_walks};
use super::ledger::{Ledger, log_mean};
use super::null;
use crate::diagnose::twin::noise::{BIAS_WALK_FLOOR, FORCE_WALK_FLOOR, Noise};
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
}

/// The null's noise: how much the biases wander, as far as healthy ones do, by evidence.
fn settle_walks(bench: &mut Bench) -> (Noise, f64) {
    let mut best = (bench.twin.noise, f64::NEG_INFINITY);
    let terms = bench.accepted_terms(None);
    let walks = |bench: &Bench, gyro: bool| {
        bench.accepted.iter().any(|a| bench.candidates[a.candidate].walk.is_some_and(|walk| walk.0 == gyro))
    };
    let base = bench.twin.noise;
    let levels = |fixed: bool, now: f64| if fixed { vec![now] } else { HEALTHY.to_vec() };
    let gyro_levels = levels(walks(bench, true), base.bias_walk / BIAS_WALK_FLOOR);
    let accel_levels = levels(walks(bench, false), base.force_walk / FORCE_WALK_FLOOR);
    for &gyro in &gyro_levels {
        for &accel in &accel_levels {
            let noise = with_walks(&base, gyro, accel);
            let evidence = bench.fit_alone(noise, &terms).evidence;
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
    let mut first = Vec::new();
    for round in 0..=MOST_EFFECTS {
        progress("candidates", 0.3 + 0.1 * round as f32);
        let scores = score(bench);
        if round == 0 {
            first.clone_from(&scores);
        }
        let Some(best) = scores.first().filter(|best| best.gain > threshold && round < MOST_EFFECTS) else { break };
        accept(bench, best);
        prune(bench, threshold);
    }
    let (noise, evidence) = settle_walks(bench);
    let after = bench.rows(noise);
    Selection { threshold, first, before, null_scales, null_noise, after, evidence }
}

fn accept(bench: &mut Bench, best: &Score) {
    let parameters = bench.candidates[best.candidate].variants.get(best.variant).map_or(0, |v| v.parameters.len());
    let Score { candidate, variant, widening, .. } = *best;
    bench.accepted.push(Accepted { candidate, variant, widening, taken: vec![0.0; parameters] });
    bench.twin.noise = best.noise;
    bench.refit();
}

/// What no longer pays, given what came later, goes.
fn prune(bench: &mut Bench, threshold: f64) {
    while bench.accepted.len() > 1 {
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
    let mut terms = bench.accepted_terms(None);
    let walk = bench.candidates[removed.candidate].walk;
    if walk.is_none() {
        let back = bench.terms(removed.candidate, removed.variant, removed.widening, &removed.taken);
        terms.extend(back.into_iter().map(|term| super::ledger::Term { width: 1e-9 * term.width, ..term }));
    }
    let mut best = f64::NEG_INFINITY;
    for gyro in HEALTHY {
        for accel in HEALTHY {
            let noise = with_walks(&noise, gyro, accel);
            best = best.max(bench.fit_alone(noise, &terms).evidence);
        }
    }
    bench.twin.noise = noise;
    bench.accepted.insert(k, removed);
    best
}

/// Gains of all candidates that are not accepted yet, best first.
pub fn score(bench: &mut Bench) -> Vec<Score> {
    let base = bench.twin.noise;
    let (settled, whole) = settle_walks(bench);
    let terms = bench.accepted_terms(None);
    let wandering = |gyro: bool, bench: &Bench| {
        bench.accepted.iter().any(|a| bench.candidates[a.candidate].walk.is_some_and(|walk| walk.0 == gyro))
    };
    let least = Noise {
        bias_walk: if wandering(true, bench) { base.bias_walk } else { BIAS_WALK_FLOOR },
        force_walk: if wandering(false, bench) { base.force_walk } else { FORCE_WALK_FLOOR },
        ..settled
    };
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
    let terms = bench.accepted_terms(None);
    let level = |level: f64| {
        if gyro {
            Noise { bias_walk: level * BIAS_WALK_FLOOR, ..settled }
        } else {
            Noise { force_walk: level * FORCE_WALK_FLOOR, ..settled }
        }
    };
    let found = WANDERING.map(|at| (bench.fit_alone(level(at), &terms).evidence, level(at)));
    let best = found.iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or(settled, |best| best.1);
    let gain = log_mean(&found.map(|(evidence, _)| evidence)) - whole;
    Score { candidate, gain, variant: 0, widening: 1.0, noise: best }
}
