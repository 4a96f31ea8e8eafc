//! Before and after, channel by channel.

use super::svg::{Anchor, Picture, tick_label};
use super::words;
use crate::diagnose::diagnosis::FitReport;

const ROW: f64 = 34.0;
const LABELS: f64 = 70.0;
const CHART: f64 = 430.0;
const TOP: f64 = 30.0;

/// The picture; none where nothing was fitted.
pub fn picture(fit: &FitReport) -> Option<String> {
    let most = fit.per_channel.values().map(|channel| channel.before.max(channel.after)).fold(0.0, f64::max);
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    // Logarithmic from a tenth of noise: one channel may leave a hundred times what another does.
    let (low, high) = (0.1_f64.log10(), most.max(2.0).log10() + 0.05);
    let x = |value: f64| LABELS + ((value.max(1e-9).log10() - low) / (high - low)).clamp(0.0, 1.0) * CHART;
    let bottom = TOP + fit.per_channel.len() as f64 * ROW;
    let mut picture = Picture::new(LABELS + CHART + 60.0, bottom + 42.0);
    for tick in [0.1_f64, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5].into_iter().filter(|tick| tick.log10() <= high) {
        picture.line(if tick == 1.0 { "limit" } else { "grid" }, (x(tick), TOP), (x(tick), bottom));
        picture.text("small", Anchor::Middle, (x(tick), bottom + 15.0), &tick_label(tick));
    }
    for (k, (name, channel)) in fit.per_channel.iter().enumerate() {
        let y = TOP + k as f64 * ROW;
        picture.text("small", Anchor::End, (LABELS - 8.0, y + 21.0), name);
        for (class, value, offset) in [("bar", channel.before, 4.0), ("bar-found", channel.after, 18.0)] {
            picture.bar(class, LABELS, y + offset, x(value) - LABELS, 12.0);
            // In a column of their own, where no line runs through them.
            picture.text("small", Anchor::End, (LABELS + CHART + 58.0, y + offset + 10.0), &words::figure(value));
        }
    }
    picture.bar("bar", LABELS, 8.0, 14.0, 10.0);
    picture.text("small", Anchor::Start, (LABELS + 19.0, 17.0), "before");
    picture.bar("bar-found", LABELS + 80.0, 8.0, 14.0, 10.0);
    picture.text("small", Anchor::Start, (LABELS + 99.0, 17.0), "after");
    picture.text(
        "small",
        Anchor::Middle,
        (LABELS + 0.5 * CHART, bottom + 34.0),
        "mean squared residual, in units of its noise (1 = noise alone)",
    );
    Some(
        picture.finish(
            "Bars of the mean squared residual of each channel, before and after; the numbers are in the table.",
        ),
    )
}
