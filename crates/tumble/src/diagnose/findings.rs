//! From a finished search to the answer.

use nalgebra::DVector;

use super::catalogue::Parameter;
use super::diagnosis::{ChannelFit, FitReport, Found, Pair, Place, RunnerUp, Value};
use super::held_out;
use super::search::bench::Bench;
use super::search::ledger::{Fit, Ledger, Term};
use super::search::select::{self, Score, Selection};
use super::search::unknown::{self, ALIAS};
use super::twin::noise::Noise;
use super::twin::rows::{CHANNELS, Rows};

/// Two explanations whose evidence differs by less than odds of 20 to 1 are tied.
pub const TIE: f64 = 3.0;
/// Reported numbers are freed of the prior: its widths are taken this much larger.
const FREE: f64 = 10.0;
/// A channel is named where at least this share of an effect's signal lies.
const SHARE: f64 = 0.15;

/// What one accepted effect comes to, with its signal for pictures.
pub struct Finding {
    /// For the answer.
    pub found: Found,
    /// Its share in every row of `rows`.
    pub signal: Vec<f64>,
}

/// All accepted effects, the strongest first.
pub fn findings(bench: &mut Bench, selection: &Selection, origin_s: f64) -> Vec<Finding> {
    let mut findings: Vec<Finding> =
        (0..bench.accepted.len()).map(|k| finding(bench, selection, k, origin_s)).collect();
    findings.sort_by(|a, b| b.found.evidence.total_cmp(&a.found.evidence));
    findings
}

fn finding(bench: &mut Bench, selection: &Selection, k: usize, origin_s: f64) -> Finding {
    let accepted = bench.accepted[k].clone();
    let card = bench.candidates[accepted.candidate].effect.card;
    let evidence = selection.evidence - select::without(bench, k);
    let rivals = rivals(bench, selection, k);
    let ledger = Ledger::new(&selection.after, |_| true);
    let walk = bench.candidates[accepted.candidate].walk;
    let (parameters, signal) = match walk {
        Some((gyro, unit_si, unit)) => {
            (vec![walk_value(bench, gyro, unit_si, unit)], vec![0.0; selection.after.at.len()])
        }
        None => shift_values(bench, &selection.after, &ledger, k),
    };
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
    Finding { found, signal }
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
        if bench.candidates[removed.candidate].walk.is_some() {
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
    let Some(placed) = bench.candidates[accepted.candidate].variants.get(accepted.variant) else { return Vec::new() };
    let columns: Vec<usize> = placed.columns.clone().collect();
    let fit = ledger.fit(&bench.accepted_terms(None));
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

/// θ of an accepted effect: what is in the fit and what was taken out.
fn total(bench: &Bench, fit: &Fit, k: usize) -> DVector<f64> {
    let before: usize = (0..k).map(|j| parameters(bench, j)).sum();
    let taken = &bench.accepted[k].taken;
    DVector::from_fn(parameters(bench, k), |i, _| fit.theta[before + i] + taken[i])
}

pub(super) fn parameters(bench: &Bench, k: usize) -> usize {
    let accepted = &bench.accepted[k];
    bench.candidates[accepted.candidate].variants.get(accepted.variant).map_or(0, |placed| placed.parameters.len())
}

pub(super) fn freed(terms: Vec<Term>) -> Vec<Term> {
    terms.into_iter().map(|term| Term { width: FREE * term.width, ..term }).collect()
}

/// An accepted effect's numbers, freed of the prior, and its share in every row.
pub fn shift_values(bench: &Bench, rows: &Rows, ledger: &Ledger, k: usize) -> (Vec<Value>, Vec<f64>) {
    let fit = ledger.fit(&freed(bench.accepted_terms(None)));
    let total = total(bench, &fit, k);
    let before: usize = (0..k).map(|j| parameters(bench, j)).sum();
    let accepted = &bench.accepted[k];
    let placed = &bench.candidates[accepted.candidate].variants[accepted.variant];
    let count = placed.parameters.len();
    let covariance = fit.covariance.view((before, before), (count, count)).into_owned();
    let (own, covariance) = match &placed.own {
        Some(own) => (own * &total, own * covariance * own.transpose()),
        None => (total.clone(), covariance),
    };
    let value = |(i, parameter): (usize, &Parameter)| Value {
        name: parameter.name.clone(),
        value: own[i],
        sigma: covariance[(i, i)].sqrt(),
        unit: parameter.unit.into(),
    };
    let mut values: Vec<Value> = placed.parameters.iter().enumerate().map(value).collect();
    if let Some((name, value, unit)) = placed.setting {
        let sigma = setting_sigma(bench, ledger, k);
        values.push(Value { name: name.into(), value, sigma, unit: unit.into() });
    }
    let signal = (0..rows.at.len())
        .map(|i| placed.columns.clone().enumerate().map(|(j, column)| rows.responses[(i, column)] * total[j]).sum())
        .collect();
    (values, signal)
}

/// Spread of the setting (a time, a time constant) over the variants, each by its evidence.
fn setting_sigma(bench: &Bench, ledger: &Ledger, k: usize) -> f64 {
    let accepted = &bench.accepted[k];
    let mut others = bench.accepted_terms(Some(k));
    others.extend(bench.put_back(accepted));
    let variants = &bench.candidates[accepted.candidate].variants;
    let weights: Vec<(f64, f64)> = (0..variants.len())
        .filter_map(|variant| {
            let mut terms = others.clone();
            // The variant in force: put-back and itself share columns; free ones replace the fixed.
            terms.retain(|term| !variants[variant].columns.contains(&term.column));
            let taken: &[f64] = if variant == accepted.variant { &accepted.taken } else { &[] };
            terms.extend(bench.terms(accepted.candidate, variant, accepted.widening, taken));
            Some((variants[variant].setting?.1, ledger.fit(&terms).evidence))
        })
        .collect();
    let most = weights.iter().map(|weight| weight.1).fold(f64::NEG_INFINITY, f64::max);
    let share = |evidence: f64| (evidence - most).exp();
    let sum: f64 = weights.iter().map(|weight| share(weight.1)).sum();
    let mean: f64 = weights.iter().map(|weight| weight.0 * share(weight.1)).sum::<f64>() / sum;
    let spread = weights.iter().map(|w| (w.0 - mean).powi(2) * share(w.1)).sum::<f64>() / sum;
    // Between two neighbours nothing is known: a step is uniform over its grid.
    let mut settings: Vec<f64> = weights.iter().map(|weight| weight.0).collect();
    settings.sort_by(f64::total_cmp);
    let at = variants[accepted.variant].setting.map_or(0.0, |setting| setting.1);
    let grid = settings.windows(2).filter(|w| w[0] <= at && at <= w[1]).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    (spread + grid * grid / 12.0).sqrt()
}

/// A walk's size by its own likelihood: the maximum, and the curvature in its logarithm.
fn walk_value(bench: &mut Bench, gyro: bool, unit_si: f64, unit: &'static str) -> Value {
    let noise = bench.twin.noise;
    let terms = bench.accepted_terms(None);
    let with = |factor: f64| {
        if gyro {
            Noise { bias_walk: noise.bias_walk * factor, ..noise }
        } else {
            Noise { force_walk: noise.force_walk * factor, ..noise }
        }
    };
    let mut evidence = |log: f64| bench.fit_alone(with(log.exp()), &terms).evidence;
    // Newton's method on a parabola through three points, twice.
    let (mut at, mut sigma_log) = (0.0, 1.0);
    for step in [0.7, 0.3] {
        let [low, middle, high] = [at - step, at, at + step].map(&mut evidence);
        let curvature = (2.0 * middle - low - high) / (step * step);
        if curvature <= 0.0 {
            break;
        }
        at += ((high - low) / (2.0 * step) / curvature).clamp(-1.5, 1.5);
        sigma_log = curvature.sqrt().recip();
    }
    bench.twin.noise = with(at.exp());
    bench.wander = (bench.twin.noise.bias_walk, bench.twin.noise.force_walk);
    let density = if gyro { bench.twin.noise.bias_walk } else { bench.twin.noise.force_walk };
    let value = density.sqrt() / unit_si;
    Value { name: "q".into(), value, sigma: 0.5 * sigma_log * value, unit: unit.into() }
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

/// Mean squares before and after, on rows fitted and on rows left out.
pub fn fit_report(bench: &Bench, selection: &Selection) -> FitReport {
    let (before, after) = (&selection.before, &selection.after);
    let left = held_out::left(bench, after);
    let mean = |values: &[f64], keep: &dyn Fn(usize) -> bool| {
        let kept = || values.iter().enumerate().filter(|(i, _)| keep(*i));
        kept().map(|(_, v)| v * v).sum::<f64>() / kept().count().max(1) as f64
    };
    let nominal = mean(before.values.as_slice(), &|_| true);
    let mut held_out = 0.0;
    for late in [false, true] {
        let fit = Ledger::new(after, |at| at.late == late).fit(&bench.accepted_terms(None));
        held_out += 0.5 * mean(&held_out::residual(bench, after, &fit, None), &|i| after.at[i].late != late);
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
