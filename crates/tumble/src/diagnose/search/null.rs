//! What chance alone does on this very recording's geometry and noise: the threshold.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use tumble_sim::rng::{Purpose, Rng};

use super::bench::{Bench, WIDENINGS};
use super::ledger::{Term, log_mean};
use crate::diagnose::twin::rows::{Class, Rows};

/// Draws of the linearised problem.
pub const DRAWS: usize = 3000;
/// False alarms of the whole search, over all candidates.
pub const FALSE_ALARMS: f64 = 0.003;
/// Evidence less than this (odds of 100 to 1) is never enough, whatever the draws say.
const LEAST: f64 = 4.6;

struct Weigher {
    columns: std::ops::Range<usize>,
    widths: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    log_det: f64,
}

/// Evidence that the best candidate reaches by chance in all but [`FALSE_ALARMS`] of cases.
pub fn threshold(bench: &Bench, rows: &Rows, scales: &[f64; 6], seed: u64) -> f64 {
    let weighted = weighted(bench, rows, scales);
    let gram = weighted.transpose() * &weighted;
    let weighers: Vec<Vec<Weigher>> = (0..bench.candidates.len())
        .map(|candidate| {
            (0..bench.candidates[candidate].variants.len())
                .flat_map(|variant| WIDENINGS.map(|widening| bench.terms(candidate, variant, widening, &[])))
                .filter_map(|terms| weigher(&terms, &gram))
                .collect()
        })
        .collect();
    let Some(root) = root(&gram) else { return LEAST };
    let mut rng = Rng::new(seed, Purpose::Scheme);
    let noise = DMatrix::from_fn(root.ncols(), DRAWS, |_, _| rng.normal());
    let moments = root * noise;
    let mut most: Vec<f64> = moments.column_iter().map(|draw| strongest(&weighers, &draw.into_owned())).collect();
    most.sort_by(f64::total_cmp);
    most[((1.0 - FALSE_ALARMS) * DRAWS as f64) as usize].max(LEAST)
}

fn weighted(bench: &Bench, rows: &Rows, scales: &[f64; 6]) -> DMatrix<f64> {
    let mut weighted = rows.responses.columns(0, bench.candidate_columns()).into_owned();
    for (i, at) in rows.at.iter().enumerate() {
        let class = Class::ALL.iter().position(|class| *class == at.class).unwrap_or(0);
        let mut row = weighted.row_mut(i);
        row /= scales[class].sqrt();
    }
    weighted
}

/// `L Lᵀ = EᵀE`: with it a draw of the moments `Eᵀ e` costs a fifth of a draw of the rows e. Columns may depend on each
/// other, so a ten-thousand-millionth of each diagonal element is added.
fn root(gram: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let sizes = gram.diagonal().map(|v| v.max(f64::MIN_POSITIVE).sqrt());
    let unit = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| {
        gram[(i, j)] / (sizes[i] * sizes[j]) + if i == j { 1e-10 } else { 0.0 }
    });
    let mut root = unit.cholesky()?.unpack();
    root.row_iter_mut().zip(sizes.iter()).for_each(|(mut row, size)| row *= *size);
    Some(root)
}

fn weigher(terms: &[Term], gram: &DMatrix<f64>) -> Option<Weigher> {
    let first = terms.first()?.column;
    let n = terms.len();
    let widths = DVector::from_fn(n, |i, _| terms[i].width);
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        gram[(first + i, first + j)] * widths[i] * widths[j] + if i == j { 1.0 } else { 0.0 }
    });
    let factor = scaled.cholesky()?;
    let log_det = 2.0 * factor.l_dirty().diagonal().iter().map(|v| v.ln()).sum::<f64>();
    Some(Weigher { columns: first..first + n, widths, factor, log_det })
}

fn strongest(weighers: &[Vec<Weigher>], moments: &DVector<f64>) -> f64 {
    weighers
        .iter()
        .map(|variants| {
            let evidence: Vec<f64> = variants.iter().map(|weigher| weigher.evidence(moments)).collect();
            if evidence.is_empty() { f64::NEG_INFINITY } else { log_mean(&evidence) }
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

impl Weigher {
    fn evidence(&self, moments: &DVector<f64>) -> f64 {
        let right = moments.rows(self.columns.start, self.columns.len()).component_mul(&self.widths);
        0.5 * right.dot(&self.factor.solve(&right)) - 0.5 * self.log_det
    }
}
