//! Moves that end elsewhere than they were measured to: nothing else may be left, for their scatter passes for the noise of moves.
//!
//! The estimator takes the median of what moves from rest to rest scatter for motion's own noise. With N times (squared) the noise of rest
//! the median of n moves' χ²₂ is 1.386 N; noise in motion 1.5 times that at rest is let pass (2.25 squared). A move is beyond
//! the median with probability `q = exp(−0.693 N/2.25)`, and half of them are with at most `(4 q (1 − q))^(n/2)` (Chernoff).

use super::null::FALSE_ALARMS;
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::noise::{BIAS_WALK_FLOOR, FORCE_WALK_FLOOR, Noise};

/// Noise in motion over that at rest, squared, that a diagnosis has to bear.
const BORNE: f64 = 2.25;

/// They scatter by more than any noise.
#[derive(Clone, Copy, Debug)]
pub struct Restless {
    /// By so many times the noise of rest, squared.
    pub times: f64,
    /// Largest probability of as much by chance.
    pub p_value: f64,
}

/// Do they, under the noise that the search ended with?
pub fn restless(twin: &Twin, noise: &Noise) -> Option<Restless> {
    let moved = twin.stretches.iter().filter(|stretch| {
        matches!(stretch.deed, Deed::Move | Deed::Turn { .. }) && !stretch.excluded && !stretch.broken
    });
    // A walk that nobody names is no excuse.
    let walks = noise.bias_walk > BIAS_WALK_FLOOR || noise.force_walk > FORCE_WALK_FLOOR;
    let times = if walks { noise.motion_scale } else { noise.moves_scatter };
    let p_value = chance(times, moved.count());
    (p_value < FALSE_ALARMS).then_some(Restless { times, p_value })
}

/// Bound of the probability that the median of so many moves is as far out.
fn chance(times: f64, moves: usize) -> f64 {
    if times <= BORNE {
        return 1.0;
    }
    let beyond = (-std::f64::consts::LN_2 * times / BORNE).exp();
    (4.0 * beyond * (1.0 - beyond)).powf(0.5 * moves as f64)
}

impl Restless {
    /// In words.
    pub fn shape(&self) -> String {
        format!("moves from rest to rest, which scatter by {:.0} times (squared) what noise explains", self.times)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Above the exact tail of half of n moves beyond the median, and not by more than tenfold; noise that is borne is no alarm.
    #[test]
    fn the_bound_is_a_bound() {
        let n = 12u32;
        let choose = |k: u32| (0..k).map(|i| f64::from(n - i) / f64::from(i + 1)).product::<f64>();
        for times in [4.0, 7.0, 20.0] {
            let q = 0.5f64.powf(times / BORNE);
            let tail: f64 = (n / 2..=n).map(|k| choose(k) * q.powi(k as i32) * (1.0 - q).powi((n - k) as i32)).sum();
            let bound = chance(times, n as usize);
            assert!(tail < bound && bound < 10.0 * tail, "{times}: {tail:e} {bound:e}");
        }
        assert_eq!(chance(2.0, 1000), 1.0);
        assert!(chance(5.0, 31) < FALSE_ALARMS && chance(5.0, 12) > FALSE_ALARMS);
    }
}
