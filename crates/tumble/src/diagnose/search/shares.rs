//! What each accepted effect has in the fit and in the rows.

use super::bench::Bench;
use super::ledger::{Fit, Ledger, Term};
use crate::diagnose::twin::rows::Rows;

/// Reported numbers are freed of the prior: its widths are taken this much larger.
const FREE: f64 = 10.0;

/// How many parameters an accepted effect has in the fit.
pub fn parameters(bench: &Bench, k: usize) -> usize {
    bench.placed(&bench.accepted[k]).map_or(0, |placed| placed.parameters.len())
}

/// The same terms with priors so wide that they tell nothing.
pub fn freed(terms: Vec<Term>) -> Vec<Term> {
    terms.into_iter().map(|term| Term { width: FREE * term.width, ..term }).collect()
}

/// Rows less what the accepted effects explain, but for one.
pub fn residual(bench: &Bench, rows: &Rows, fit: &Fit, but: Option<usize>) -> Vec<f64> {
    let terms = bench.accepted_terms(&[]);
    let mut of = Vec::new();
    (0..bench.accepted.len()).for_each(|k| of.extend(std::iter::repeat_n(k, parameters(bench, k))));
    (0..rows.at.len())
        .map(|i| {
            let explained: f64 = terms
                .iter()
                .enumerate()
                .filter(|(j, _)| Some(of[*j]) != but)
                .map(|(j, term)| rows.responses[(i, term.column)] * fit.theta[j])
                .sum();
            rows.values[i] - explained
        })
        .collect()
}

/// Rows less what all accepted effects explain.
pub fn left(bench: &Bench, rows: &Rows) -> Vec<f64> {
    let fit = Ledger::new(rows, |_| true).fit(&bench.accepted_terms(&[]));
    residual(bench, rows, &fit, None)
}
