//! Does an effect improve rows that it was not fitted to, and is it the same in both halves?

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::diagnosis::HeldOut;
use super::search::bench::Bench;
use super::search::ledger::{Fit, Ledger, Term};
use super::search::shares::{freed, parameters, residual};
use super::twin::rows::Rows;

/// An effect that shows almost only in one half of the rows, such as one turn's end, cannot be tried on the other.
const LEAST_HALF: f64 = 0.05;
/// Of a prior's width: as good as fixed.
const HELD: f64 = 1e-6;

/// Halves of every position, both ways.
pub fn held_out(bench: &Bench, rows: &Rows, k: usize) -> Option<HeldOut> {
    let first: usize = (0..k).map(|j| parameters(bench, j)).sum();
    let count = parameters(bench, k);
    let terms = bench.accepted_terms(&[]);
    let columns: Vec<usize> = terms[first..first + count].iter().map(|term| term.column).collect();
    let halves = [false, true].map(|late| Ledger::new(rows, |at| at.late == late));
    let all = Ledger::new(rows, |_| true).fit(&terms);
    let [early, late] = halves.each_ref().map(|half| half.gram(&all.scales, &columns, &columns).trace());
    if early.min(late) < LEAST_HALF * early.max(late) {
        return None;
    }
    let taken = DVector::from_column_slice(&bench.accepted[k].taken);
    // The rows have `taken` removed already, and the other effects at their best from all rows.
    let rest = residual(bench, rows, &all, Some(k));
    let response = |i: usize, theta: &DVector<f64>| -> f64 {
        columns.iter().enumerate().map(|(j, &column)| rows.responses[(i, column)] * theta[j]).sum()
    };
    let own = first..first + count;
    let alone = beside(&terms, &all, &own);
    let freed = freed(terms);
    let mut sums = [0.0; 2];
    let mut fits = Vec::new();
    for (late, ledger) in [false, true].into_iter().zip(&halves) {
        let predicted = ledger.fit(&alone).theta.rows(first, count) + &taken;
        for i in (0..rows.at.len()).filter(|&i| rows.at[i].late != late) {
            let without = rest[i] + response(i, &taken);
            sums[0] += without * without;
            sums[1] += (without - response(i, &predicted)).powi(2);
        }
        let fit = ledger.fit(&freed);
        let covariance = fit.covariance.view((first, first), (count, count)).into_owned();
        fits.push((fit.theta.rows(first, count) + &taken, covariance));
    }
    let count_rows = rows.at.len() as f64;
    Some(HeldOut { before: sums[0] / count_rows, after: sums[1] / count_rows, constancy_p: constancy(&fits) })
}

/// The terms with all but some held at a fit's numbers. What half of the rows tells of two effects apart may be nothing, though it tells
/// their sum well: left free, a step with a square beside it, at odds of e⁷⁰ and e⁵⁰, foretold the other half worse than nothing did. For
/// the same reason the effect keeps its prior: what half of the rows leaves open is zero, and not whatever noise makes it.
fn beside(terms: &[Term], fit: &Fit, own: &Range<usize>) -> Vec<Term> {
    let held = |(i, term): (usize, &Term)| match own.contains(&i) {
        true => *term,
        false => Term { mean: fit.theta[i], width: HELD * term.width, ..*term },
    };
    terms.iter().enumerate().map(held).collect()
}

/// Chow's test: the halves' parameters differ by no more than their covariances say; χ² by Wilson & Hilferty (1931).
fn constancy(fits: &[(DVector<f64>, DMatrix<f64>)]) -> f64 {
    let [first, second] = fits else { return 1.0 };
    let difference = &first.0 - &second.0;
    let Some(factor) = (&first.1 + &second.1).cholesky() else { return 1.0 };
    chi_square_tail(difference.dot(&factor.solve(&difference)), difference.len() as f64)
}

/// Probability that a χ² of `dof` degrees exceeds `value`.
fn chi_square_tail(value: f64, dof: f64) -> f64 {
    let spread = 2.0 / (9.0 * dof);
    let z = ((value / dof).cbrt() - (1.0 - spread)) / spread.sqrt();
    0.5 * libm::erfc(z / std::f64::consts::SQRT_2)
}
