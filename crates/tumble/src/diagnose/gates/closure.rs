//! Turns against a fence that miss whole revolutions by more than any scale error (`incomplete_turn`, in its gross form; the
//! finer one is found by regression).
//!
//! Statistic: a turn's raw angle less the nearest quarter of a revolution (a box against a fence stops at quarters). Scale errors are 3 %
//! (sheet), cross-axis 2 % in quadrature 0.02 %: 6 % of the angle plus 1° is beyond two sheet limits, which no clean recording reaches.
//! A turn may be made in pieces, with rests between: one that is whole together with its neighbours on the same face has missed nothing.

use tumble_core::procedure::TurnStops;
use tumble_core::tape::{Exclusion, Kind, Segment};

use super::tell::{Outcome, found, limit, untestable, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const SCALE: f64 = 0.06;
const FLOOR_DEG: f64 = 1.0;
const QUARTER_DEG: f64 = 90.0;
/// Less is no attempt at a whole turn.
const LEAST_DEG: f64 = 200.0;

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
    let missed: Vec<(usize, f64)> = visits(view.scene.segments).iter().flat_map(|turns| missed(turns)).collect();
    let why = "one turn by more than a scale error explains";
    let mut outcome = Outcome { limit: limit(&CARD, SCALE * 360.0 + FLOOR_DEG, "deg", why), ..Outcome::default() };
    let Some(worst) = missed.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { return outcome };
    let mut place = view.place(0, view.samples_of(&view.scene.segments[worst.0]));
    place.segments = missed.iter().map(|miss| miss.0).collect();
    let parameters = vec![value("missed", worst.1, 0.03 * 360.0, "deg"), value("turns", missed.len() as f64, 0.0, "")];
    outcome.found = Some(found(&CARD, 12.0 * missed.len() as f64, parameters, place));
    outcome
}

/// Of each stay on a face: the segments in which it turned, with their angles, degrees.
fn visits(segments: &[Segment]) -> Vec<Vec<(usize, f64)>> {
    let mut visits = vec![Vec::new()];
    for (number, segment) in segments.iter().enumerate() {
        match (segment.kind, visits.last_mut()) {
            (Kind::OnTable { angle_rad, .. }, Some(visit)) if segment.exclusion == Exclusion::None => {
                visit.push((number, f64::from(angle_rad).to_degrees()));
            }
            (Kind::Still { .. }, _) => {}
            _ => visits.push(Vec::new()),
        }
    }
    visits
}

/// Turns that miss whole quarters, and by how much.
fn missed(turns: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let off = |angle_deg: f64, of_deg: f64| angle_deg - (angle_deg / of_deg).round() * of_deg;
    // Beyond 600° 6 % is more than any miss can be.
    let gross = |angle_deg: f64, miss_deg: f64| {
        angle_deg.abs() > LEAST_DEG && miss_deg.abs() > SCALE * angle_deg.abs() + FLOOR_DEG
    };
    let whole = |from: usize, to: usize| {
        let sum_deg: f64 = turns[from..to].iter().map(|turn| turn.1).sum();
        sum_deg.abs() > LEAST_DEG && !gross(sum_deg, off(sum_deg, 360.0))
    };
    let in_pieces = |at: usize| (0..=at).any(|from| (at + 1..=turns.len()).any(|to| to - from > 1 && whole(from, to)));
    let alone = turns.iter().enumerate().map(|(at, (number, angle_deg))| (at, *number, *angle_deg));
    alone
        .filter(|(at, _, angle_deg)| gross(*angle_deg, off(*angle_deg, QUARTER_DEG)) && !in_pieces(*at))
        .map(|(_, number, angle_deg)| (number, off(angle_deg, QUARTER_DEG)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::missed;

    #[test]
    fn a_turn_in_pieces_has_missed_nothing_and_a_short_one_has() {
        assert_eq!(missed(&[(1, 231.0), (3, 127.0), (5, -360.0)]), []);
        assert_eq!(missed(&[(1, 325.0), (3, -359.0)]), [(1, -35.0)]);
        assert_eq!(missed(&[(1, 358.0), (3, -362.0), (5, 90.5)]), []);
    }
}
