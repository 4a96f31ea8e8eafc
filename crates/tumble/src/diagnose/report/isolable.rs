//! Which effects this recording can tell apart: of the row's signal, the share that the column's effect can imitate.

use super::svg::{Anchor, Picture, blend, hex};
use crate::diagnose::exhibits::Exhibits;

const CELL: f64 = 23.0;
const LABELS: f64 = 180.0;
/// Slanted names above need this.
const TOP: f64 = 150.0;
/// Lightness falls all the way.
const SCALE: [[u8; 3]; 4] = [[241, 244, 247], [167, 203, 226], [62, 124, 177], [13, 49, 98]];

/// The picture; none where there are no effects to compare.
pub fn picture(exhibits: &Exhibits) -> Option<String> {
    let names = &exhibits.isolable;
    if names.is_empty() || exhibits.isolability.len() != names.len() {
        return None;
    }
    let side = names.len() as f64 * CELL;
    let mut picture = Picture::new(LABELS + side + 110.0, TOP + side + 44.0);
    for (k, name) in names.iter().enumerate() {
        let middle = (k as f64 + 0.5) * CELL;
        picture.text("small", Anchor::End, (LABELS - 6.0, TOP + middle + 4.0), name);
        picture.slanted("small", (LABELS + middle + 4.0, TOP - 6.0), 55.0, name);
    }
    let mut alike = 0;
    for (i, row) in exhibits.isolability.iter().enumerate() {
        for (j, share) in row.iter().enumerate().take(names.len()) {
            let at = (LABELS + j as f64 * CELL, TOP + i as f64 * CELL);
            if i == j {
                picture.bar("diagonal", at.0, at.1, CELL - 1.0, CELL - 1.0);
                continue;
            }
            let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
            alike += usize::from(share > 0.95);
            let colour = blend(&SCALE, share);
            let note = format!("{:.0} % of {} can be imitated by {}", 100.0 * share, names[i], names[j]);
            picture.cell(&hex(colour), at, (CELL - 1.0, CELL - 1.0), &note);
            if share >= 0.5 {
                let middle = (at.0 + 0.5 * CELL - 0.5, at.1 + 0.5 * CELL + 3.5);
                picture.text_on(colour, middle, &format!("{:.0}", 100.0 * share));
            }
        }
    }
    legend(&mut picture, TOP + side + 14.0);
    Some(picture.finish(&format!(
        "Matrix of {} effects: how much of the row's signal the column's effect imitates; {alike} pairs exceed 95 percent.",
        names.len()
    )))
}

fn legend(picture: &mut Picture, y: f64) {
    picture.text("small", Anchor::End, (LABELS - 6.0, y + 15.0), "share imitated, percent:");
    for (k, share) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let colour = blend(&SCALE, share);
        let at = (LABELS + 2.0 * k as f64 * CELL, y);
        let text = format!("{:.0}", 100.0 * share);
        picture.cell(&hex(colour), at, (2.0 * CELL - 1.0, CELL - 1.0), &text);
        picture.text_on(colour, (at.0 + CELL, at.1 + 15.0), &text);
    }
}
