//! From a finished search to the answer.

use super::diagnosis::{ChannelFit, FitReport, Found, Pair, Place, RunnerUp, Value};
use super::held_out;
use super::numbers::{shift_values, total, walk_density, walk_value};
use super::posterior;
use super::search::bench::Bench;
use super::search::ledger::Ledger;
use super::search::select::{self, Score, Selection};
use super::search::shares;
use super::search::unknown::{self, ALIAS};
use super::twin::noise::Noise;
use super::twin::rows::{CHANNELS, Rows};

/// Two explanations whose evidence differs by less than odds of 20 to 1 are tied.
pub const TIE: f64 = 3.0;
/// A channel is named where at least this share of an effect's signal lies.
const SHARE: f64 = 0.15;

/// What one accepted effect comes to, with its signal for pictures.
pub struct Finding {
    /// For the answer.
    pub found: Found,
    /// Its share in every row of `rows`.
    pub signal: Vec<f64>,
    /// A bias that wanders: it stands for whatever changes with time.
    pub is_walk: bool,
}

/// All accepted effects, the strongest first.
pub fn findings(bench: &mut Bench, selection: &Selection, origin_s: f64) -> Vec<Finding> {
    let noise = posterior::noise(bench);
    let mut findings: Vec<Finding> =
        (0..bench.accepted.len()).map(|k| finding(bench, selection, noise, k, origin_s)).collect();
    findings.sort_by(|a, b| b.found.evidence.total_cmp(&a.found.evidence));
    findings
}

fn finding(bench: &mut Bench, selection: &Selection, noise: Noise, k: usize, origin_s: f64) -> Finding {
    let accepted = bench.accepted[k].clone();
    let card = bench.candidate(&accepted).effect.card;
    let evidence = selection.evidence - select::without(bench, k);
    let rivals = rivals(bench, selection, k);
    let ledger = Ledger::new(&selection.after, |_| true);
    let walk = bench.candidate(&accepted).walk;
    let (parameters, signal) = stated(bench, selection, &ledger, noise, k);
    let place = if walk.is_some() {
        let first = if walk.is_some_and(|walk| walk.0) { 0 } else { 3 };
        whole_recording(bench, first, origin_s)
    } else {
        place(bench, &selection.after, &signal, origin_s)
    };
    let aliases = aliases(bench, &ledger, k);
    let mut tied_with: Vec<String> =
        rivals.iter().filter(|rival| rival.1 < TIE).map(|rival| rival.0.to_string()).collect();
    tied_with.extend(
        aliases
            .into_iter()
            .filter(|id| !tied_with.contains(id) && rivals.iter().any(|rival| rival.0 == id && rival.1 < 2.0 * TIE))
            .collect::<Vec<_>>(),
    );
    let runner_up = rivals.first().map(|rival| RunnerUp { id: rival.0.into(), gap: rival.1 });
    let held_out = if walk.is_none() { held_out::held_out(bench, &selection.after, k) } else { None };
    let found = Found {
        id: card.id.into(),
        name: card.name.into(),
        equation: card.equation.into(),
        evidence,
        runner_up,
        tied_with,
        tied_with_shapes: Vec::new(),
        separate_by: card.separate_by.into(),
        parameters,
        place,
        typical: card.typical.into(),
        held_out,
        other_recordings: Vec::new(),
    };
    Finding { found, signal, is_walk: walk.is_some() }
}

/// An accepted effect's numbers, and its share in every row.
fn stated(bench: &mut Bench, selection: &Selection, ledger: &Ledger, noise: Noise, k: usize) -> (Vec<Value>, Vec<f64>) {
    match bench.candidate(&bench.accepted[k]).walk {
        Some((gyro, unit_si, unit)) => {
            let found = walk_density(bench, noise, gyro);
            (vec![walk_value(&found, unit_si, unit)], vec![0.0; selection.after.at.len()])
        }
        None => shift_values(bench, &selection.after, ledger, noise, k),
    }
}

/// Ids and numbers of all accepted effects.
pub fn numbers(bench: &mut Bench, selection: &Selection) -> Vec<(&'static str, Vec<Value>)> {
    let noise = posterior::noise(bench);
    let ledger = Ledger::new(&selection.after, |_| true);
    let id = |bench: &Bench, k: usize| bench.candidate(&bench.accepted[k]).effect.card.id;
    (0..bench.accepted.len()).map(|k| (id(bench, k), stated(bench, selection, &ledger, noise, k).0)).collect()
}

/// Other effects in its place, by how much less they explain.
fn rivals(bench: &mut Bench, selection: &Selection, k: usize) -> Vec<(&'static str, f64)> {
    let own = bench.accepted[k].candidate;
    let scores: Vec<Score> = if bench.accepted.len() == 1 {
        selection.first.clone()
    } else {
        // With this one back in the samples and taken off the list.
        let removed = bench.accepted.remove(k);
        let noise = bench.twin.noise;
        if bench.candidate(&removed).walk.is_some() {
            bench.twin.noise = selection.null_noise;
        }
        let samples = bench.twin.samples.clone();
        bench.refit();
        let scores = select::score(bench);
        bench.accepted.insert(k, removed);
        bench.twin.samples = samples;
        bench.twin.noise = noise;
        bench.fit_nominal();
        scores
    };
    let Some(best) = scores.iter().find(|score| score.candidate == own).map(|score| score.gain) else {
        return Vec::new();
    };
    let mut rivals: Vec<_> = scores
        .iter()
        .filter(|score| score.candidate != own)
        .map(|score| (bench.candidates[score.candidate].effect.card.id, best - score.gain))
        .collect();
    rivals.sort_by(|a, b| a.1.total_cmp(&b.1));
    rivals
}

/// Effects that can imitate what was found on this geometry.
fn aliases(bench: &Bench, ledger: &Ledger, k: usize) -> Vec<String> {
    let accepted = &bench.accepted[k];
    let Some(placed) = bench.placed(accepted) else { return Vec::new() };
    let columns: Vec<usize> = placed.columns.clone().collect();
    let fit = ledger.fit(&bench.accepted_terms(&[]));
    let total = total(bench, &fit, k);
    let mut aliases = Vec::new();
    for (index, candidate) in bench.candidates.iter().enumerate() {
        if index == accepted.candidate {
            continue;
        }
        let imitates = |variant: &super::search::bench::Placed| {
            let others: Vec<usize> = variant.columns.clone().collect();
            unknown::shared(ledger, &fit.scales, &columns, &total, &others) > ALIAS
        };
        if candidate.variants.iter().any(imitates) {
            aliases.push(candidate.effect.card.id.to_string());
        }
    }
    aliases
}

/// Where a signal lies.
pub fn place(bench: &Bench, rows: &Rows, signal: &[f64], origin_s: f64) -> Place {
    let total: f64 = signal.iter().map(|v| v * v).sum::<f64>().max(f64::MIN_POSITIVE);
    let mut channels = [0.0; 6];
    let mut segments: std::collections::BTreeMap<usize, f64> = std::collections::BTreeMap::new();
    for (at, value) in rows.at.iter().zip(signal) {
        channels[at.channel] += value * value / total;
        *segments.entry(at.stretch).or_default() += value * value / total;
    }
    // Segments by their share until nine tenths are covered.
    let mut order: Vec<_> = segments.into_iter().collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut covered = 0.0;
    let mut chosen: Vec<usize> = order
        .into_iter()
        .take_while(|(_, share)| {
            let more = covered < 0.9;
            covered += share;
            more
        })
        .map(|(segment, _)| segment)
        .collect();
    chosen.sort_unstable();
    let time = |segment: usize, last: bool| {
        bench.twin.stretches.iter().find(|stretch| stretch.number == segment).map_or(0.0, |stretch| {
            let index = if last { stretch.samples.end - 1 } else { stretch.samples.start };
            origin_s + bench.twin.samples[index].t_s
        })
    };
    Place {
        channels: (0..6).filter(|&c| channels[c] > SHARE).map(|c| CHANNELS[c].to_string()).collect(),
        start_s: chosen.first().map_or(0.0, |first| time(*first, false)),
        end_s: chosen.last().map_or(0.0, |last| time(*last, true)),
        segments: chosen,
    }
}

fn whole_recording(bench: &Bench, first: usize, origin_s: f64) -> Place {
    Place {
        channels: CHANNELS[first..first + 3].iter().map(ToString::to_string).collect(),
        segments: bench.twin.stretches.iter().map(|stretch| stretch.number).collect(),
        start_s: origin_s,
        end_s: origin_s + bench.twin.samples.last().map_or(0.0, |raw| raw.t_s),
    }
}

/// All of it.
pub fn everywhere(bench: &Bench, origin_s: f64) -> Place {
    Place { channels: CHANNELS.iter().map(ToString::to_string).collect(), ..whole_recording(bench, 0, origin_s) }
}

/// All that moves, as the gyroscope saw it.
pub fn moves(bench: &Bench, origin_s: f64) -> Place {
    let moving = bench.twin.stretches.iter().filter(|stretch| !stretch.is_rest());
    Place { segments: moving.map(|stretch| stretch.number).collect(), ..whole_recording(bench, 0, origin_s) }
}

/// Mean squares before and after, on rows fitted and on rows left out.
pub fn fit_report(bench: &Bench, selection: &Selection) -> FitReport {
    let (before, after) = (&selection.before, &selection.after);
    let left = shares::left(bench, after);
    let mean = |values: &[f64], keep: &dyn Fn(usize) -> bool| {
        let kept = || values.iter().enumerate().filter(|(i, _)| keep(*i));
        kept().map(|(_, v)| v * v).sum::<f64>() / kept().count().max(1) as f64
    };
    let nominal = mean(before.values.as_slice(), &|_| true);
    let mut held_out = 0.0;
    for late in [false, true] {
        let fit = Ledger::new(after, |at| at.late == late).fit(&bench.accepted_terms(&[]));
        held_out += 0.5 * mean(&shares::residual(bench, after, &fit, None), &|i| after.at[i].late != late);
    }
    let per_channel = CHANNELS
        .iter()
        .enumerate()
        .map(|(channel, name)| {
            let fit = ChannelFit {
                before: mean(before.values.as_slice(), &|i| before.at[i].channel == channel),
                after: mean(&left, &|i| after.at[i].channel == channel),
            };
            (name.to_string(), fit)
        })
        .collect();
    FitReport {
        before: Pair { train: nominal, held_out: nominal },
        after: Pair { train: mean(&left, &|_| true), held_out },
        per_channel,
    }
}
