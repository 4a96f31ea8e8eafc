//! What a recording could have shown.

use nalgebra::{DMatrix, DVector};

use super::diagnosis::Limit;
use super::gates::chance::shift_seen;
use super::judge::BESIDE_GATES;
use super::search::bench::{Bench, Candidate, HEALTHY, with_walks};
use super::search::ledger::Ledger;
use super::search::select::Selection;
use super::twin::noise::walk_floor;

/// What the recording could have shown, with 95 % certainty, by the threshold in force.
///
/// The noise is the most that a healthy sensor may have: the null is free to excuse an effect as wander, up to 10 mdps and
/// 100 µg in 100 s, so that what it can excuse is no evidence. (At the noise of a quiet recording, limits of what is slow came
/// out at half of what was found in truth.)
///
/// `beside_gates`: names need the odds that no trace of a distorted sample reaches, and no walk is named.
pub fn limits(bench: &mut Bench, selection: &Selection, beside_gates: bool) -> Vec<Limit> {
    let kept = bench.twin.noise;
    let most = HEALTHY[HEALTHY.len() - 1];
    let rows = bench.rows(with_walks(&selection.null_noise, most, most));
    bench.twin.noise = kept;
    let ledger = Ledger::new(&rows, |_| true);
    let bench = &*bench;
    let needed = if beside_gates { selection.threshold.max(BESIDE_GATES) } else { selection.threshold };
    let asked = Asked { scales: &selection.null_scales, needed, beside_gates };
    bench.candidates.iter().map(|candidate| limit(candidate, &asked, &ledger)).collect()
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
}

fn limit(candidate: &Candidate, asked: &Asked, ledger: &Ledger) -> Limit {
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
    if let Some((gyro, unit_si, unit)) = candidate.walk {
        if asked.beside_gates {
            return none("what distorts the samples leaves traces that wander as well", unit);
        }
        // What is more than healthy by the first level that counts.
        let limit = (walk_floor(gyro) * 4.0 * HEALTHY[HEALTHY.len() - 1]).sqrt() / unit_si;
        return Limit { id, limit, unit: unit.into(), testable: true, why: String::new() };
    }
    // The median over parameters and variants.
    let mut limits = limits_alone(candidate, asked, ledger);
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

/// Of each parameter of each variant alone, the others zero, at the price of them all: limit, prior width and unit.
fn limits_alone(candidate: &Candidate, asked: &Asked, ledger: &Ledger) -> Vec<(f64, f64, &'static str)> {
    let mut limits = Vec::new();
    for placed in &candidate.variants {
        let columns: Vec<usize> = placed.columns.clone().collect();
        let information = ledger.gram(asked.scales, &columns, &columns);
        let widths = DVector::from_fn(columns.len(), |i, _| placed.parameters[i].width);
        let prior = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            information[(i, j)] * widths[i] * widths[j] + if i == j { 1.0 } else { 0.0 }
        });
        let Some(factor) = prior.cholesky() else { continue };
        let occam: f64 = factor.l_dirty().diagonal().iter().map(|v| v.ln()).sum();
        let price = asked.needed + occam + (candidate.variants.len() as f64).ln();
        for (i, parameter) in placed.parameters.iter().enumerate().filter(|(i, _)| information[(*i, *i)] > 0.0) {
            let sigmas = shift_seen(2.0 * price, columns.len() as f64).sqrt();
            limits.push((sigmas / information[(i, i)].sqrt(), parameter.width, parameter.unit));
        }
    }
    limits
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
            testable,
            why: String::new(),
        };
        let each = one_each([limit(0.6, true), limit(22.6, true)].into_iter());
        assert_eq!((each.len(), each[0].limit), (1, 0.6));
        let each = one_each([limit(0.0, false), limit(22.6, true)].into_iter());
        assert_eq!((each.len(), each[0].limit), (1, 22.6));
    }
}
