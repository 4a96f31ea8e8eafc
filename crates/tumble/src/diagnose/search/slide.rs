//! Does a hand push the box about in its turns?
//!
//! A centimetre in a second is an acceleration of 4 mg, which is no physics of the sensor. It is a nuisance: the box's own horizontal
//! acceleration in frame n, a Gauss–Markov process of standard deviation σ and time constant τ. Both are looked for by climbing the evidence over a
//! grid, because it has one summit and most recordings show at the first step that there is nothing to climb.

use super::bench::Bench;
use super::ledger::Term;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::noise::Noise;

/// σ over gravity: 0.13 to 60 mg, by 1.67.
const SIGMAS: [f64; 13] =
    [1.3e-4, 2.2e-4, 3.6e-4, 6e-4, 1e-3, 1.7e-3, 2.8e-3, 4.6e-3, 7.7e-3, 0.013, 0.022, 0.036, 0.06];
/// τ, s: a jerk, a push, a box that slides through half a turn.
const TIMES: [f64; 6] = [0.17, 0.3, 0.55, 1.0, 1.7, 3.0];
/// Where the climb begins.
const START: (usize, usize) = (4, 3);
/// Half of what χ²₂ exceeds twice in a thousand recordings: a push of the wrong size is none.
const SURE: f64 = 6.21;

/// The noise with pushes in turns if the evidence is for them, else as it is; with its evidence.
pub fn slide(bench: &mut Bench, terms: &[Term], still: (Noise, f64)) -> (Noise, f64) {
    if !bench.twin.stretches.iter().any(|stretch| matches!(stretch.deed, Deed::Turn { .. })) {
        return still;
    }
    let mut known: Vec<((usize, usize), f64)> = Vec::new();
    let mut at = |bench: &mut Bench, place: (usize, usize)| {
        if let Some((_, evidence)) = known.iter().find(|(known, _)| *known == place) {
            return *evidence;
        }
        let evidence = bench.fit_alone(noise(still.0, place), terms).evidence;
        known.push((place, evidence));
        evidence
    };
    let mut best = (START, at(bench, START));
    loop {
        let (sigma, time) = best.0;
        let around =
            [(sigma.wrapping_sub(1), time), (sigma + 1, time), (sigma, time.wrapping_sub(1)), (sigma, time + 1)];
        let found = best.0;
        for place in around.into_iter().filter(|place| place.0 < SIGMAS.len() && place.1 < TIMES.len()) {
            let evidence = at(bench, place);
            if evidence > best.1 {
                best = (place, evidence);
            }
        }
        if best.0 == found {
            break;
        }
    }
    if best.1 > still.1 + SURE { (noise(still.0, best.0), best.1) } else { still }
}

fn noise(still: Noise, (sigma, time): (usize, usize)) -> Noise {
    Noise { slide_rad: SIGMAS[sigma], slide_s: TIMES[time], ..still }
}
