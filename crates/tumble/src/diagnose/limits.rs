//! What a recording could have shown.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::diagnosis::Limit;
use super::gates::chance::shift_seen;
use super::judge::BESIDE_GATES;
use super::search::bench::{Bench, Candidate, HEALTHY, WANDERING, WIDENINGS, with_walks};
use super::search::ledger::{Ledger, Term};
use super::search::select::Selection;
use super::twin::noise::walk_floor;
use super::walk_limit;

/// Where the worst limit is above this many times the median, it is said.
const UNEVEN: f64 = 3.0;
/// … and where it is above this many, that it does not show there.
const NOWHERE: f64 = 30.0;

/// What the recording could have shown, with 95 % certainty, by the threshold in force.
///
/// The noise is the most that a healthy sensor may have: the null is free to excuse an effect as wander, up to 10 mdps and
/// 100 µg in 100 s, so that what it can excuse is no evidence. (At the noise of a quiet recording, limits of what is slow came
/// out at half of what was found in truth.)
///
/// Beside what was found: a bias that wanders is noise to all else, and what another effect's columns explain of a candidate's is no
/// evidence for it. (By the null's noise a sensitivity to force at twice its limit was missed beside a walk, three times of five.)
///
/// `beside_gates`: names need the odds that no trace of a distorted sample reaches, and no walk is named.
pub fn limits(bench: &mut Bench, selection: &Selection, beside_gates: bool) -> Vec<Limit> {
    let kept = bench.twin.noise;
    let most = HEALTHY[HEALTHY.len() - 1];
    let noise = if bench.accepted.is_empty() { selection.null_noise } else { selection.noise };
    let rows = bench.rows(bench.with_accepted_walks(&with_walks(&noise, most, most), &[]));
    bench.twin.noise = kept;
    let ledger = Ledger::new(&rows, |_| true);
    let bench = &*bench;
    let scales =
        if bench.accepted.is_empty() { selection.null_scales } else { ledger.fit(&bench.accepted_terms(&[])).scales };
    let needed = if beside_gates { selection.threshold.max(BESIDE_GATES) } else { selection.threshold };
    let limit_of = |(index, candidate): (usize, &Candidate)| {
        let itself: Vec<usize> = (0..bench.accepted.len()).filter(|k| bench.accepted[*k].candidate == index).collect();
        let asked = Asked {
            scales: &scales,
            needed,
            beside_gates,
            beside: bench.accepted_terms(&itself),
            candidates: &bench.candidates,
        };
        limit(candidate, &asked, &ledger)
    };
    bench.candidates.iter().enumerate().map(limit_of).collect()
}

/// One an effect, where a gate and the twin can both show it: the finer.
pub fn one_each(limits: impl Iterator<Item = Limit>) -> Vec<Limit> {
    let mut each: Vec<Limit> = Vec::new();
    for limit in limits {
        match each.iter_mut().find(|other| other.id == limit.id) {
            Some(other) if limit.testable && (!other.testable || limit.limit < other.limit) => *other = limit,
            Some(_) => {}
            None => each.push(limit),
        }
    }
    each
}

/// What a name has to show.
struct Asked<'a> {
    scales: &'a [f64; 6],
    /// ln of the odds.
    needed: f64,
    beside_gates: bool,
    /// Found as well.
    beside: Vec<Term>,
    candidates: &'a [Candidate],
}

fn limit(candidate: &Candidate, asked: &Asked, ledger: &Ledger) -> Limit {
    let id = candidate.effect.card.id.to_string();
    let none = |why: &str, unit: &str| Limit {
        id: id.clone(),
        limit: f64::MAX,
        unit: unit.into(),
        fisher_sigmas: None,
        testable: false,
        why: why.into(),
    };
    if let Some(why) = candidate.absent {
        return none(why, "");
    }
    if let Some((gyro, unit_si, unit)) = candidate.walk {
        if asked.beside_gates {
            return none("what distorts the samples leaves traces that wander as well", unit);
        }
        // What is more than healthy by the first level that counts, or what shows.
        let least = (walk_floor(gyro) * 4.0 * HEALTHY[HEALTHY.len() - 1]).sqrt() / unit_si;
        return match walk(asked, ledger, gyro, least) {
            Some(limit) => Limit { limit, testable: true, ..none("", unit) },
            None => none("no walk would show: too few rests, or too near in time", unit),
        };
    }
    // The median over parameters and variants: axes and, of what begins at some time, times.
    let mut limits = limits_alone(candidate, asked, ledger);
    limits.sort_by(|a, b| a.limit.total_cmp(&b.limit));
    let (Some(&Alone { limit, width, unit, sigmas }), Some(&Alone { limit: worst, .. })) =
        (limits.get(limits.len() / 2), limits.last())
    else {
        return none("nothing in this recording depends on it", "");
    };
    let testable = limit < 10.0 * width;
    let why = match () {
        () if !testable => format!("only a size of {limit:.2} {unit} would show; usual are up to {width} {unit}"),
        () if worst > NOWHERE * limit => "for half of all axes and times; at some it would not show".into(),
        () if worst > UNEVEN * limit => {
            format!("for half of all axes and times; {worst:.2} {unit} where it shows least")
        }
        () => String::new(),
    };
    Limit { id, limit, unit: unit.into(), fisher_sigmas: Some(sigmas), testable, why }
}

/// Of one parameter.
struct Alone {
    limit: f64,
    /// Its prior's.
    width: f64,
    unit: &'static str,
    /// The limit over its Fisher bound.
    sigmas: f64,
}

/// Of each parameter of each variant alone, the others zero, at the price of them all.
fn limits_alone(candidate: &Candidate, asked: &Asked, ledger: &Ledger) -> Vec<Alone> {
    let mut limits = Vec::new();
    for placed in &candidate.variants {
        let columns: Vec<usize> = placed.columns.clone().collect();
        let information = information(ledger, asked, &columns);
        let hypotheses = (candidate.variants.len() * WIDENINGS.len()) as f64;
        let priors: Vec<Prior> = WIDENINGS
            .into_iter()
            .filter_map(|widening| {
                let widths = placed.parameters.iter().map(|parameter| widening * parameter.width);
                Prior::new(&information, DVector::from_iterator(columns.len(), widths))
            })
            .collect();
        for (i, parameter) in placed.parameters.iter().enumerate().filter(|(i, _)| information[(*i, *i)] > 0.0) {
            let dof = columns.len() as f64;
            let square = |prior: &Prior| {
                shift_seen(2.0 * (asked.needed + hypotheses.ln() + prior.occam), dof) / prior.kept(&information, i)
            };
            let least = priors.iter().map(square).fold(f64::INFINITY, f64::min);
            let limit = (least / information[(i, i)]).sqrt();
            // Of numbers that go together without end the bound is that of the one alone.
            let bound = information.clone().try_inverse().map(|covariance| covariance[(i, i)]).filter(|v| *v > 0.0);
            let sigmas = limit / bound.unwrap_or(1.0 / information[(i, i)]).sqrt();
            limits.push(Alone { limit, width: parameter.width, unit: parameter.unit, sigmas });
        }
    }
    limits
}

/// One width of the mixture.
struct Prior {
    widths: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    /// `½ ln det(I + W I W)`.
    occam: f64,
}

impl Prior {
    fn new(information: &DMatrix<f64>, widths: DVector<f64>) -> Option<Self> {
        let scaled = DMatrix::from_fn(widths.len(), widths.len(), |i, j| {
            information[(i, j)] * widths[i] * widths[j] + if i == j { 1.0 } else { 0.0 }
        });
        let factor = scaled.cholesky()?;
        let occam = factor.l_dirty().diagonal().iter().map(|v| v.ln()).sum();
        Some(Self { widths, factor, occam })
    }

    /// What is left of χ² where one number is what it is and all are shrunk.
    fn kept(&self, information: &DMatrix<f64>, one: usize) -> f64 {
        let pull = information.column(one).component_mul(&self.widths);
        pull.dot(&self.factor.solve(&pull)) / information[(one, one)]
    }
}

/// The walk that shows, in its unit: a thousandth of a step's. Every level is as likely before.
fn walk(asked: &Asked, ledger: &Ledger, gyro: bool, least: f64) -> Option<f64> {
    let id = if gyro { "gyro_bias_step" } else { "accel_bias_step" };
    let Some(steps) = asked.candidates.iter().find(|candidate| candidate.effect.card.id == id) else {
        return Some(least);
    };
    let steps = steps.variants.iter().filter_map(|placed| Some((placed.setting?.1, placed.columns.clone())));
    let (times_s, columns): (Vec<f64>, Vec<_>) = walk_limit::thinned(steps.collect()).into_iter().unzip();
    let columns: Vec<usize> = columns.into_iter().flatten().collect();
    let needed = asked.needed + (WANDERING.len() as f64).ln();
    walk_limit::limit(&information(ledger, asked, &columns), &times_s, 1e-3, needed, least)
}

/// What the rows say of some columns where those beside are free within their priors: `I − C (B + W⁻²)⁻¹ Cᵀ`.
fn information(ledger: &Ledger, asked: &Asked, columns: &[usize]) -> DMatrix<f64> {
    let own = ledger.gram(asked.scales, columns, columns);
    let beside: Vec<usize> = asked.beside.iter().map(|term| term.column).collect();
    let mut theirs = ledger.gram(asked.scales, &beside, &beside);
    asked.beside.iter().enumerate().for_each(|(i, term)| theirs[(i, i)] += term.width.powi(-2));
    let shared = ledger.gram(asked.scales, columns, &beside);
    theirs.cholesky().map_or(own.clone(), |factor| &own - &shared * factor.solve(&shared.transpose()))
}

#[cfg(test)]
mod tests {
    use super::one_each;
    use crate::diagnose::diagnosis::Limit;

    #[test]
    fn the_finer_of_two_limits_stands() {
        let limit = |limit: f64, testable: bool| Limit {
            id: "incomplete_turn".into(),
            limit,
            unit: "deg".into(),
            fisher_sigmas: None,
            testable,
            why: String::new(),
        };
        let each = one_each([limit(0.6, true), limit(22.6, true)].into_iter());
        assert_eq!((each.len(), each[0].limit), (1, 0.6));
        let each = one_each([limit(0.0, false), limit(22.6, true)].into_iter());
        assert_eq!((each.len(), each[0].limit), (1, 22.6));
    }
}
