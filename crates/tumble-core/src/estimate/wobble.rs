//! How far the face that a turn is made on leaves the table's plane, by marginal likelihoods.
//!
//! A box that turns on a table turns about its face's normal, which then stays where the table's is. The plate thus tells the
//! attitude during the turn, and with it the gyroscope's non-orthogonality, whose signature there is `k (sin ψ, cos ψ − 1)`. A
//! hand that makes the box wobble once a turn imitates that: hence the variances before the plate, one for all turns of a
//! session. The part that turns with the box has two states anew for every turn. A turn's posterior `(ν, P)` of one, from a
//! prior of variance σ², says that `y = ν / c` was seen with variance `r = P / c`, `c = 1 − P/σ²`, so that for every v of a grid y has
//! variance `v + r`: K, gyroscope and attitude are all in r. What is left over shows in the innovations.

use super::filter::Innovation;
use super::likelihood::Likelihood;
use crate::DEGREE_RAD;

/// What a wobble is taken for before any was seen, rad: nothing is learnt of a turn that wobbles by a degree.
pub const UNSEEN: f32 = DEGREE_RAD;
/// Least sigma, rad: 0.5 µm on 5 cm. The grid grows by √2 a step from there, to 3.3°.
const LEAST: f32 = 10e-6;

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wobble {
    turning: Likelihood,
    rest: Likelihood,
}

impl Wobble {
    /// How far the face was from the plate; `rest` is what the innovation's variance has for the rest, `loose` the
    /// most that is believed of what is left.
    pub fn take(&mut self, innovation: &Innovation, rest: f32, loose: f32) {
        self.rest.take(innovation.value, (innovation.variance - rest).min(loose), LEAST);
    }

    /// What a turn made of one of its two states, whose variance was `prior` at first.
    pub fn take_turn(&mut self, mean: f32, variance: f32, prior: f32, loose: f32) {
        self.turning.take_state(mean, variance, prior, loose, LEAST);
    }

    /// Variance of what turns with the box; none without turns.
    pub fn turning(&self) -> Option<f32> {
        self.turning.mean(LEAST)
    }

    /// Likewise of the rest.
    pub fn rest(&self) -> Option<f32> {
        self.rest.mean(LEAST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways from 160 fixed numbers of unit variance.
    fn found(wobble: f32) -> [f32; 2] {
        let mut sums = Wobble::default();
        for look in 0..160 {
            let draw = libm::sinf((7 * look) as f32 * 1.7) * core::f32::consts::SQRT_2;
            let (own, prior) = (170e-6f32 * 170e-6, UNSEEN * UNSEEN);
            let value = draw * libm::sqrtf(own + wobble * wobble);
            sums.take(&Innovation { value, variance: own + 7.0 * prior }, 7.0 * prior, 1.1 * own);
            let share = prior / (prior + own);
            sums.take_turn(share * value, share * own, prior, 1.1 * own);
        }
        [sums.rest(), sums.turning()].map(|variance| libm::sqrtf(variance.expect("turns")))
    }

    #[test]
    fn a_wobble_is_found_and_none_is_near_none() {
        assert!(found(0.0).into_iter().all(|found| found < 60e-6), "{:?}", found(0.0));
        for wobble in [350e-6, 17e-3] {
            let near = found(wobble).into_iter().all(|found| (found / wobble - 1.0).abs() < 0.2);
            assert!(near, "{:?}", found(wobble));
        }
        assert_eq!(Wobble::default().turning(), None);
        assert_eq!(Wobble::default().rest(), None);
    }
}
