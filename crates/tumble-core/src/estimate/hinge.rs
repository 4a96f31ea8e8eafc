//! How far from level a move ended: one number in units of what is expected of it.

use super::Noise;

/// Share of moves that are taken to be disturbed, and the logarithm of the most by which their variance may be larger (1e4).
const DISTURBED: f32 = 0.05;
const DISTURBANCE_LOG: f32 = 9.21;

/// Level error after a move, squared, and what its variance is made of, all over what the gyroscope as noisy as at rest makes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinge {
    /// Squared.
    pub square: f32,
    /// Of the rests on both sides.
    pub level: f32,
    /// By biases that walk.
    pub walked: f32,
    /// Did a hand carry it? Else it turned on the table.
    pub in_hand: bool,
}

impl Hinge {
    /// χ²₂ if the move is like the others of its kind.
    pub fn nis(&self, noise: &Noise) -> f32 {
        self.square / self.variance(if self.in_hand { noise.hand_scale } else { noise.turn_scale })
    }

    /// Under a factor on the noise of rest, in the same units.
    pub fn variance(&self, scale: f32) -> f32 {
        self.level + self.walked + scale
    }

    /// Of this square, under a factor.
    pub fn log_likelihood(&self, scale: f32) -> f32 {
        let variance = self.variance(scale);
        let (usual, disturbed) = likelihoods(0.5 * self.square / variance);
        libm::logf((usual + disturbed) / variance)
    }
}

/// Of a move as usual and of a disturbed one, its variance S times as large, ln S uniform up to ln 1e4, both over the density at zero: with
/// `a = χ²/2` they are `e^−a` and, over u = 1/S, `∫ e^−au du = (1 − e^−a)/a`.
fn likelihoods(a: f32) -> (f32, f32) {
    let like = libm::expf(-a);
    // Below a tenth of a sigma both integrals are constants.
    let disturbed = if a > 0.1 { (1.0 - like) / a } else { 1.0 };
    ((1.0 - DISTURBED) * like, DISTURBED / DISTURBANCE_LOG * disturbed)
}

/// By how much more variance than other moves' one is to be taken, whose level error is `nis`. The mean of u, by which the move's
/// information is to be multiplied, has `∫ u e^−au du = (1 − (1 + a) e^−a)/a²`. What lies within χ²₂ is left alone, what lies far out
/// gets a variance of χ²/2.
pub fn disturbance(nis: f32) -> f32 {
    let a = 0.5 * nis;
    if a <= 0.1 {
        return 1.0;
    }
    let (usual, disturbed) = likelihoods(a);
    let information = DISTURBED / DISTURBANCE_LOG * (1.0 - (1.0 + a) * libm::expf(-a)) / (a * a);
    (usual + disturbed) / (usual + information)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distant_move_loses_its_weight_and_a_usual_one_keeps_it() {
        let table = [(2.0, 1.0 / 0.99), (16.0, 2.5), (1e4, 5e3)];
        for (nis, expected) in table {
            assert!((disturbance(nis) / expected - 1.0).abs() < 0.1, "{nis}: {}", disturbance(nis));
        }
    }
}
