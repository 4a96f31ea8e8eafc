//! An effect with a time of its own, between the settings of its grid.
//!
//! The grid has an instant at the start of every stretch and every four seconds within. A bias that jumps in the middle of a rest is wrong in half of that
//! rest's rows at either neighbour, by thirty sigma where it shows by a hundred and fifty: other names then have something to explain, and none
//! of them is clear.

use super::bench::Bench;
use super::ledger::{Ledger, Term};
use crate::diagnose::catalogue::{Variant, at_any_setting};
use crate::diagnose::twin::column::Column;

/// Settings tried at a time: a pass with 72 columns is some 50 ms.
pub const TRIED: usize = 24;

/// The same terms at several settings, one pass for all of them.
pub struct Settings {
    /// Sums over rows.
    pub ledger: Ledger,
    /// What is there at each.
    pub beside: Vec<Term>,
    /// The effect's own terms at each.
    pub each: Vec<Vec<Term>>,
}

/// `own` at each of these settings, beside other terms.
pub fn at_settings(
    bench: &mut Bench,
    at: fn(f64) -> Variant,
    settings: &[f64],
    beside: &[Term],
    own: &[Term],
) -> Settings {
    let known = bench.columns.len();
    bench.columns.extend(settings.iter().flat_map(|setting| at(*setting).influences).map(Column::from));
    // Each setting has the same terms; its columns come after those of the one before.
    let each = own.iter().cycle().zip(known..bench.columns.len()).map(|(term, column)| Term { column, ..*term });
    let all: Vec<Term> = beside.iter().copied().chain(each).collect();
    let (ledger, all) = bench.ledger_of(&all);
    bench.columns.truncate(known);
    let (beside, each) = all.split_at(beside.len());
    Settings { ledger, beside: beside.to_vec(), each: each.chunks_exact(own.len()).map(<[Term]>::to_vec).collect() }
}

/// Moves the variant that was accepted last to the best setting between its neighbours on the grid, under the noise in force.
pub fn sharpen(bench: &mut Bench) {
    let Some(accepted) = bench.accepted.last().cloned() else { return };
    let Some(at) = at_any_setting(bench.candidate(&accepted).effect.card.id) else { return };
    let Some(settings) = between_neighbours(bench, accepted.candidate, accepted.variant) else { return };
    let beside = bench.accepted_terms(&[bench.accepted.len() - 1]);
    let own = bench.terms(accepted.candidate, accepted.variant, accepted.widening, &[]);
    let tried = at_settings(bench, at, &settings, &beside, &own);
    let evidence = |terms: &Vec<Term>| tried.ledger.fit(&[tried.beside.as_slice(), terms].concat()).evidence;
    let weighed = tried.each.iter().map(evidence).zip(&settings);
    let Some((_, best)) = weighed.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
    let placed = &mut bench.candidates[accepted.candidate].variants[accepted.variant];
    if let Some(setting) = &mut placed.setting {
        setting.1 = *best;
    }
    for (column, influence) in placed.columns.clone().zip(at(*best).influences) {
        bench.columns[column] = influence.into();
    }
}

/// The variant's own setting and others evenly from its neighbour before to the one after.
fn between_neighbours(bench: &Bench, candidate: usize, variant: usize) -> Option<Vec<f64>> {
    let variants = &bench.candidates[candidate].variants;
    let own = variants.get(variant)?.setting?.1;
    let all = || variants.iter().filter_map(|variant| Some(variant.setting?.1));
    let low = all().filter(|setting| *setting < own).fold(f64::NEG_INFINITY, f64::max);
    let high = all().filter(|setting| *setting > own).fold(f64::INFINITY, f64::min);
    let (low, high) = (if low.is_finite() { low } else { own }, if high.is_finite() { high } else { own });
    let even = (1..TRIED).map(|i| low + (high - low) * i as f64 / TRIED as f64);
    Some(std::iter::once(own).chain(even).collect())
}
