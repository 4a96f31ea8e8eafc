//! How noisy motion is: from the level after each move, turns and moves by hand each by themselves.
//!
//! The level error after a move about the nominal attitude, squared and over its variance, is χ²₂. In units of what the gyroscope as noisy as at
//! rest makes of it, that variance is `level + walked + s` (`hinge.rs`). The two kinds have an s of their own: a put-down rings at 25 to 45 Hz,
//! which at 100 samples a second folds into the rotation as 0.1 to 0.4 mrad (sim), where a turn beside it has 2 nrad; in one median of all, five
//! moves by hand passed for as good as twelve turns. s − 1 is the mean of its posterior (`normal.rs`), for a test that must be sure finds
//! no factor of three in five moves. One move in twenty is disturbed by itself.

use super::Noise;
use super::hinge::{Hinge, disturbance};
use super::normal::mean_variance;
use super::sums::SegmentNoise;

/// Steps of the grid of `s − 1`, each a factor of two from 1/16 on: up to 260 000.
const GRID: usize = 23;
/// The odds that motion is as noisy as rest: a smooth turn is but for one in ten, and every other hand sets a box down with a bump.
const TURNS_AS_REST: f32 = 9.0;
const MOVES_AS_REST: f32 = 1.0;

/// Judges all moves of a pass. True if no move's weight changed by more than this share.
pub fn weigh<const S: usize>(noise: &mut Noise, moves: &mut heapless::Vec<SegmentNoise, S>, share: f32) -> bool {
    let hinges = || moves.iter().filter_map(|segment| segment.hinge.as_ref());
    noise.turn_scale = scale(hinges().filter(|hinge| !hinge.in_hand), TURNS_AS_REST);
    noise.hand_scale = scale(hinges().filter(|hinge| hinge.in_hand), MOVES_AS_REST);
    let mut steady = true;
    for segment in moves {
        let own = segment.hinge.map_or(1.0, |hinge| disturbance(hinge.nis(noise)));
        steady &= libm::fabsf(own - segment.rate_scale) < share * own;
        segment.rate_scale = own;
    }
    steady
}

/// Mean of the factor's posterior; `as_rest`: the odds that it is 1.
fn scale<'a>(hinges: impl Iterator<Item = &'a Hinge> + Clone, as_rest: f32) -> f32 {
    let (information, count) =
        hinges.clone().fold((0.0, 0.0), |(sum, count), hinge| (sum + 1.0 / hinge.variance(1.0), count + 1.0));
    if information == 0.0 {
        return 1.0;
    }
    let grid = (0..GRID).map(|step| libm::exp2f(step as f32 - 4.0));
    let log = |_: usize, excess: f32| hinges.clone().map(|hinge| hinge.log_likelihood(1.0 + excess)).sum();
    1.0 + mean_variance(grid, count / information, as_rest, log)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::{BoxFaces, TurnStops};
    use crate::tape::Tape;

    /// Squares of χ²₂ at the middles of n equal shares, times the variance under a factor `scale`.
    fn hinges(count: usize, scale: f32, in_hand: bool) -> impl Iterator<Item = SegmentNoise> {
        let level = 0.25;
        (0..count).map(move |k| {
            let chi = -2.0 * libm::logf(1.0 - (k as f32 + 0.5) / count as f32);
            let hinge = Some(Hinge { square: chi * (level + scale), level, walked: 0.0, in_hand });
            SegmentNoise { force_scale: 1.0, rate_scale: 1.0, hinge }
        })
    }

    fn weighed(moves: impl Iterator<Item = SegmentNoise>) -> (Noise, heapless::Vec<SegmentNoise, 32>) {
        let mut noise = Noise::from_rests(&Tape::<4, 4>::new(), TurnStops::ByHand, BoxFaces::Unknown);
        let mut moves = moves.collect();
        assert!(weigh(&mut noise, &mut moves, 1.0));
        (noise, moves)
    }

    #[test]
    fn moves_by_hand_are_told_from_turns() {
        let (noise, _) = weighed(hinges(12, 1.0, false).chain(hinges(6, 4.0, true)));
        assert!(noise.turn_scale < 1.1 && (2.5..6.0).contains(&noise.hand_scale), "{noise:?}");
        let (noise, _) = weighed(hinges(12, 1.0, false).chain(hinges(6, 1.0, true)));
        assert!(noise.turn_scale < 1.1 && noise.hand_scale < 1.2, "{noise:?}");
        let (noise, _) = weighed(hinges(17, 200.0, true));
        assert!((150.0..300.0).contains(&noise.hand_scale) && noise.turn_scale == 1.0, "{noise:?}");
    }

    #[test]
    fn one_bad_move_is_no_noise_of_all() {
        let mut bad = hinges(1, 1.0, true).map(|mut segment| {
            segment.hinge.as_mut().expect("one").square = 2500.0;
            segment
        });
        let (noise, moves) = weighed(hinges(6, 1.0, true).chain(core::iter::from_fn(|| bad.next())));
        assert!(noise.hand_scale < 1.3, "{noise:?}");
        assert!(moves[6].rate_scale > 500.0 && moves[..6].iter().all(|segment| segment.rate_scale < 1.3));
    }
}
