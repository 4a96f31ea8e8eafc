//! Numbers of an effect whose time or time constant is itself a number: neither is known without the other.
//!
//! Variants stand on a coarse grid, which is enough to find the effect. Numbers at the best of them alone are wrong twice: the
//! truth lies between two (a step by 6 sigma a row shows to a tenth of a second when it came; the grid has some seconds), and
//! their sigma is that of a setting which is known. Here the settings are tried finely, all at a pass, and value and sigma
//! are those of the mixture: `θ̄ = Σ p θ̂`, `cov = Σ p [C + (θ̂ − θ̄)(θ̂ − θ̄)ᵀ]`, p by evidence, uniform in the setting before it.

use nalgebra::{DMatrix, DVector};

use super::catalogue::{Variant, at_any_setting};
use super::search::bench::Bench;
use super::search::ledger::{Ledger, posterior};
use super::search::shares::freed;
use super::search::sharpen::{TRIED, at_settings};
use super::twin::rows::Class;

/// Settings whose evidence is less than the best by more than this are as good as excluded: e⁻⁸.
const EXCLUDED: f64 = 8.0;
/// Grids, each as wide as what the last one left.
const ZOOMS: usize = 3;

/// Mean and covariance of the numbers, mean and sigma of the setting.
pub struct Settled {
    /// θ̄.
    pub theta: DVector<f64>,
    /// Of it.
    pub covariance: DMatrix<f64>,
    /// Mean.
    pub setting: f64,
    /// Of it.
    pub sigma: f64,
}

struct Tried {
    setting: f64,
    evidence: f64,
    theta: DVector<f64>,
    covariance: DMatrix<f64>,
}

/// The variants' settings with their evidence.
fn coarse(bench: &Bench, ledger: &Ledger, k: usize) -> Vec<(f64, f64)> {
    let accepted = &bench.accepted[k];
    let mut others = bench.accepted_terms(&[k]);
    others.extend(bench.put_back(accepted));
    let variants = &bench.candidate(accepted).variants;
    let weigh = |variant: usize| {
        let mut terms = others.clone();
        // The variant in force: put-back and itself share columns; free ones replace the fixed.
        terms.retain(|term| !variants[variant].columns.contains(&term.column));
        let taken: &[f64] = if variant == accepted.variant { &accepted.taken } else { &[] };
        terms.extend(bench.terms(accepted.candidate, variant, accepted.widening, taken));
        Some((variants[variant].setting?.1, ledger.fit(&terms).evidence))
    };
    let mut coarse: Vec<(f64, f64)> = (0..variants.len()).filter_map(weigh).collect();
    coarse.sort_by(|a, b| a.0.total_cmp(&b.0));
    coarse
}

/// Spread of a setting over the variants, each by its evidence; between two neighbours nothing is known.
pub fn sigma(bench: &Bench, ledger: &Ledger, k: usize) -> f64 {
    let coarse = coarse(bench, ledger, k);
    let Some(shares) = posterior(coarse.iter().map(|one| one.1)) else { return f64::NAN };
    let each = || coarse.iter().map(|one| one.0).zip(&shares);
    let mean: f64 = each().map(|(setting, share)| setting * share).sum();
    let spread: f64 = each().map(|(setting, share)| (setting - mean).powi(2) * share).sum();
    let accepted = &bench.accepted[k];
    let at = bench.candidate(accepted).variants[accepted.variant].setting.map_or(0.0, |setting| setting.1);
    let around = coarse.windows(2).filter(|pair| pair[0].0 <= at && at <= pair[1].0);
    let grid = around.map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max);
    (spread + grid * grid / 12.0).sqrt()
}

/// None for an effect without such a setting.
pub fn settle(bench: &mut Bench, ledger: &Ledger, k: usize) -> Option<Settled> {
    let at = at_any_setting(bench.candidate(&bench.accepted[k]).effect.card.id)?;
    let (mut low, mut high) = possible(&coarse(bench, ledger, k))?;
    let mut tried = Vec::new();
    for _ in 0..ZOOMS {
        tried = try_all(bench, k, at, low, high);
        let seen: Vec<(f64, f64)> = tried.iter().map(|one| (one.setting, one.evidence)).collect();
        let (first, last) = possible(&seen)?;
        if last - first > 0.5 * (high - low) {
            break;
        }
        (low, high) = (first.max(low), last.min(high));
    }
    mixture(&tried)
}

/// From the neighbour before the first setting that is not excluded to the one after the last; beyond a grid's end, half as much
/// again.
fn possible(weighed: &[(f64, f64)]) -> Option<(f64, f64)> {
    let most = weighed.iter().map(|one| one.1).fold(f64::NEG_INFINITY, f64::max);
    let is_possible = |one: &(f64, f64)| one.1 > most - EXCLUDED;
    let (first, last) = (weighed.iter().position(is_possible)?, weighed.iter().rposition(is_possible)?);
    let low = if first > 0 { weighed[first - 1].0 } else { 0.5 * weighed[0].0 };
    let high = weighed.get(last + 1).map_or(1.5 * weighed[last].0, |one| one.0);
    Some((low, high))
}

fn try_all(bench: &mut Bench, k: usize, at: fn(f64) -> Variant, low: f64, high: f64) -> Vec<Tried> {
    let settings: Vec<f64> = (0..TRIED).map(|i| low + (high - low) * i as f64 / (TRIED - 1) as f64).collect();
    let accepted = bench.accepted[k].clone();
    // What was taken out of the samples at the coarse setting is put back; what the others have may change.
    let mut others = freed(bench.accepted_terms(&[k]));
    others.extend(bench.put_back(&accepted));
    let own = freed(bench.terms(accepted.candidate, accepted.variant, accepted.widening, &[]));
    let first = others.len();
    let tried = at_settings(bench, at, &settings, &others, &own);
    let ledger = tried.ledger.believing(Class::Closure);
    let one = |(setting, terms): (f64, &Vec<_>)| {
        let fit = ledger.fit(&[tried.beside.as_slice(), terms].concat());
        Tried {
            setting,
            evidence: fit.evidence,
            theta: fit.theta.rows(first, own.len()).into_owned(),
            covariance: fit.covariance.view((first, first), (own.len(), own.len())).into_owned(),
        }
    };
    settings.into_iter().zip(&tried.each).map(one).collect()
}

fn mixture(tried: &[Tried]) -> Option<Settled> {
    let shares = posterior(tried.iter().map(|one| one.evidence))?;
    let each = || tried.iter().zip(&shares);
    let count = tried.first().map_or(0, |one| one.theta.len());
    let theta = each().fold(DVector::zeros(count), |mean, (one, share)| mean + &one.theta * *share);
    let covariance = each().fold(DMatrix::zeros(count, count), |all, (one, share)| {
        let off = &one.theta - &theta;
        all + (&one.covariance + &off * off.transpose()) * *share
    });
    let setting: f64 = each().map(|(one, share)| one.setting * share).sum();
    // Between two neighbours nothing is known.
    let step = tried.windows(2).map(|pair| pair[1].setting - pair[0].setting).fold(0.0, f64::max);
    let spread: f64 = each().map(|(one, share)| (one.setting - setting).powi(2) * share).sum();
    Some(Settled { theta, covariance, setting, sigma: (spread + step * step / 12.0).sqrt() })
}

#[cfg(test)]
mod tests {
    use super::{Tried, mixture};
    use nalgebra::{DMatrix, DVector};

    /// Two settings as likely as each other: their numbers' distance is uncertainty too.
    #[test]
    fn what_settings_disagree_about_is_uncertain() {
        let one = |setting: f64, theta: f64| Tried {
            setting,
            evidence: -1000.0,
            theta: DVector::from_element(1, theta),
            covariance: DMatrix::from_element(1, 1, 4.0),
        };
        let settled = mixture(&[one(10.0, 1.0), one(12.0, 7.0)]).expect("it is finite");
        assert!((settled.theta[0] - 4.0).abs() < 1e-12 && (settled.covariance[(0, 0)] - 13.0).abs() < 1e-12);
        assert!((settled.setting - 11.0).abs() < 1e-12 && (settled.sigma.powi(2) - (1.0 + 4.0 / 12.0)).abs() < 1e-12);
    }
}
