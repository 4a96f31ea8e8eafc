//! What a recording could have shown.

use super::diagnosis::Limit;
use super::search::bench::{Bench, HEALTHY};
use super::search::ledger::Ledger;
use super::search::select::Selection;

/// What the recording could have shown, with 95 % certainty, by the threshold in force.
pub fn limits(bench: &Bench, selection: &Selection) -> Vec<Limit> {
    let ledger = Ledger::new(&selection.before, |_| true);
    (0..bench.candidates.len()).map(|candidate| limit(bench, selection, &ledger, candidate)).collect()
}

fn limit(bench: &Bench, selection: &Selection, ledger: &Ledger, index: usize) -> Limit {
    let candidate = &bench.candidates[index];
    let id = candidate.effect.card.id.to_string();
    let none = |why: &str, unit: &str| Limit {
        id: id.clone(),
        limit: f64::MAX,
        unit: unit.into(),
        testable: false,
        why: why.into(),
    };
    if let Some(why) = candidate.absent {
        return none(why, "");
    }
    if let Some((_, unit_si, unit)) = candidate.walk {
        // What is more than healthy by the first level that counts.
        let floor = if unit == "mdps/sqrt(s)" {
            super::twin::noise::BIAS_WALK_FLOOR
        } else {
            super::twin::noise::FORCE_WALK_FLOOR
        };
        let limit = (floor * 4.0 * HEALTHY[HEALTHY.len() - 1]).sqrt() / unit_si;
        return Limit { id, limit, unit: unit.into(), testable: true, why: String::new() };
    }
    // A parameter's size that shifts the evidence past the threshold in 95 of 100 cases, the median over parameters.
    let mut limits: Vec<(f64, f64, &str)> = Vec::new();
    for placed in &candidate.variants {
        for (i, column) in placed.columns.clone().enumerate() {
            let information = ledger.gram(&selection.null_scales, &[column], &[column])[(0, 0)];
            if information <= 0.0 {
                continue;
            }
            let width = placed.parameters[i].width;
            let occam = 0.5 * (1.0 + width * width * information).ln() + (candidate.variants.len() as f64).ln();
            let sigmas = (2.0 * (selection.threshold + occam)).sqrt() + 1.645;
            limits.push((sigmas / information.sqrt(), width, placed.parameters[i].unit));
        }
    }
    limits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(limit, width, unit)) = limits.get(limits.len() / 2) else {
        return none("nothing in this recording depends on it", "");
    };
    let testable = limit < 10.0 * width;
    let why = if testable {
        String::new()
    } else {
        format!("only a size of {limit:.2} {unit} would show; usual are up to {width} {unit}")
    };
    Limit { id, limit, unit: unit.into(), testable, why }
}
