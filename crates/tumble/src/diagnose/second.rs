//! A second look at slow recordings: does what contradicts itself do so only where the box was moved from face to face?
//!
//! What folds is a spectrum above half the rate. A put-down rings at 25 to 45 Hz (sim) up to the sensor's bandwidth (41 Hz), for a
//! tenth of a second; sampled at the rate F the part of it at F and its multiples stays in the rotation as if it had been
//! turned: W(F) = ∫ω·e^(−2πiFt) dt, a tenth of a degree at 30 to 40 Hz and nothing at 100. Folded it looks like slow motion, so that no
//! sample shows it; but every hinge has another error, which no model explains, and the search calls it unknown or bends a
//! name to it. Turns and rests have no such transients. So where the rate is below twice 41 Hz and something was found, all
//! is searched again with the rotation of the moves taken for lost: what stands without the moves stands; if nothing unknown is
//! left then, what only the moves showed is `undersampling`, tied with the names that it had.

use super::diagnosis::{Diagnosis, Verdict};
use super::gates;
use super::outcome::Outcome;
use crate::recording::Recording;

/// Twice the bandwidth that a sensor has at 200 Hz (MPU-9250, CONFIG = 3): what is sampled faster does not fold.
const RESOLVED_HZ: f64 = 82.0;

/// Whether a recording is so slow, and what was found of it such, that a second look is due.
pub fn is_due(recording: &Recording, first: &Diagnosis) -> bool {
    let slow = rate_hz(recording).is_some_and(|rate_hz| rate_hz < RESOLVED_HZ);
    let gated = |id: &str| gates::CARDS.iter().any(|card| card.id == id);
    let named = first.effects.iter().any(|effect| !gated(&effect.id));
    let told = first.effects.iter().any(|effect| effect.id == "undersampling");
    slow && !told && (named || first.unknown.is_some())
}

/// What to answer, given both.
pub fn settle(recording: &Recording, first: Outcome, second: Outcome) -> Outcome {
    // Without the moves a name may be one of a tie.
    let stands = |id: &str| {
        second.diagnosis.effects.iter().any(|effect| effect.id == id || effect.tied_with.iter().any(|tied| tied == id))
    };
    let gone: Vec<_> = first.diagnosis.effects.iter().filter(|effect| !stands(&effect.id)).cloned().collect();
    let resolved = second.diagnosis.unknown.is_none() && (first.diagnosis.unknown.is_some() || !gone.is_empty());
    let Some(rate_hz) = rate_hz(recording).filter(|_| resolved && second.exhibits.is_some()) else { return first };
    let unknown = first.diagnosis.unknown.as_ref();
    let place =
        unknown.map(|unknown| unknown.place.clone()).or_else(|| gone.first().map(|effect| effect.place.clone()));
    let Some(place) = place else { return first };
    let odds = unknown.map_or(0.0, |unknown| -unknown.p_value.max(1e-300).ln());
    let evidence = gone.iter().map(|effect| effect.evidence).fold(odds, f64::max);
    let instead = gone.into_iter().map(|effect| effect.id).collect();
    let mut settled = second;
    settled.diagnosis.effects.push(gates::in_moves(rate_hz, evidence, instead, place));
    settled.diagnosis.effects.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    settled.diagnosis.verdict = Verdict::EffectFound;
    settled.diagnosis.reasons.push(
        "The rotation between faces contradicts the rest of the recording, which agrees with itself: moves and put-downs are \
         faster than it was sampled."
            .into(),
    );
    settled
}

/// By the median interval.
fn rate_hz(recording: &Recording) -> Option<f64> {
    let mut spacings: Vec<f64> = recording.rows.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).collect();
    let middle = spacings.len() / 2;
    (!spacings.is_empty()).then(|| 1.0 / *spacings.select_nth_unstable_by(middle, f64::total_cmp).1)
}
