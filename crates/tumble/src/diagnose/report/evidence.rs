//! How much each candidate alone explains, against what chance reaches.

use super::svg::{Anchor, Picture};
use super::words;
use crate::diagnose::exhibits::Exhibits;
use crate::diagnose::search::null::FALSE_ALARMS;

const ROW: f64 = 20.0;
const LABELS: f64 = 210.0;
const CHART: f64 = 470.0;
const TOP: f64 = 44.0;

/// Signed logarithm: a Bayes factor's ln runs from below 0 to thousands.
fn bend(gain: f64) -> f64 {
    gain.signum() * (1.0 + gain.abs()).log10()
}

/// The picture; none without candidates.
pub fn picture(exhibits: &Exhibits, found: &[String]) -> Option<String> {
    let scores: Vec<&(String, f64)> = exhibits.scores.iter().filter(|score| score.1.is_finite()).collect();
    let best = scores.first()?;
    let most = bend(best.1.max(exhibits.threshold)).max(1.0) * 1.02;
    let least = scores.iter().map(|score| bend(score.1)).fold(0.0, f64::min).max(-most);
    let x = |gain: f64| LABELS + (bend(gain).max(least) - least) / (most - least) * CHART;
    let bottom = TOP + scores.len() as f64 * ROW;
    let mut picture = Picture::new(LABELS + CHART + 70.0, bottom + 44.0);
    let mut last = f64::NEG_INFINITY;
    for tick in [-100.0, -10.0, 0.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6] {
        // Next to the one before there must be room for its number.
        if bend(tick) < least || bend(tick) > most || x(tick) - last < 34.0 {
            continue;
        }
        last = x(tick);
        picture.line("grid", (last, TOP - 4.0), (last, bottom));
        picture.text("small", Anchor::Middle, (last, bottom + 15.0), &format!("{tick:.0}"));
    }
    for (k, (id, gain)) in scores.iter().enumerate() {
        let y = TOP + k as f64 * ROW;
        let class = if found.contains(id) { "bar-found" } else { "bar" };
        picture.text("small", Anchor::End, (LABELS - 8.0, y + 13.0), id);
        picture.bar(class, x(0.0), y + 3.0, x(*gain) - x(0.0), ROW - 6.0);
        // In a column of their own, where no line runs through them.
        picture.text(
            "small",
            Anchor::End,
            (LABELS + CHART + 62.0, y + 13.0),
            &format!("{:.1}", (10.0 * gain).round() / 10.0 + 0.0),
        );
    }
    let limit = x(exhibits.threshold);
    picture.line("limit", (limit, TOP - 8.0), (limit, bottom));
    let note = format!(
        "threshold {:.1}: chance alone exceeds it in at most {:.0} of 1000 recordings",
        exhibits.threshold,
        1000.0 * FALSE_ALARMS
    );
    let (anchor, at) =
        if limit < LABELS + 0.5 * CHART { (Anchor::Start, limit - 4.0) } else { (Anchor::End, limit + 4.0) };
    picture.text("small", anchor, (at, TOP - 14.0), &note);
    picture.text("small", Anchor::Middle, (LABELS + 0.5 * CHART, bottom + 34.0), "ln Bayes factor, each effect alone");
    let above = scores.iter().filter(|score| score.1 > exhibits.threshold).count();
    Some(picture.finish(&format!(
        "Bars of the evidence of {} effects; {above} exceed the threshold of {:.1}; the best is {} with {}.",
        scores.len(),
        exhibits.threshold,
        best.0,
        words::figure(best.1)
    )))
}
