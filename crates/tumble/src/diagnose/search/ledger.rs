//! Evidence of a linear model of the rows, from sums of products that are formed once, each when it is first asked for: of a
//! thousand columns' products a search needs some in a thousand.
//!
//! Rows `e = E θ + noise`, prior `θ ~ N(m, diag(w²))`. In each class of rows the noise's sigma is 1, or larger if the rows
//! themselves say so: it is maximised over `s ≥ 1`, so that a class that scatters more than the model believes costs
//! every candidate alike and passes for no effect. For the rest θ is integrated out exactly:
//!
//! `ln p = −½ Σ_c [N_c ln s_c² + RSS_c / s_c²] − ½ Σ (θ̂−m)²/w² − ½ ln det(I + W Eᵀ S⁻² E) − Σ ln σ`.

use std::cell::RefCell;
use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use crate::diagnose::twin::rows::{Address, Class, Rows};

/// Rounds of weights and estimates: the weights settle geometrically.
const ROUNDS: usize = 4;

/// Number of [`Class::ALL`].
const CLASSES: usize = 6;

/// The rows of one class.
struct Share {
    count: f64,
    squares: f64,
    responses: DMatrix<f64>,
    moments: DVector<f64>,
}

/// The same terms over rows that carry their columns alone, in this order.
pub fn by_place(terms: &[Term]) -> Vec<Term> {
    terms.iter().enumerate().map(|(column, term)| Term { column, ..*term }).collect()
}

/// Products of rows and responses, class by class.
pub struct Ledger {
    classes: [Share; CLASSES],
    log_sigma: f64,
    /// `Eᵢᵀ Eⱼ` of columns i ≤ j.
    products: RefCell<HashMap<(usize, usize), [f64; CLASSES]>>,
    /// s² where it is not maximised.
    fixed: [Option<f64>; CLASSES],
}

/// One column of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// In the responses.
    pub column: usize,
    /// Prior's sigma.
    pub width: f64,
    /// Prior's mean: minus what has been taken out of the samples already.
    pub mean: f64,
}

/// A model's best numbers.
#[derive(Clone, Debug)]
pub struct Fit {
    /// ln p.
    pub evidence: f64,
    /// θ̂, in the order of the terms.
    pub theta: DVector<f64>,
    /// Its covariance.
    pub covariance: DMatrix<f64>,
    /// s² of every class, in the order of [`Class::ALL`].
    pub scales: [f64; CLASSES],
}

impl Ledger {
    /// Of the rows that `keep` keeps.
    pub fn new(rows: &Rows, keep: impl Fn(&Address) -> bool) -> Self {
        let classes = Class::ALL.map(|class| {
            let chosen: Vec<usize> =
                (0..rows.at.len()).filter(|&i| rows.at[i].class == class && keep(&rows.at[i])).collect();
            let responses = rows.responses.select_rows(&chosen);
            let values = rows.values.select_rows(&chosen);
            let moments = responses.tr_mul(&values);
            Share { count: chosen.len() as f64, squares: values.norm_squared(), responses, moments }
        });
        Self { classes, log_sigma: rows.log_sigma, products: RefCell::default(), fixed: [None; CLASSES] }
    }

    fn product(&self, i: usize, j: usize) -> [f64; CLASSES] {
        let key = (i.min(j), i.max(j));
        let made = || self.classes.each_ref().map(|share| share.responses.column(i).dot(&share.responses.column(j)));
        *self.products.borrow_mut().entry(key).or_insert_with(made)
    }

    /// This class's noise is as believed: the belief itself is what is estimated.
    #[must_use]
    pub fn believing(mut self, class: Class) -> Self {
        Class::ALL
            .iter()
            .zip(&mut self.fixed)
            .filter(|(one, _)| **one == class)
            .for_each(|(_, fixed)| *fixed = Some(1.0));
        self
    }

    /// All classes at these scales.
    #[must_use]
    pub fn at(mut self, scales: &[f64; CLASSES]) -> Self {
        self.fixed = scales.map(Some);
        self
    }

    /// A fit's scales where a class scatters more than chance would have it, else 1.
    pub fn certain(&self, fit: &Fit) -> [f64; CLASSES] {
        let mut scales = fit.scales;
        for (scale, class) in scales.iter_mut().zip(Class::ALL) {
            if !self.is_exceeded(fit, class) {
                *scale = 1.0;
            }
        }
        scales
    }

    /// Does a class scatter more than chance would have it: by four sigma of `2/N`?
    pub fn is_exceeded(&self, fit: &Fit, class: Class) -> bool {
        let mut all = Class::ALL.iter().zip(&fit.scales).zip(&self.classes);
        all.any(|((one, scale), share)| *one == class && *scale >= 1.0 + 4.0 * (2.0 / share.count.max(1.0)).sqrt())
    }

    /// The model of these terms; an empty one is the null.
    pub fn fit(&self, terms: &[Term]) -> Fit {
        let n = terms.len();
        let mut fit = Fit {
            evidence: f64::NEG_INFINITY,
            theta: DVector::zeros(n),
            covariance: DMatrix::zeros(n, n),
            scales: self.fixed.map(|fixed| fixed.unwrap_or(1.0)),
        };
        let (grams, moments) = self.chosen(terms);
        for round in 0..ROUNDS {
            let Some(log_det) = solve(terms, &grams, &moments, &mut fit) else { return fit };
            let prior: f64 = terms
                .iter()
                .zip(fit.theta.iter())
                .map(|(term, theta)| ((theta - term.mean) / term.width).powi(2))
                .sum();
            let mut evidence = -0.5 * prior - 0.5 * log_det - self.log_sigma;
            let mut scales = [1.0; CLASSES];
            for (k, class) in self.classes.iter().enumerate() {
                let left = class.squares - 2.0 * fit.theta.dot(&moments[k]) + fit.theta.dot(&(&grams[k] * &fit.theta));
                scales[k] = self.fixed[k].unwrap_or((left / class.count.max(1.0)).max(1.0));
                evidence -= 0.5 * (class.count * f64::ln(fit.scales[k]) + left / fit.scales[k]);
            }
            fit.evidence = evidence;
            if round + 1 < ROUNDS {
                fit.scales = scales;
            }
        }
        fit
    }

    /// Weighted `EᵀE` of two sets of columns, at these scales.
    pub fn gram(&self, scales: &[f64; CLASSES], rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            self.product(rows[i], columns[j]).iter().zip(scales).map(|(product, scale)| product / scale).sum()
        })
    }

    fn chosen(&self, terms: &[Term]) -> (Vec<DMatrix<f64>>, Vec<DVector<f64>>) {
        let n = terms.len();
        let mut grams = vec![DMatrix::zeros(n, n); CLASSES];
        for i in 0..n {
            for j in i..n {
                let product = self.product(terms[i].column, terms[j].column);
                for (gram, product) in grams.iter_mut().zip(product) {
                    (gram[(i, j)], gram[(j, i)]) = (product, product);
                }
            }
        }
        let moments = self.classes.iter().map(|share| DVector::from_fn(n, |i, _| share.moments[terms[i].column]));
        (grams, moments.collect())
    }
}

/// θ̂ and its covariance at the fit's scales; `ln det(I + W A)`.
fn solve(terms: &[Term], grams: &[DMatrix<f64>], moments: &[DVector<f64>], fit: &mut Fit) -> Option<f64> {
    let n = terms.len();
    let mut matrix = DMatrix::from_diagonal(&DVector::from_fn(n, |i, _| terms[i].width.powi(-2)));
    let mut right = DVector::from_fn(n, |i, _| terms[i].mean * terms[i].width.powi(-2));
    for (k, (gram, moment)) in grams.iter().zip(moments).enumerate() {
        matrix += gram / fit.scales[k];
        right += moment / fit.scales[k];
    }
    // Scaled to unit widths: parameters differ by many decades.
    let widths = DVector::from_fn(n, |i, _| terms[i].width);
    let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] * widths[i] * widths[j]);
    let cholesky = scaled.cholesky()?;
    fit.theta = cholesky.solve(&right.component_mul(&widths)).component_mul(&widths);
    let inverse = cholesky.inverse();
    fit.covariance = DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * widths[i] * widths[j]);
    Some(2.0 * cholesky.l_dirty().diagonal().iter().map(|v| v.ln()).sum::<f64>())
}

/// Probabilities by evidence, all as likely before it: `pᵢ = exp(ln pᵢ − ln Σ exp ln p)`; none where nothing is finite.
pub fn posterior(evidence: impl IntoIterator<Item = f64>) -> Option<Vec<f64>> {
    let evidence: Vec<f64> = evidence.into_iter().collect();
    let most = evidence.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !most.is_finite() {
        return None;
    }
    let sum: f64 = evidence.iter().map(|one| (one - most).exp()).sum();
    Some(evidence.iter().map(|one| (one - most).exp() / sum).collect())
}

/// `ln mean exp`.
pub fn log_mean(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !most.is_finite() {
        return most;
    }
    most + (values.iter().map(|value| (value - most).exp()).sum::<f64>() / values.len() as f64).ln()
}

#[cfg(test)]
mod tests {
    use super::posterior;

    #[test]
    fn probabilities_by_evidence() {
        let found = posterior([-500.0, -500.0, -600.0]).expect("it is finite");
        assert!((found[0] - 0.5).abs() < 1e-12 && (found[1] - 0.5).abs() < 1e-12 && found[2] < 1e-40);
        assert_eq!(posterior([f64::NEG_INFINITY]), None);
    }
}
