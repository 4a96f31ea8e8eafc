//! Moves that end elsewhere than they were measured to: nothing else may be left, for their scatter passes for the noise of moves.
//!
//! The estimator takes what moves from rest to rest scatter for motion's own noise, by hand and in turns (`estimate/moves.rs`). Of each kind the
//! best factor s on the noise of rest stands against the largest that is borne: twice the logarithm of their likelihoods' ratio is ½χ²₁
//! at that bound. One move in twenty may be disturbed by itself.

use tumble_core::estimate::hinge::Hinge;

use super::null::FALSE_ALARMS;
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Arrival;
use crate::diagnose::twin::noise::{BIAS_WALK_FLOOR, FORCE_WALK_FLOOR, Noise};

/// Noise in motion over that at rest, squared, that a diagnosis has to bear: 1.5 times as much.
const BORNE: f32 = 2.25;
/// Steps of the grid above it, each a quarter of an octave: up to 10⁶.
const GRID: usize = 80;

/// They scatter by more than any noise.
#[derive(Clone, Copy, Debug)]
pub struct Restless {
    /// By so many times the noise of rest, squared.
    pub times: f64,
    /// Probability of as much by chance.
    pub p_value: f64,
    /// Those by hand? Else the turns.
    pub in_hand: bool,
}

/// Do they, under the noise that the search ended with?
pub fn restless(twin: &Twin, noise: &Noise) -> Option<Restless> {
    // Where motion that is as good as rest fits best, something else accounts for where moves ended.
    if noise.turn_scale <= 1.0 && noise.hand_scale <= 1.0 {
        return None;
    }
    // A walk that nobody names is no excuse; one that is named is as large as the search says, whatever the estimator took it for.
    let walks = noise.bias_walk > BIAS_WALK_FLOOR || noise.force_walk > FORCE_WALK_FLOOR;
    let walked = |arrival: &Arrival| {
        let named = noise.bias_walk * arrival.by_bias_walk + noise.force_walk * arrival.by_force_walk;
        if walks { arrival.hinge.walked.max(named as f32) } else { 0.0 }
    };
    let kinds = [true, false].map(|in_hand| {
        let arrivals = twin.arrivals.iter().filter(|arrival| arrival.hinge.in_hand == in_hand);
        let hinges = arrivals.map(|arrival| Hinge { walked: walked(arrival), ..arrival.hinge });
        let (times, p_value) = chance(&hinges.collect::<Vec<_>>());
        // Either of two kinds.
        Restless { times, p_value: 2.0 * p_value, in_hand }
    });
    kinds.into_iter().filter(|kind| kind.p_value < FALSE_ALARMS).min_by(|a, b| a.p_value.total_cmp(&b.p_value))
}

/// The best factor, and the probability that it is as much likelier than what is borne.
fn chance(hinges: &[Hinge]) -> (f64, f64) {
    let log = |times: f32| hinges.iter().map(|hinge| f64::from(hinge.log_likelihood(times))).sum::<f64>();
    let borne = log(BORNE);
    let grid = (0..GRID).map(|step| BORNE * (0.25 * step as f32).exp2());
    let (times, best) =
        grid.map(|times| (times, log(times))).fold((BORNE, borne), |best, one| if one.1 > best.1 { one } else { best });
    (f64::from(times), 0.5 * libm::erfc((best - borne).sqrt()))
}

impl Restless {
    /// In words.
    pub fn shape(&self) -> String {
        let kind = if self.in_hand { "moves by hand" } else { "turns" };
        format!("{kind}, whose ends scatter by {:.0} times (squared) what noise explains", self.times)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tumble_sim::rng::{Purpose, Rng};

    /// So many moves of a noise `times` that of rest, squared; rests on both sides are half as noisy as a move.
    fn moves(count: usize, times: f64, seed: u64) -> Vec<Hinge> {
        let mut rng = Rng::new(seed, Purpose::Box);
        let level = 0.5;
        let square = |draw: nalgebra::Vector3<f64>| (draw.x * draw.x + draw.y * draw.y) * (level + times);
        let hinge = |square: f64| Hinge { square: square as f32, level: level as f32, walked: 0.0, in_hand: true };
        (0..count).map(|_| hinge(square(rng.normal3()))).collect()
    }

    /// What is borne is an alarm no oftener than is said, and ten times as much is one.
    #[test]
    fn alarms_are_as_rare_as_they_say() {
        for count in [6, 20] {
            let alarms = |times: f64| (0..4000).filter(|seed| chance(&moves(count, times, *seed)).1 < 0.01).count();
            let (borne, more) = (alarms(2.25), alarms(40.0));
            assert!(borne < 60, "{borne} of 4000 with {count} moves");
            assert!(more > 3600, "{more} of 4000 with {count} moves");
        }
        assert!(chance(&moves(30, 1.0, 1)).1 > 0.1);
    }
}
