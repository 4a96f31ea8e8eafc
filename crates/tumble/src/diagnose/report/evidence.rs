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

/// Where gains lie, px.
struct Scale {
    least: f64,
    most: f64,
}

impl Scale {
    fn x(&self, gain: f64) -> f64 {
        LABELS + (bend(gain).max(self.least) - self.least) / (self.most - self.least) * CHART
    }
}

/// The picture; none without candidates.
pub fn picture(exhibits: &Exhibits, found: &[String]) -> Option<String> {
    let scores: Vec<&(String, f64)> = exhibits.scores.iter().filter(|score| score.1.is_finite()).collect();
    let best = scores.first()?;
    let most = bend(best.1.max(exhibits.threshold)).max(1.0) * 1.02;
    let scale = Scale { least: scores.iter().map(|score| bend(score.1)).fold(0.0, f64::min).max(-most), most };
    let bottom = TOP + scores.len() as f64 * ROW;
    let mut picture = Picture::new(LABELS + CHART + 70.0, bottom + 44.0);
    grid(&mut picture, &scale, bottom);
    for (k, (id, gain)) in scores.iter().enumerate() {
        let y = TOP + k as f64 * ROW;
        let class = if found.contains(id) { "bar-found" } else { "bar" };
        picture.text("small", Anchor::End, (LABELS - 8.0, y + 13.0), id);
        picture.bar(class, scale.x(0.0), y + 3.0, scale.x(*gain) - scale.x(0.0), ROW - 6.0);
        // In a column of their own, where no line runs through them.
        let number = format!("{:.1}", (10.0 * gain).round() / 10.0 + 0.0);
        picture.text("small", Anchor::End, (LABELS + CHART + 62.0, y + 13.0), &number);
    }
    threshold(&mut picture, scale.x(exhibits.threshold), bottom, exhibits.threshold);
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

fn grid(picture: &mut Picture, scale: &Scale, bottom: f64) {
    let mut last = f64::NEG_INFINITY;
    for tick in [-100.0, -10.0, 0.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6] {
        // Next to the one before there must be room for its number.
        if bend(tick) < scale.least || bend(tick) > scale.most || scale.x(tick) - last < 34.0 {
            continue;
        }
        last = scale.x(tick);
        picture.line("grid", (last, TOP - 4.0), (last, bottom));
        picture.text("small", Anchor::Middle, (last, bottom + 15.0), &format!("{tick:.0}"));
    }
}

/// What a gain must exceed, and why.
fn threshold(picture: &mut Picture, x: f64, bottom: f64, threshold: f64) {
    picture.line("limit", (x, TOP - 8.0), (x, bottom));
    let note = format!(
        "threshold {threshold:.1}: chance alone exceeds it in at most {:.0} of 1000 recordings",
        1000.0 * FALSE_ALARMS
    );
    let (anchor, at) = if x < LABELS + 0.5 * CHART { (Anchor::Start, x - 4.0) } else { (Anchor::End, x + 4.0) };
    picture.text("small", anchor, (at, TOP - 14.0), &note);
}
