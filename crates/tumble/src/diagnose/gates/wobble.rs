//! The spin axis of a whole turn wobbles (`spin_axis_wobble`).
//!
//! Statistic: attitude R(t) through a turn by the raw rates less their resting values, R = 1 at its start, where the box stands
//! flat. Without wobble some direction n of the box, its face's normal, keeps still: R(t)·n = n. The n that keeps stillest is
//! the first eigenvector of the symmetric part of the mean of R(t), and the rms angle by which R(t)·n strays is
//! √(2(1 − λ₁)). Scale errors change only the angle about n, and misaligned axes only n, so both are in the null for pure
//! turns; a bias off by 10 mdps strays 0.1° in 10 s. n is chosen to stray least, so the estimate is never above the wobble's
//! own rms. A person's hand has up to 1° by the contract's own reckoning, with harmonics 1.1° rms: the gate begins where
//! the median turn has 1.15° and three sigmas of the turns' scatter.

use nalgebra::{Matrix3, UnitQuaternion};
use tumble_core::motion::path::whole_turns;
use tumble_core::tape::{Exclusion, Kind};

use super::aliasing::nearest_rest;
use super::chance::median;
use super::tell::{Outcome, found, limit, untestable, value};
use super::view::{View, scatter};
use crate::diagnose::catalogue::Card;

const LEAST_DEG: f64 = 1.15;

pub(super) const CARD: Card = Card {
    id: "spin_axis_wobble",
    name: "spin axis wobbles",
    equation: "the box leans by w while it turns: R(t)·n circles about its mean",
    typical: "0.1 to 1 degree of a box turned by hand; more with a crumb under it or a hand that pulls upwards",
    shows: "gyro during whole turns",
    confounded: &["table_rocking"],
    separate_by: "turn it on a clean hard plate, pressing down in the middle",
};

/// The gate.
pub fn examine(view: &View) -> Outcome {
    let whole = |number: &usize| {
        let segment = &view.scene.segments[*number];
        matches!(segment.kind, Kind::OnTable { angle_rad, .. } if whole_turns(angle_rad).is_some_and(|n| n != 0))
            && segment.exclusion == Exclusion::None
    };
    let turns: Vec<(usize, f64)> =
        (0..view.scene.segments.len()).filter(whole).map(|number| (number, stray_deg(view, number))).collect();
    let untold = |why: &str| Outcome { limit: untestable(&CARD, "deg", why), ..Outcome::default() };
    if turns.len() < 2 {
        return untold("fewer than two whole turns on the table");
    }
    // A bias off by 1 °/s looks like 1.6° of wobble at 36 °/s.
    if view.rests.is_empty() {
        return untold("no rest is long enough to tell the gyroscope's bias: rest for two seconds between turns");
    }
    let strays: Vec<f64> = turns.iter().map(|turn| turn.1).collect();
    let sigma = (scatter(&strays) / (strays.len() as f64).sqrt()).max(0.02);
    let amplitude = median(strays);
    let least = LEAST_DEG + 3.0 * sigma;
    let mut outcome = Outcome { limit: limit(&CARD, least, "deg", ""), ..Outcome::default() };
    if amplitude > least {
        let first = view.samples_of(&view.scene.segments[turns[0].0]).start;
        let last = view.samples_of(&view.scene.segments[turns[turns.len() - 1].0]).end;
        let mut place = view.place(7, first..last);
        place.segments = turns.iter().map(|turn| turn.0).collect();
        let z = (amplitude - LEAST_DEG) / sigma;
        let parameters = vec![value("amplitude", amplitude, sigma, "deg")];
        outcome.found = Some(found(&CARD, (0.5 * z * z).clamp(12.0, 1e4), parameters, place));
    }
    outcome
}

fn stray_deg(view: &View, number: usize) -> f64 {
    let range = view.samples_of(&view.scene.segments[number]);
    let bias = nearest_rest(view, range.start);
    let (mut attitude, mut sum, mut turned_rad) = (UnitQuaternion::identity(), Matrix3::zeros(), 0.0);
    for i in range.start..range.end.saturating_sub(1) {
        let dt_s = view.t_s[i + 1] - view.t_s[i];
        let rate = ((view.rate(i) + view.rate(i + 1)) * 0.5 - bias).map(f64::to_radians);
        attitude *= UnitQuaternion::from_scaled_axis(rate * dt_s);
        // By the angle turned, so that pauses within a turn do not count.
        let weight = rate.norm() * dt_s;
        sum += attitude.to_rotation_matrix().matrix() * weight;
        turned_rad += weight;
    }
    let mean = sum / turned_rad.max(1e-9);
    let largest = ((mean + mean.transpose()) * 0.5).symmetric_eigenvalues().max();
    (2.0 * (1.0 - largest.min(1.0))).sqrt().to_degrees()
}
