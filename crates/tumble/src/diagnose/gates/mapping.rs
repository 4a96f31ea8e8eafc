//! Axes that are not what their names say (`axis_mapping`), ranges that are not those stated (`wrong_full_scale`).
//!
//! Statistic: over pairs of rests with gravity moved by 25° or more, the angle between gravity as the gyroscope carries it
//! over and as the accelerometer finds it, in sigmas of sheet errors (3° of direction, 5 % of what was turned): χ² of 48 signed
//! permutations times nine factors. On a clean recording the identity's χ² is below one a pair. The gate wants at once: the
//! identity worse than 9 a pair (three sigmas in the mean of all pairs), another below 4 a pair, better by 2·ln(432) +
//! 2·11.5 = 35 than the identity, and no other within 6 of it in −2 ln of the likelihood when every slip
//! (exchange, reversal, factor) costs 6 to 12. With two pairs and sheet errors as sigmas the first
//! alone has e⁻⁹; with the second, e⁻¹⁷ and less.
//!
//! Gravity's own length: sheet errors are 3 % and 80 mg, so 1 ± 0.15 g is three sigmas and ± 0.3 beyond six; a factor is
//! told where the length is within 20 % of 2, 4, 8, their inverses, or 9.81.
//!
//! The triad at fault: with rates in need of M, an improper M (determinant −1) is the gyroscope's own left-handedness. A proper M
//! also comes from forces in need of Q = −Mᵀ: one reversed or exchanged accelerometer axis; whichever takes the fewer
//! exchanges and reversals is named.

use nalgebra::{Matrix3, Vector3};

use super::chance::{LN_ALARM, median};
use super::pairs::{Guess, Pair, guesses, pairs};
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;
use crate::recording::STANDARD_GRAVITY_MPS2 as G;

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// What rates may have to be multiplied by: powers of two, and units.
const FACTORS: [f64; 9] = [1.0, 0.5, 2.0, 0.25, 4.0, 0.125, 8.0, DEGREE, 1.0 / DEGREE];
/// Likewise forces.
const FORCE_FACTORS: [f64; 9] = [0.5, 2.0, 0.25, 4.0, 0.125, 8.0, 1.0 / G, G, 1e-3];

pub(super) const AXES: Card = Card {
    id: "axis_mapping",
    name: "axes exchanged or reversed",
    equation: "true = P·read, P a signed permutation",
    typical: "drivers and board prints; accelerometer and gyro from different drivers",
    shows: "every re-orientation",
    confounded: &["wrong_full_scale"],
    separate_by: "turn the sensor by hand about each axis in turn, right-handed: the reading of that axis must be positive",
};

pub(super) const SCALE: Card = Card {
    id: "wrong_full_scale",
    name: "range is not the one stated",
    equation: "read = k·true for a whole triad",
    typical: "ranges differ by factors of 2 (MPU-9250 sheet); a lost write at start-up, or rad/s taken for degrees/s",
    shows: "gravity's length; every re-orientation",
    confounded: &["axis_mapping"],
    separate_by: "read the range's register back; turn by a right angle and integrate",
};

/// Both gates with what readings must be multiplied by.
pub struct Mapped {
    /// `axis_mapping`.
    pub axes: Outcome,
    /// `wrong_full_scale`.
    pub scale: Outcome,
    /// Rates, forces.
    pub remap: Option<(Matrix3<f64>, Matrix3<f64>)>,
}

/// Both gates; clipped forces have no length to go by, clipped rates no angle.
pub fn examine(view: &View, rates_clipped: bool, forces_clipped: bool) -> Mapped {
    let force_factor = if forces_clipped { None } else { force_factor(view) };
    let pairs = pairs(view);
    let mut mapped = Mapped { axes: Outcome::default(), scale: Outcome::default(), remap: None };
    mapped.scale.limit = limit(&SCALE, 2.0, "times", "");
    mapped.axes.limit = limit(&AXES, 1.0, "variant", "");
    let best = if pairs.len() < 2 || rates_clipped {
        let why = if rates_clipped { "the rates clip" } else { "fewer than two re-orientations between rests" };
        mapped.axes.limit = untestable(&AXES, "variant", why);
        None
    } else {
        decisive(&pairs)
    };
    let (mut rates, mut forces) = (Matrix3::identity(), Matrix3::identity() * force_factor.unwrap_or(1.0));
    let mut scales = Vec::new();
    if let Some(factor) = force_factor {
        scales.push(value("accel_read_over_true", 1.0 / factor, 0.05 / factor, "times"));
    }
    let mut evidence = if force_factor.is_some() { 100.0 } else { 0.0 };
    if let Some((guess, gain)) = best {
        if guess.factor != 1.0 {
            scales.push(value("gyro_read_over_true", 1.0 / guess.factor, 0.05 / guess.factor, "times"));
            rates *= guess.factor;
            evidence += gain;
        }
        if guess.mapping != Matrix3::identity() {
            let (rate_map, force_map) = blame(&guess.mapping);
            mapped.axes.found = Some(tell_axes(view, &rate_map, &force_map, gain));
            rates *= rate_map;
            forces *= force_map;
        }
    }
    if !scales.is_empty() {
        let mask = if force_factor.is_some() { 0x38 } else { 0 }
            | if scales.len() > force_factor.iter().len() { 7 } else { 0 };
        mapped.scale.found = Some(found(&SCALE, evidence, scales, view.place(mask, 0..view.len())));
    }
    let changed = mapped.axes.found.is_some() || mapped.scale.found.is_some();
    mapped.remap = changed.then_some((rates, forces));
    mapped
}

/// What forces must be multiplied by.
fn force_factor(view: &View) -> Option<f64> {
    let mut lengths: Vec<f64> = view.rests.iter().map(|rest| rest.force.norm()).collect();
    if lengths.is_empty() {
        // Without rests: what acts most of the time is gravity.
        lengths = (0..view.len()).map(|i| view.force(i).norm()).collect();
    }
    let length = median(lengths);
    FORCE_FACTORS.into_iter().find(|factor| (length * factor - 1.0).abs() < 0.2 && !(0.7..1.35).contains(&length))
}

/// The best guess with its gain over the identity (in ln), if all that the module says is so.
fn decisive(pairs: &[Pair]) -> Option<(Guess, f64)> {
    let mut all: Vec<Guess> = FACTORS.iter().flat_map(|factor| guesses(pairs, *factor)).collect();
    let identity = all[0];
    let cost = |guess: &Guess| guess.chi2 + guess.loose + unlikely(guess);
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    let (best, count) = (all[0], pairs.len() as f64);
    let gain = 0.5 * (identity.chi2 - best.chi2) - (all.len() as f64).ln();
    let clear = identity.chi2 > 9.0 * count && best.chi2 < 4.0 * count && gain > -LN_ALARM;
    (clear && cost(&all[1]) - cost(&best) > 6.0).then_some((best, gain))
}

/// −2 ln of a guess's prior, roughly: what takes two slips is rarer than what takes one. It only decides between guesses that
/// re-orientations hardly tell apart, never whether something is wrong.
fn unlikely(guess: &Guess) -> f64 {
    let slips = operations(&guess.mapping).min(operations(&-guess.mapping.transpose()));
    let factor = match guess.factor {
        1.0 => 0.0,
        0.5 | 2.0 => 8.0,
        0.25 | 4.0 => 10.0,
        _ => 12.0,
    };
    6.0 * slips as f64 + factor
}

/// Exchanges and reversals that a signed permutation takes.
fn operations(matrix: &Matrix3<f64>) -> usize {
    let stay = (0..3).filter(|i| matrix[(*i, *i)] != 0.0).count();
    let exchanges = match stay {
        3 => 0,
        1 => 1,
        _ => 2,
    };
    exchanges + matrix.iter().filter(|v| **v < 0.0).count()
}

/// What rates and forces must be multiplied by, the simpler of the two explanations.
fn blame(mapping: &Matrix3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let forces = -mapping.transpose();
    if mapping.determinant() > 0.0 && operations(&forces) < operations(mapping) {
        (Matrix3::identity(), forces)
    } else {
        (*mapping, Matrix3::identity())
    }
}

fn tell_axes(view: &View, rates: &Matrix3<f64>, forces: &Matrix3<f64>, gain: f64) -> crate::diagnose::diagnosis::Found {
    let gyro = *rates != Matrix3::identity();
    let (matrix, triad, mask) = if gyro { (rates, "gyro", 7) } else { (forces, "accelerometer", 0x38) };
    let axis = |row: usize| {
        let read: Vector3<f64> = matrix.row(row).transpose();
        let column = read.iamax();
        format!("{}{}", if read[column] < 0.0 { "−" } else { "+" }, ["x", "y", "z"][column])
    };
    let touched = (0..3).filter(|i| matrix[(*i, *i)] != 1.0).fold(0, |mask, i| mask | 1 << i);
    let mask = if gyro { touched } else { mask & (touched << 3) };
    let exchanged = (0..3).filter(|i| matrix[(*i, *i)] == 0.0).count();
    let reversed = matrix.iter().filter(|v| **v < 0.0).count();
    let parameters =
        vec![value("axes_exchanged", exchanged as f64, 0.0, ""), value("axes_reversed", reversed as f64, 0.0, "")];
    let mut found = found(&AXES, gain, parameters, view.place(mask, 0..view.len()));
    found.equation = format!("true {triad} (x, y, z) = read ({}, {}, {})", axis(0), axis(1), axis(2));
    found
}
