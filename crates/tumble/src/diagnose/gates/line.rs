//! A steady hum (`vibration_line`).
//!
//! Statistic: at every bin of the mean periodogram over W windows of rests, from 3 Hz to half the rate, the ratio of power to
//! the median of the bins 4 to 12 away on both sides, averaged over a triad's three axes. Under noise of any smooth
//! spectrum that is a mean of 6·W·0.9 squared normals (Hann, half overlap); its quantile at e⁻¹¹·⁵ over all bins and both
//! triads is by Chernoff. The floor is itself uncertain by 1.25/√(16·W) and, on the flank of a low-pass, off by a few per
//! cent: the quantile is taken times 1.25·(1 + 6·1.25/√(48·W)). A line is narrow: three bins off it has fallen to a
//! fifth; a hand's tremor (8 to 12 Hz, 1 to 2 Hz wide) has not, and in its band nothing is told where rates scatter by
//! more than 0.3 °/s.

use super::chance::{LN_ALARM, mean_square_quantile, median};
use super::spectrum::Windows;
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const LEAST_HZ: f64 = 3.0;
const TREMOR_HZ: std::ops::Range<f64> = 5.0..15.0;
const TREMBLING_DPS: f64 = 0.3;

pub(super) const CARD: Card = Card {
    id: "vibration_line",
    name: "a steady vibration",
    equation: "reading += A·sin(2πFt + φ)",
    typical: "1 to 100 mg near fans and motors; what is above half the rate shows folded, at |F − n·rate|",
    shows: "the spectrum at rest",
    confounded: &["table_rocking"],
    separate_by: "switch off what hums, or record at another rate: a folded line moves, a true one stays",
};

struct Line {
    hz: f64,
    sigma_hz: f64,
    ratio: f64,
    threshold: f64,
    freedom: f64,
}

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let none = |why: &str| Outcome { limit: untestable(&CARD, "mg", why), ..Outcome::default() };
    let Some(windows) = Windows::new(view) else { return none("no rest on something solid that is long enough") };
    let spectra: Vec<Vec<f64>> = view.channels.iter().map(|channel| windows.spectrum(channel).power).collect();
    let lines: Vec<(usize, Line)> = [0, 3]
        .into_iter()
        .filter_map(|first| line(view, &windows, &spectra[first..first + 3]).map(|line| (first, line)))
        .collect();
    // A line as strong as noise of three axes together in one bin is found with certainty.
    let floor = median(spectra[3..].iter().flatten().copied().filter(|p| *p > 0.0).collect());
    let least_mg = 1e3 * windows.amplitude(3.0 * floor * 3.0_f64.sqrt() / (windows.count() as f64).sqrt().max(1.0));
    let mut outcome = Outcome { limit: limit(&CARD, least_mg, "mg", ""), ..Outcome::default() };
    let Some((_, strongest)) = lines.iter().max_by(|a, b| a.1.ratio.total_cmp(&b.1.ratio)) else { return outcome };
    let mut parameters = vec![value("frequency", strongest.hz, strongest.sigma_hz, "Hz")];
    let mut mask = 0;
    for (first, unit, times) in [(3, "mg", 1e3), (0, "dps", 1.0)] {
        if lines.iter().any(|(triad, _)| *triad == first) {
            let (amplitude, sigma) = amplitude(&windows, &spectra[first..first + 3], strongest.hz);
            let name = if first == 3 { "force_peak" } else { "rate_peak" };
            parameters.push(value(name, times * amplitude, times * sigma, unit));
            mask |= 7 << first;
        }
    }
    let evidence = -super::chance::ln_mean_square_tail(strongest.ratio, strongest.freedom);
    let (start, end) = (view.rests[0].samples.start, view.rests[view.rests.len() - 1].samples.end);
    outcome.found = Some(found(&CARD, evidence.min(1e4), parameters, view.place(mask, start..end)));
    outcome
}

/// The triad's strongest line, if there is one.
fn line(view: &View, windows: &Windows, spectra: &[Vec<f64>]) -> Option<Line> {
    let bins = spectra[0].len();
    let count = windows.count() as f64;
    let freedom = 6.0 * 0.9 * count;
    let first = ((LEAST_HZ / windows.bin_hz).ceil() as usize).max(4);
    let ln_p = LN_ALARM - (2.0 * bins as f64).ln();
    let allowance = 1.25 * (1.0 + 6.0 * 1.25 / (48.0 * count).sqrt());
    let threshold = allowance * mean_square_quantile(ln_p, freedom);
    let trembling = median(view.sigma[..3].to_vec()) > TREMBLING_DPS;
    let mut best: Option<Line> = None;
    for bin in first..bins.saturating_sub(1) {
        let hz = bin as f64 * windows.bin_hz;
        let ratio = ratio(spectra, bin);
        let beyond = ratio > threshold && best.as_ref().is_none_or(|best| ratio > best.ratio);
        if !beyond || (trembling && TREMOR_HZ.contains(&hz)) || !narrow(spectra, bin) {
            continue;
        }
        let share = (1.0 / (ratio * count)).sqrt();
        best = Some(Line {
            hz: centre(spectra, bin) * windows.bin_hz,
            sigma_hz: (0.3 * share + 0.02) * windows.bin_hz,
            ratio,
            threshold,
            freedom,
        });
    }
    best.filter(|best| best.ratio > best.threshold)
}

fn floor(power: &[f64], bin: usize) -> f64 {
    let low = bin.saturating_sub(12).max(2)..bin.saturating_sub(3).max(2);
    let high = (bin + 4).min(power.len())..(bin + 13).min(power.len());
    median(low.chain(high).map(|k| power[k]).collect())
}

fn ratio(spectra: &[Vec<f64>], bin: usize) -> f64 {
    spectra.iter().map(|power| power[bin] / floor(power, bin).max(1e-30)).sum::<f64>() / 3.0
}

fn narrow(spectra: &[Vec<f64>], bin: usize) -> bool {
    let excess = |k: usize| {
        let of = |power: &Vec<f64>| power.get(k).map_or(0.0, |p| (p / floor(power, bin).max(1e-30) - 1.0).max(0.0));
        spectra.iter().map(of).sum::<f64>()
    };
    let centre = excess(bin);
    excess(bin - 3) < 0.2 * centre && excess(bin + 3) < 0.2 * centre
}

/// Bin by the excess' centre of gravity.
fn centre(spectra: &[Vec<f64>], bin: usize) -> f64 {
    let excess = |k: usize| {
        spectra.iter().map(|power| power.get(k).map_or(0.0, |p| p / floor(power, bin).max(1e-30))).sum::<f64>()
    };
    let near = [bin - 1, bin, bin + 1];
    let sum: f64 = near.iter().map(|k| excess(*k)).sum();
    near.iter().map(|k| *k as f64 * excess(*k)).sum::<f64>() / sum
}

/// Length of the triad's peak and its sigma.
fn amplitude(windows: &Windows, spectra: &[Vec<f64>], hz: f64) -> (f64, f64) {
    let bin = (hz / windows.bin_hz).round() as usize;
    let (mut excess, mut noise) = (0.0, 0.0);
    for power in spectra {
        let floor = floor(power, bin);
        noise += 5.0 * floor;
        excess += (bin.saturating_sub(2)..(bin + 3).min(power.len())).map(|k| power[k] - floor).sum::<f64>();
    }
    let amplitude = windows.amplitude(excess);
    (amplitude, 0.5 * amplitude * noise / (excess.max(1e-30) * (windows.count() as f64).sqrt()) + 0.01 * amplitude)
}
