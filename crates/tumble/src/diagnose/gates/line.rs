//! A steady hum (`vibration_line`).
//!
//! Statistic: at every bin from 2 Hz to half the rate, X X† of a triad (3 axes) summed over R pieces of rest, over the noise p of
//! each axis there: with one direction for all of it (a hum of the box), 2·λ₁ of the real part, else 2·its trace. Under noise the
//! trace is χ² of 6R; λ₁ is at most 1/cos²(10°) times the largest of 120 directions that lie within 10° of any (a hemisphere over a
//! cap, and a quarter more for the overlap), each χ² of 2R. Both tails are Chernoff's, over all bins, two triads and two statistics,
//! at e⁻¹¹·⁵. Within a piece (10 s at most) phase counts, between pieces it does not: what hums drifts.
//!
//! p is the geometric mean of the medians of the bins 3 to 12 resolutions off to either side: exact on any flank that falls
//! exponentially, too large on power laws; a soft knee bends it by a few per cent: taken times 1.05. Where a decimation's steep low-pass ends
//! below half the rate it is half of the noise at the knee (two of eight clean recordings at 100 Hz had a line there): never less than
//! the parabola through the logarithms of the near and the far half. In a stop band p is at least a hundredth of the noise in the pass band, for
//! ripples are lines too. Its own scatter, δ² =
//! 1.57/(18·R) an axis, widens the excess by √(1 + freedom·δ²/2). A line is narrow: three resolutions off it has fallen to
//! a third, give or take three sigmas of noise. A hand's tremor (8 to 12 Hz, 1 to 2 Hz wide) has not where pieces are long, but it is no stationary
//! noise either: where hands hold the box, nothing is told below 15 Hz. That they do shows by the rates' scatter from 4 to 15 Hz, over 0.3 °/s, or by
//! noise of 1.5 times what it is above 16 Hz, from 4 to 6 or from 6 to 15 Hz (white: 1 ± 0.05). Where rounding hides the noise (σ < 0.35 steps) it
//! makes lines of its own: such a triad is passed over.
//!
//! Limit: the excess over the threshold that a line of the box has in 95 of 100 recordings: λ with λ − 1.645·√(2·(2R + 2λ))
//! = threshold − 2R (non-central χ²), and A² = 2·p·λ/Σ(Σw)²/Σw², at the noise p of the loudest twentieth of the band.

use std::ops::Range;

use nalgebra::Vector3;

use super::chance::{LN_ALARM, ln_mean_square_tail, mean_square_quantile, median, quantile, shift_seen};
use super::spectrum::Spectra;
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const LEAST_HZ: f64 = 2.0;
/// A hand sways up to 6 Hz (a table rocks below 4, and is no hand) and trembles above.
const SWAY_HZ: Range<f64> = 4.0..6.0;
const TREMOR_HZ: f64 = 15.0;
const TREMBLING_DPS: f64 = 0.3;
/// Where there is none of it, for comparison.
const CALM_HZ: Range<f64> = 16.0..30.0;
const TREMBLING: f64 = 1.5;
/// Resolutions to either side that a rocking table's power reaches: it is a thousand times the noise and more.
const SKIRTS: f64 = 5.0;
/// Bend of a smooth spectrum over the bins that the floor is taken from.
const BEND: f64 = 1.05;
/// Share of the noise that what a filter keeps back is taken for at least: its stop band has ripples of its own, from 40 dB down.
const STOPPED: f64 = 0.01;
/// Resolutions where the bins of the floor are halved, and the middles' squares: the far one is off by 9.75, the near one by 5.25.
const HALF_WAY: f64 = 7.5;
const KNEE: f64 = 5.25 * 5.25 / (9.75 * 9.75 - 5.25 * 5.25);
/// ln of how many directions stand for all, and cos² of how far any is from the next.
const LN_DIRECTIONS: f64 = 4.8;
const NEAR: f64 = 0.97;
/// Of the bins where a line is sought half a bin off: what is lost, in the mean.
const SCALLOP: f64 = 0.95;

pub(super) const CARD: Card = Card {
    id: "vibration_line",
    name: "a steady vibration",
    equation: "reading += A·sin(2πFt + φ)",
    typical: "1 to 100 mg near fans and motors; what is above half the rate shows folded, at |F − n·rate|",
    shows: "the spectrum at rest",
    confounded: &["table_rocking"],
    separate_by: "switch off what hums, or record at another rate: a folded line moves, a true one stays",
};

/// A triad's strongest.
struct Line {
    triad: usize,
    bin: usize,
    ln_p: f64,
}

/// Thresholds in what a statistic is over its mean.
struct Test {
    /// Over 6R, over 2R.
    freedom: [f64; 2],
    /// What their excess over one is divided by, for the floor's own scatter.
    wider: [f64; 2],
    ln_alarm: f64,
}

impl Test {
    fn new(spectra: &Spectra) -> Self {
        let freedom = [6.0 * spectra.pieces, 2.0 * spectra.pieces];
        let floor = 1.57 / (18.0 * spectra.pieces);
        let wider = [freedom[0] * floor / 3.0, freedom[1] * floor].map(|share| (1.0 + 0.5 * share).sqrt());
        Self { freedom, wider, ln_alarm: LN_ALARM - (4.0 * spectra.cross.len() as f64).ln() }
    }

    /// ln of the chance of as much, the better of both statistics.
    fn ln_p(&self, whitened: &nalgebra::Matrix3<f64>) -> f64 {
        let narrowed = |ratio: f64, k: usize| 1.0 + (ratio - 1.0) / self.wider[k];
        let all = ln_mean_square_tail(narrowed(whitened.trace() / 3.0, 0), self.freedom[0]);
        // λ₁ is at most the trace: most bins need no eigenvalues.
        if LN_DIRECTIONS + ln_mean_square_tail(narrowed(NEAR * whitened.trace(), 1), self.freedom[1]) > self.ln_alarm {
            return all;
        }
        let largest = whitened.symmetric_eigenvalues().max();
        all.min(LN_DIRECTIONS + ln_mean_square_tail(narrowed(NEAR * largest, 1), self.freedom[1]))
    }
}

/// The gate; `hand` is what the spectra show of one, and `rocking_hz` a table's, which is no hum.
pub fn examine(view: &View, spectra: Option<&Spectra>, hand: Hand, rocking_hz: Option<f64>) -> Outcome {
    let none = |why: &str| Outcome { limit: untestable(&CARD, "mg", why), ..Outcome::default() };
    let Some(spectra) = spectra else { return none("no rest on something solid that is long enough") };
    let test = Test::new(spectra);
    let but = if hand.holds() { " but below 15 Hz, where a hand trembles" } else { "" };
    let why = format!("from {:.1} Hz to half the rate{but}, the force of a hum of the box itself", least_hz(spectra));
    let mut outcome = Outcome { limit: limit(&CARD, 1e3 * least_g(spectra, &test), "mg", &why), ..Outcome::default() };
    let rounded = |triad: usize| {
        let axes = 3 * triad..3 * triad + 3;
        median(axes.map(|c| view.sigma[c] / view.step[c].max(1e-12)).collect()) < 0.45
    };
    let lines: Vec<Line> = (0..2)
        .filter(|triad| !rounded(*triad))
        .filter_map(|triad| line(spectra, &test, triad, hand, rocking_hz))
        .collect();
    let Some(strongest) = lines.iter().min_by(|a, b| a.ln_p.total_cmp(&b.ln_p)) else { return outcome };
    let mut parameters = Vec::new();
    let (mut mask, mut sharpest) = (0, 0.0_f64);
    for (triad, name, unit, times) in [(1, "force_peak", "mg", 1e3), (0, "rate_peak", "dps", 1.0)] {
        if lines.iter().any(|line| line.triad == triad) {
            let (peak, strength) = amplitude(spectra, triad, strongest.bin);
            parameters.push(value(name, times * peak, times * peak * (1.0 / strength.max(1.0) + 1e-4).sqrt(), unit));
            mask |= 7 << (3 * triad);
            sharpest = sharpest.max(strength);
        }
    }
    // √(12/λ)/(2πT) is the Cramér-Rao bound of a sine's frequency; the grid adds a fortieth of its spacing.
    let sigma_hz = 0.55 * spectra.resolution_hz / sharpest.max(1.0).sqrt() + 0.025 * spectra.bin_hz;
    parameters.insert(0, value("frequency", centre(spectra, strongest), sigma_hz, "Hz"));
    let (start, end) = (view.rests[0].samples.start, view.rests[view.rests.len() - 1].samples.end);
    outcome.found = Some(found(&CARD, (-strongest.ln_p).min(1e4), parameters, view.place(mask, start..end)));
    outcome
}

/// Below five resolutions there is no floor to compare with.
fn least_hz(spectra: &Spectra) -> f64 {
    LEAST_HZ.max(5.0 * spectra.resolution_hz)
}

fn line(spectra: &Spectra, test: &Test, triad: usize, hand: Hand, rocking_hz: Option<f64>) -> Option<Line> {
    let hidden = |hz: f64| {
        (hand.holds() && hz < TREMOR_HZ)
            || rocking_hz.is_some_and(|rocking| (hz - rocking).abs() < SKIRTS * spectra.resolution_hz)
    };
    let first = spectra.bin(least_hz(spectra));
    let mut best: Option<Line> = None;
    for bin in first..spectra.cross.len().saturating_sub(2) {
        let ln_p = test.ln_p(&whitened(spectra, triad, bin, &floor(spectra, triad, bin)));
        let better = ln_p < best.as_ref().map_or(test.ln_alarm, |best| best.ln_p);
        if better && !hidden(bin as f64 * spectra.bin_hz) && narrow(spectra, triad, bin) {
            best = Some(Line { triad, bin, ln_p });
        }
    }
    best
}

/// What shows that a hand holds the box.
#[derive(Clone, Copy, Default)]
pub struct Hand {
    /// From 4 to 6 Hz. A table that rocks at 2 Hz for a rest of two seconds reaches there too.
    pub sways: bool,
    /// From 6 to 15 Hz.
    pub trembles: bool,
}

impl Hand {
    /// By the gyroscope's noise.
    pub fn of(spectra: &Spectra) -> Self {
        let powers = |low_hz: f64, high_hz: f64| {
            let bins = spectra.bin(low_hz)..spectra.bin(high_hz);
            bins.map(|bin| spectra.cross[bin][0].trace()).collect::<Vec<f64>>()
        };
        // The lower quartile: a line's own skirts are not to be taken for a hand.
        let noise = |low_hz: f64, high_hz: f64| quantile(&mut powers(low_hz, high_hz), 0.25);
        // Of one axis; what is slower may be the table.
        let all = powers(SWAY_HZ.start, TREMOR_HZ).iter().sum::<f64>();
        let scatter = (all / (3.0 * spectra.cross.len() as f64)).sqrt();
        let asked = TREMBLING * noise(CALM_HZ.start, CALM_HZ.end);
        Self {
            sways: noise(SWAY_HZ.start, SWAY_HZ.end) > asked,
            trembles: scatter > TREMBLING_DPS || noise(SWAY_HZ.end, TREMOR_HZ) > asked,
        }
    }

    fn holds(self) -> bool {
        self.sways || self.trembles
    }
}

/// Noise of each axis about a bin.
fn floor(spectra: &Spectra, triad: usize, bin: usize) -> Vector3<f64> {
    let count = spectra.cross.len();
    let off = |resolutions: f64| (resolutions * spectra.resolution_hz / spectra.bin_hz).round() as usize;
    let below = |resolutions: f64| bin.saturating_sub(off(resolutions)).max(off(2.0));
    let above = |resolutions: f64| (bin + off(resolutions)).min(count);
    // The median of a mean of R exponentials is (1 − 1/9R)³ of their mean (Wilson and Hilferty).
    let share = (1.0 - 1.0 / (9.0 * spectra.pieces)).powi(3) / BEND;
    Vector3::from_fn(|axis, _| {
        let side = |bins: Range<usize>| median(bins.map(|k| spectra.cross[k][triad][(axis, axis)]).collect());
        let sides = |from: f64, to: f64| [side(below(to)..below(from)), side(above(from)..above(to))];
        let both = |[low, high]: [f64; 2]| if (low * high).is_nan() { low.max(high) } else { (low * high).sqrt() };
        let (all, near, far) = (both(sides(3.0, 12.0)), both(sides(3.0, HALF_WAY)), both(sides(HALF_WAY, 12.0)));
        // The parabola through the logarithms at the halves' middles; a NaN leaves `all`.
        let bent = near * (near / far).powf(KNEE);
        (all.max(bent) / share).max(STOPPED * spectra.level[triad][axis]).max(1e-30)
    })
}

fn whitened(spectra: &Spectra, triad: usize, bin: usize, floor: &Vector3<f64>) -> nalgebra::Matrix3<f64> {
    let weight = floor.map(|p| 1.0 / p.sqrt());
    spectra.cross[bin][triad].component_mul(&(weight * weight.transpose()))
}

fn narrow(spectra: &Spectra, triad: usize, bin: usize) -> bool {
    let floor = floor(spectra, triad, bin);
    let off = (3.0 * spectra.resolution_hz / spectra.bin_hz).round() as usize;
    let excess =
        |k: usize| spectra.cross.get(k).map_or(0.0, |_| whitened(spectra, triad, k, &floor).trace() / 3.0 - 1.0);
    let least = excess(bin) / 3.0 + 3.0 / (3.0 * spectra.pieces).sqrt();
    excess(bin.saturating_sub(off)) < least && excess(bin + off) < least
}

/// Bin by the parabola through the logarithms of the three about the peak, Hz.
fn centre(spectra: &Spectra, line: &Line) -> f64 {
    let log = |k: usize| spectra.cross[k][line.triad].trace().max(1e-30).ln();
    let (before, at, after) = (log(line.bin - 1), log(line.bin), log(line.bin + 1));
    let bend = before - 2.0 * at + after;
    let shift = if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    (line.bin as f64 + shift) * spectra.bin_hz
}

/// The triad's peak, and λ: its square over its variance.
fn amplitude(spectra: &Spectra, triad: usize, bin: usize) -> (f64, f64) {
    let floor = floor(spectra, triad, bin);
    let excess = (spectra.cross[bin][triad].trace() - floor.sum()).max(0.0);
    let peak = (4.0 * excess / spectra.gain).sqrt();
    (peak, 2.0 * excess * spectra.pieces / (floor.sum() / 3.0))
}

/// The smallest line that is found in 95 of 100, g.
fn least_g(spectra: &Spectra, test: &Test) -> f64 {
    let first = spectra.bin(least_hz(spectra));
    let mut noise: Vec<f64> = (first..spectra.cross.len()).step_by(8).map(|bin| floor(spectra, 1, bin).max()).collect();
    let ratio = mean_square_quantile(test.ln_alarm - LN_DIRECTIONS, test.freedom[1]);
    let threshold = test.freedom[1] * (1.0 + test.wider[1] * (ratio - 1.0)) / NEAR;
    let needed = shift_seen(threshold, test.freedom[1]);
    (2.0 * quantile(&mut noise, 0.95) * needed / (SCALLOP * spectra.gain * spectra.pieces)).sqrt()
}
