//! Where: mean square of the whitened residuals by segment and channel, before and after, side by side.

use super::svg::{Anchor, Picture, blend, hex};
use super::words;
use crate::diagnose::exhibits::{Exhibits, Segment};
use crate::diagnose::twin::rows::{Address, CHANNELS};

/// From as much as noise leaves to 32 times as much, in steps of a factor two. Lightness falls all the way, so that it
/// reads without colours.
const SCALE: [[u8; 3]; 6] =
    [[240, 243, 245], [253, 224, 160], [249, 170, 90], [226, 107, 74], [165, 48, 98], [74, 24, 92]];
/// log2 of the largest shown.
const TOP: f64 = 5.0;
/// More segments than this are drawn in groups of neighbours.
const MOST_ROWS: usize = 72;
const CELL: (f64, f64) = (47.0, 16.0);
const LABELS: f64 = 190.0;
const TOP_ROOM: f64 = 62.0;
const BETWEEN: f64 = 26.0;

/// Mean square of a cell and how many rows it has.
#[derive(Clone, Copy, Default)]
struct Cell {
    sum: f64,
    count: usize,
}

/// Rows of the picture: runs of neighbouring segments.
fn groups(segments: &[Segment], used: impl Fn(usize) -> bool) -> Vec<Vec<&Segment>> {
    let shown: Vec<&Segment> = segments.iter().filter(|segment| used(segment.number)).collect();
    let each = shown.len().div_ceil(MOST_ROWS).max(1);
    shown.chunks(each).map(<[&Segment]>::to_vec).collect()
}

fn cells(groups: &[Vec<&Segment>], at: &[Address], values: &[f64]) -> Vec<[Cell; 6]> {
    let mut cells = vec![[Cell::default(); 6]; groups.len()];
    for (at, value) in at.iter().zip(values) {
        let row = groups.iter().position(|group| group.iter().any(|segment| segment.number == at.stretch));
        let Some(cell) = row.and_then(|row| cells[row].get_mut(at.channel)) else { continue };
        cell.sum += value * value;
        cell.count += 1;
    }
    cells
}

/// The picture; none without rows.
pub fn picture(exhibits: &Exhibits, after_what: &str) -> Option<String> {
    let used = |number: usize| exhibits.at.iter().any(|at| at.stretch == number);
    let groups = groups(&exhibits.segments, used);
    if groups.is_empty() {
        return None;
    }
    let panel = 6.0 * CELL.0;
    let height = TOP_ROOM + groups.len() as f64 * CELL.1 + 50.0;
    let mut picture = Picture::new(LABELS + 2.0 * panel + BETWEEN + 10.0, height);
    for (k, group) in groups.iter().enumerate() {
        let y = TOP_ROOM + k as f64 * CELL.1 + 12.0;
        picture.text("small", Anchor::End, (LABELS - 8.0, y), &label(group));
    }
    picture.text("small", Anchor::End, (LABELS - 8.0, TOP_ROOM - 6.0), "segment, from s");
    let before = cells(&groups, &exhibits.at, &exhibits.before);
    let after = cells(&groups, &exhibits.after_at, &exhibits.after);
    for (side, (title, cells)) in [("before", &before), (after_what, &after)].into_iter().enumerate() {
        draw(&mut picture, LABELS + side as f64 * (panel + BETWEEN), title, &groups, cells);
    }
    legend(&mut picture, height - 34.0);
    let worst = before.iter().flatten().map(|cell| cell.sum / cell.count.max(1) as f64).fold(0.0, f64::max);
    Some(picture.finish(&format!(
        "Heat map of {} segments by 6 channels, before and after; the largest cell before is {} times noise.",
        groups.len(),
        words::figure(worst)
    )))
}

fn label(group: &[&Segment]) -> String {
    match group {
        [] => String::new(),
        [one] => format!("{} {}, {:.1}", one.number, one.name, one.start_s),
        [first, .., last] => format!("{}-{} {} ..., {:.1}", first.number, last.number, first.name, first.start_s),
    }
}

fn draw(picture: &mut Picture, left: f64, title: &str, groups: &[Vec<&Segment>], cells: &[[Cell; 6]]) {
    picture.text("strong", Anchor::Middle, (left + 3.0 * CELL.0, 16.0), title);
    for (channel, name) in CHANNELS.iter().enumerate() {
        let (triad, axis) = name.split_once('_').unwrap_or((name, ""));
        let x = left + (channel as f64 + 0.5) * CELL.0;
        picture.text("small", Anchor::Middle, (x, TOP_ROOM - 20.0), triad);
        picture.text("small", Anchor::Middle, (x, TOP_ROOM - 7.0), axis);
    }
    for (k, row) in cells.iter().enumerate() {
        for (channel, cell) in row.iter().enumerate() {
            let at = (left + channel as f64 * CELL.0, TOP_ROOM + k as f64 * CELL.1);
            if cell.count == 0 {
                picture.text("faint", Anchor::Middle, (at.0 + 0.5 * CELL.0, at.1 + 11.5), "\u{b7}");
                continue;
            }
            let mean = cell.sum / cell.count as f64;
            let colour = colour(mean);
            let name =
                format!("{}, {}: {} ({} rows)", label(&groups[k]), CHANNELS[channel], words::figure(mean), cell.count);
            picture.cell(&hex(colour), at, (CELL.0 - 1.0, CELL.1 - 1.0), &name);
            picture.text_on(colour, (at.0 + 0.5 * CELL.0, at.1 + 11.5), &short(mean));
        }
    }
}

fn colour(mean: f64) -> [u8; 3] {
    blend(&SCALE, mean.max(1e-9).log2() / TOP)
}

/// Two figures: a cell is narrow.
fn short(mean: f64) -> String {
    if mean >= 99_999.5 {
        format!("{mean:.0e}")
    } else if mean >= 9.95 {
        format!("{mean:.0}")
    } else {
        format!("{mean:.1}")
    }
}

fn legend(picture: &mut Picture, y: f64) {
    picture.text("small", Anchor::End, (LABELS - 8.0, y + 12.0), "mean square:");
    for step in 0..=TOP as usize {
        let colour = blend(&SCALE, step as f64 / TOP);
        let at = (LABELS + step as f64 * CELL.0, y);
        let name = match step {
            0 => "\u{2264} 1".to_owned(),
            5 => "\u{2265} 32".to_owned(),
            _ => format!("{}", 1 << step),
        };
        picture.cell(&hex(colour), at, (CELL.0 - 1.0, CELL.1 - 1.0), &name);
        picture.text_on(colour, (at.0 + 0.5 * CELL.0, at.1 + 11.5), &name);
    }
    let x = LABELS + 6.0 * CELL.0 + BETWEEN;
    picture.text("small", Anchor::Start, (x, y + 12.0), "1 = noise alone;  \u{b7} = nothing compared here");
}
