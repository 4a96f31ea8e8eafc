//! A found effect's regressor against what it explains: single rows, binned means with their error, before and after.

use super::svg::{Anchor, Picture, tick_label, ticks};
use crate::diagnose::exhibits::Regression;

const PANEL: (f64, f64) = (370.0, 250.0);
const LEFT: f64 = 68.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 48.0;
/// Single rows drawn; the means are over all.
const MOST_DOTS: usize = 900;
const BINS: usize = 13;
/// Fewer rows than this make no mean.
const LEAST_IN_BIN: usize = 6;

/// Where a panel's numbers lie.
struct Frame {
    left: f64,
    x: (f64, f64),
    y: (f64, f64),
}

impl Frame {
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let share = |value: f64, (least, most): (f64, f64)| ((value - least) / (most - least)).clamp(0.0, 1.0);
        (self.left + share(x, self.x) * PANEL.0, TOP + (1.0 - share(y, self.y)) * PANEL.1)
    }

    fn holds(&self, y: f64) -> bool {
        self.y.0 <= y && y <= self.y.1
    }
}

/// The picture; none where the effect has no course to draw (a walk).
pub fn picture(regression: &Regression) -> Option<String> {
    let reach = regression.signal.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if !(reach > 0.0 && reach.is_finite()) {
        return None;
    }
    let after: Vec<f64> = regression.before.iter().zip(&regression.signal).map(|(before, own)| before - own).collect();
    let (x, y) = ((-1.05 * reach, 1.05 * reach), span(&regression.before, reach));
    let mut picture = Picture::new(2.0 * (LEFT + PANEL.0) + 30.0, TOP + PANEL.1 + BOTTOM);
    for (side, (title, values)) in
        [("before: the effect still in", &regression.before), ("after: the effect taken out", &after)]
            .into_iter()
            .enumerate()
    {
        let frame = Frame { left: LEFT + side as f64 * (LEFT + PANEL.0 + 10.0), x, y };
        axes(&mut picture, &frame, title);
        // What is expected: the effect itself before, nothing after.
        let expected = if side == 0 { 1.0 } else { 0.0 };
        let end = reach.min(y.1 / f64::max(expected, 1e-9));
        picture.line("expected", frame.at(-end, -end * expected), frame.at(end, end * expected));
        dots(&mut picture, &frame, &regression.signal, values);
        means(&mut picture, &frame, &regression.signal, values);
    }
    Some(picture.finish(&format!(
        "Residuals against what {} predicts, before and after: before they follow the line, after they scatter about 0.",
        regression.id
    )))
}

/// Symmetric, wide enough for all but one row in a thousand.
fn span(values: &[f64], reach: f64) -> (f64, f64) {
    let mut sizes: Vec<f64> = values.iter().map(|value| value.abs()).filter(|size| size.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let common = sizes.get((sizes.len() as f64 * 0.999) as usize).or(sizes.last()).copied().unwrap_or(1.0);
    let most = 1.05 * common.max(reach).max(3.0);
    (-most, most)
}

fn axes(picture: &mut Picture, frame: &Frame, title: &str) {
    let (bottom, right) = (TOP + PANEL.1, frame.left + PANEL.0);
    picture.text("strong", Anchor::Middle, (frame.left + 0.5 * PANEL.0, 16.0), title);
    for tick in ticks(frame.x.0, frame.x.1) {
        let x = frame.at(tick, 0.0).0;
        picture.line("grid", (x, TOP), (x, bottom));
        picture.text("small", Anchor::Middle, (x, bottom + 15.0), &tick_label(tick));
    }
    for tick in ticks(frame.y.0, frame.y.1) {
        let y = frame.at(0.0, tick).1;
        picture.line("grid", (frame.left, y), (right, y));
        picture.text("small", Anchor::End, (frame.left - 6.0, y + 4.0), &tick_label(tick));
    }
    picture.line("axis", (frame.left, TOP), (frame.left, bottom));
    picture.line("axis", (frame.left, bottom), (right, bottom));
    let middle = (frame.left + 0.5 * PANEL.0, bottom + 36.0);
    picture.text("small", Anchor::Middle, middle, "what the effect predicts for a comparison, sigmas");
    picture.slanted("small middle", (frame.left - 52.0, TOP + 0.5 * PANEL.1), 90.0, "residual, sigmas");
}

/// Every k-th by the size of the signal, so that what the effect moves is seen among the many that it does not.
fn dots(picture: &mut Picture, frame: &Frame, signal: &[f64], values: &[f64]) {
    let mut order: Vec<usize> = (0..signal.len().min(values.len())).filter(|&i| frame.holds(values[i])).collect();
    order.sort_by(|a, b| signal[*b].abs().total_cmp(&signal[*a].abs()));
    let half = MOST_DOTS / 2;
    let rest = order.len().saturating_sub(half).div_ceil(half).max(1);
    let chosen = order.iter().take(half).chain(order.iter().skip(half).step_by(rest));
    for &i in chosen {
        picture.dot("row", frame.at(signal[i], values[i]), 1.6);
    }
}

fn means(picture: &mut Picture, frame: &Frame, signal: &[f64], values: &[f64]) {
    let width = (frame.x.1 - frame.x.0) / BINS as f64;
    for bin in 0..BINS {
        let (low, high) = (frame.x.0 + bin as f64 * width, frame.x.0 + (bin + 1) as f64 * width);
        let inside: Vec<(f64, f64)> =
            signal.iter().copied().zip(values.iter().copied()).filter(|(x, _)| low <= *x && *x < high).collect();
        if inside.len() < LEAST_IN_BIN {
            continue;
        }
        let count = inside.len() as f64;
        let (x, y) = inside.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
        let spread = inside.iter().map(|point| (point.1 - y).powi(2)).sum::<f64>() / (count - 1.0);
        let error = (spread / count).sqrt();
        picture.line("error", frame.at(x, y - error), frame.at(x, y + error));
        picture.dot("mean", frame.at(x, y), 4.0);
    }
}
