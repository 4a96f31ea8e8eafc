//! Numbers of an effect whose time or time constant is itself a number: neither is known without the other.
//!
//! Variants stand on a coarse grid, which is enough to find the effect. Numbers at the best of them alone are wrong twice: the
//! truth lies between two (a step by 6 sigma a row shows to a tenth of a second when it came; the grid has some seconds), and
//! their sigma is that of a setting which is known. Here the settings are tried finely, all at a pass, and value and sigma
//! are those of the mixture: `θ̄ = Σ p θ̂`, `cov = Σ p [C + (θ̂ − θ̄)(θ̂ − θ̄)ᵀ]`, p by evidence, uniform in the setting before it.

use nalgebra::{DMatrix, DVector};

use super::catalogue::{Variant, at_any_setting};
use super::search::bench::Bench;
use super::search::ledger::{Ledger, Term};
use super::search::shares::freed;
use super::twin::rows::Class;

/// Settings tried at a time: a pass with 72 columns is some 50 ms.
const TRIED: usize = 24;
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

/// None for an effect without such a setting.
pub fn settle(bench: &mut Bench, k: usize) -> Option<Settled> {
    let accepted = &bench.accepted[k];
    let candidate = &bench.candidates[accepted.candidate];
    let at = at_any_setting(candidate.effect.card.id)?;
    let mut grid: Vec<f64> = candidate.variants.iter().filter_map(|variant| Some(variant.setting?.1)).collect();
    grid.sort_by(f64::total_cmp);
    let chosen = candidate.variants[accepted.variant].setting?.1;
    let place = grid.iter().position(|setting| *setting >= chosen)?;
    // Two to either side: the best of the coarse grid may be the wrong neighbour. Beyond its ends, half of the last step's ratio.
    let (mut low, mut high) = (grid[place.saturating_sub(2)], grid[(place + 2).min(grid.len() - 1)]);
    if low == chosen {
        low = 0.5 * chosen;
    }
    if high == chosen {
        high = 1.5 * chosen;
    }
    let mut tried = Vec::new();
    for _ in 0..ZOOMS {
        tried = try_all(bench, k, at, low, high);
        let most = tried.iter().map(|one| one.evidence).fold(f64::NEG_INFINITY, f64::max);
        let step = (high - low) / (TRIED - 1) as f64;
        let possible = || tried.iter().filter(|one| one.evidence > most - EXCLUDED).map(|one| one.setting);
        let (first, last) = (possible().fold(f64::MAX, f64::min), possible().fold(f64::MIN, f64::max));
        if last - first > 0.5 * (high - low) {
            break;
        }
        (low, high) = ((first - step).max(low), (last + step).min(high));
    }
    Some(mixture(&tried))
}

fn try_all(bench: &mut Bench, k: usize, at: fn(f64) -> Variant, low: f64, high: f64) -> Vec<Tried> {
    let settings: Vec<f64> = (0..TRIED).map(|i| low + (high - low) * i as f64 / (TRIED - 1) as f64).collect();
    let accepted = bench.accepted[k].clone();
    // What was taken out of the samples at the coarse setting is put back; what the others have may change.
    let mut others = freed(bench.accepted_terms(Some(k)));
    others.extend(bench.put_back(&accepted));
    let own = freed(bench.terms(accepted.candidate, accepted.variant, accepted.widening, &[]));
    let known = bench.influences.len();
    bench.influences.extend(settings.iter().flat_map(|setting| at(*setting).influences));
    let mut columns: Vec<usize> = others.iter().map(|term| term.column).collect();
    columns.extend(known..bench.influences.len());
    let rows = bench.rows_of(&columns);
    bench.influences.truncate(known);
    let ledger = Ledger::new(&rows, |_| true).believing(Class::Closure);
    let beside: Vec<Term> = others.iter().enumerate().map(|(column, term)| Term { column, ..*term }).collect();
    let one = |(i, setting): (usize, &f64)| {
        let first = beside.len();
        let mut terms = beside.clone();
        terms.extend(own.iter().enumerate().map(|(j, term)| Term { column: first + i * own.len() + j, ..*term }));
        let fit = ledger.fit(&terms);
        Tried {
            setting: *setting,
            evidence: fit.evidence,
            theta: fit.theta.rows(first, own.len()).into_owned(),
            covariance: fit.covariance.view((first, first), (own.len(), own.len())).into_owned(),
        }
    };
    settings.iter().enumerate().map(one).collect()
}

fn mixture(tried: &[Tried]) -> Settled {
    let most = tried.iter().map(|one| one.evidence).fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = tried.iter().map(|one| (one.evidence - most).exp()).sum();
    let shares: Vec<f64> = tried.iter().map(|one| (one.evidence - most).exp() / sum).collect();
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
    Settled { theta, covariance, setting, sigma: (spread + step * step / 12.0).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::{Tried, mixture};
    use nalgebra::{dmatrix, dvector};

    /// Two settings as likely as each other: their numbers' distance is uncertainty too.
    #[test]
    fn what_settings_disagree_about_is_uncertain() {
        let one = |setting: f64, theta: f64| Tried {
            setting,
            evidence: -1000.0,
            theta: dvector![theta],
            covariance: dmatrix![4.0],
        };
        let settled = mixture(&[one(10.0, 1.0), one(12.0, 7.0)]);
        assert!((settled.theta[0] - 4.0).abs() < 1e-12 && (settled.covariance[(0, 0)] - 13.0).abs() < 1e-12);
        assert!((settled.setting - 11.0).abs() < 1e-12 && (settled.sigma.powi(2) - (1.0 + 4.0 / 12.0)).abs() < 1e-12);
    }
}
