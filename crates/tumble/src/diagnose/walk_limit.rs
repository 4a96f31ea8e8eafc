//! How strong a bias's random walk must be to be seen in 95 of 100 recordings like this.
//!
//! A walk of density q² is steps of variance `q² Δt` at instants Δt apart: of the rows it makes noise of covariance `C q² Δt Cᵀ`, C being the
//! steps' whitened responses. With `λᵢ` the eigenvalues of `q² √Δt CᵀC √Δt` the logarithm of the odds for the walk against none is
//! `½ Σ (λᵢ zᵢ² − ln(1 + λᵢ))`, z standard normal: its 5 % point, from draws, is what 95 of 100 recordings exceed.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use tumble_sim::rng::{Purpose, Rng};

/// Instants that steps are taken at, at most: a walk is smooth enough, and products of columns cost time.
const INSTANTS: usize = 30;
/// Draws of the odds: their 5 % point to a tenth.
const DRAWS: usize = 400;
/// Halvings of the interval in which q lies, in its logarithm.
const HALVINGS: usize = 24;
/// Largest q asked for, over the least.
const WIDEST: f64 = 1e4;

/// At most [`INSTANTS`] of them, evenly.
pub fn thinned<T>(instants: Vec<T>) -> Vec<T> {
    let every = instants.len().div_ceil(INSTANTS).max(1);
    instants.into_iter().step_by(every).collect()
}

/// The least q from `least` on at which the odds are above `needed` (ln) in 95 of 100; none if no q is, as of no steps. `gram`: what the rows say of the
/// steps, three axes an instant; `times_s`: their instants; one of q's units a root second is `unit` of the steps'.
pub fn limit(gram: &DMatrix<f64>, times_s: &[f64], unit: f64, needed: f64, least: f64) -> Option<f64> {
    if times_s.is_empty() || gram.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let since = |k: usize| if k == 0 { times_s[0] } else { times_s[k] - times_s[k - 1] };
    let root = DVector::from_fn(gram.nrows(), |i, _| unit * since(i / 3).max(0.0).sqrt());
    let scaled = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| root[i] * gram[(i, j)] * root[j]);
    let eigenvalues: Vec<f64> =
        SymmetricEigen::new(scaled).eigenvalues.iter().copied().filter(|value| *value > 0.0).collect();
    let mut rng = Rng::new(0, Purpose::Scheme);
    let draws = DMatrix::from_fn(DRAWS, eigenvalues.len(), |_, _| rng.normal().powi(2));
    let seen = |q: f64| low_odds(&eigenvalues, &draws, q * q) > needed;
    if seen(least) {
        return Some(least);
    }
    let (mut low, mut high) = (least, WIDEST * least);
    if !seen(high) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if seen(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

/// The odds' 5 % point (ln).
fn low_odds(eigenvalues: &[f64], draws: &DMatrix<f64>, factor: f64) -> f64 {
    let mut odds: Vec<f64> = draws
        .row_iter()
        .map(|draw| {
            let each = eigenvalues.iter().zip(draw.iter()).map(|(value, square)| {
                let lambda = factor * value;
                lambda * square - lambda.ln_1p()
            });
            0.5 * each.sum::<f64>()
        })
        .collect();
    odds.sort_by(f64::total_cmp);
    odds[DRAWS / 20]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forty readings of a bias with unit noise, steps between them at unit time: the limit makes 95 of 100 such walks exceed the odds asked
    /// for, counted by the exact likelihoods of drawn walks.
    #[test]
    fn the_limit_is_what_95_of_100_exceed() {
        let (readings, needed) = (30usize, 4.6);
        let columns = DMatrix::from_fn(3 * readings, 3 * readings, |row, column| {
            let (same, later) = (row % 3 == column % 3, row / 3 >= column / 3);
            if same && later { 1.0 } else { 0.0 }
        });
        let gram = columns.transpose() * &columns;
        let times: Vec<f64> = (1..=readings).map(|k| k as f64).collect();
        let q = limit(&gram, &times, 1.0, needed, 1e-4).expect("some walk is seen");
        let covariance = &columns * columns.transpose() * (q * q) + DMatrix::identity(3 * readings, 3 * readings);
        let factor = covariance.cholesky().expect("positive");
        let log_det: f64 = factor.l().diagonal().iter().map(|v| 2.0 * v.ln()).sum();
        let mut rng = Rng::new(7, Purpose::Scheme);
        let exceed = (0..500).filter(|_| {
            let walked = DVector::from_fn(3 * readings, |_, _| q * rng.normal());
            let seen = &columns * walked + DVector::from_fn(3 * readings, |_, _| rng.normal());
            0.5 * (seen.norm_squared() - seen.dot(&factor.solve(&seen)) - log_det) > needed
        });
        let share = exceed.count() as f64 / 500.0;
        assert!((0.92..0.98).contains(&share), "{share} at q {q}");
        assert_eq!(limit(&(gram * 1e-20), &times, 1.0, needed, 1e-4), None);
        assert_eq!(limit(&DMatrix::zeros(0, 0), &[], 1.0, needed, 1e-4), None);
    }
}
