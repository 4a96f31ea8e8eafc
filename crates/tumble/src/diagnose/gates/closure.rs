//! Turns against a fence that miss whole revolutions by more than any scale error (`incomplete_turn`, in its gross form; the
//! finer one is found by regression).
//!
//! Statistic: a turn's raw angle less the nearest quarter of a revolution (a box against a fence stops at quarters). Scale errors are 3 %
//! (sheet), cross-axis 2 % in quadrature 0.02 %: 6 % of the angle plus 1° is beyond two sheet limits, which no clean recording reaches.

use tumble_core::procedure::TurnStops;
use tumble_core::tape::{Exclusion, Kind};

use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const SCALE: f64 = 0.06;
const FLOOR_DEG: f64 = 1.0;
const QUARTER_DEG: f64 = 90.0;

pub(super) const CARD: Card = Card {
    id: "incomplete_turn",
    name: "turns stop short of a whole revolution",
    equation: "turned by ±(360° − δ)",
    typical: "a displaced or missed stop: 1 to 5 degrees; a good one holds to 0.1",
    shows: "turns stated to end against a stop",
    confounded: &["gyro_scale_asymmetry"],
    separate_by: "mark the box's place on the table before the turn and look at it afterwards",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    if view.scene.recording.metadata.turns != Some(TurnStops::Fenced) {
        let why = "turns are not stated to end against a stop (# turns: fenced)";
        return Outcome { limit: untestable(&CARD, "deg", why), ..Outcome::default() };
    }
    let missed = |(number, segment): (usize, &tumble_core::tape::Segment)| match segment.kind {
        Kind::OnTable { angle_rad, .. } if segment.exclusion == Exclusion::None => {
            let angle_deg = f64::from(angle_rad).to_degrees();
            let miss_deg = angle_deg - (angle_deg / QUARTER_DEG).round() * QUARTER_DEG;
            // Beyond 600° 6 % is more than any miss can be.
            let gross = angle_deg.abs() > 200.0 && miss_deg.abs() > SCALE * angle_deg.abs() + FLOOR_DEG;
            gross.then_some((number, miss_deg))
        }
        _ => None,
    };
    let missed: Vec<(usize, f64)> = view.scene.segments.iter().enumerate().filter_map(missed).collect();
    let why = "one turn by more than a scale error explains";
    let mut outcome = Outcome { limit: limit(&CARD, SCALE * 360.0 + FLOOR_DEG, "deg", why), ..Outcome::default() };
    let Some(worst) = missed.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { return outcome };
    let mut place = view.place(0, view.samples_of(&view.scene.segments[worst.0]));
    place.segments = missed.iter().map(|miss| miss.0).collect();
    let parameters = vec![value("missed", worst.1, 0.03 * 360.0, "deg"), value("turns", missed.len() as f64, 0.0, "")];
    outcome.found = Some(found(&CARD, 12.0 * missed.len() as f64, parameters, place));
    outcome
}
