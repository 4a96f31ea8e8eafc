//! What the closures of turns say of the stops: the marginal likelihood of a stop's variance, scales being free.
//!
//! From one stop to the next a turn leaves `d = x k + s' − s + n`: x the angle turned, k the error of the axis's scale, s' the stop
//! before and s this one, both of the unknown variance v, n the gyroscope's noise of variance a. A visit's closures share stops: for
//! every v of a grid a scalar Kalman filter carries what is known of the last stop, `s' = m + c k` with variance p, at first (0, 0, v):
//!
//! `S = p + v + a`, `r = d − m`, `h = x + c`;  `m ← −r v/S`, `c ← h v/S`, `p ← v − v²/S`
//!
//! so that a closure adds `h²/S` to the information on k and `ln S + r²/S` to the cost. What gravity says of k (the filter's
//! posterior less the closures' share of it) is added at the end. A stop between two turns is thus counted once, and scales that follow
//! the stops' errors take up degrees of freedom.

use super::normal::mean_variance;
use crate::DEGREE_RAD;
use crate::setup::TurnStops;

/// Least sigma of the grid, rad: a millidegree, 1 µm on a 6 cm box. It grows by √2 a step, to 5.8°.
const LEAST: f32 = 0.001 * DEGREE_RAD;
const GRID: usize = 26;
/// A fence holds to a degree, a hand errs by a quarter of a degree at least: steps of the grid.
const FENCED: core::ops::Range<usize> = 0..20;
const BY_HAND: core::ops::Range<usize> = 16..GRID;

/// Of one variance.
#[derive(Clone, Copy, Debug, Default)]
struct Hypothesis {
    /// `Σ h²/S` and `Σ h r/S` of each axis.
    information: [f32; 3],
    product: [f32; 3],
    /// `Σ ln S + r²/S`.
    cost: f32,
    /// The last stop: m, c and p. None at the beginning of a visit.
    stop: Option<[f32; 3]>,
}

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closures {
    grid: [Hypothesis; GRID],
    /// Of the variance in force.
    current: Hypothesis,
    /// The gyroscope's own variance, summed, and how many closures that is.
    noise: f32,
    count: f32,
}

impl Closures {
    /// Turning by `turned_rad` about `axis` left `residual` rad between the stop before and this one; `noise` is the gyroscope's own
    /// variance in it, `variance` that of a stop in force.
    pub fn take(&mut self, axis: usize, turned_rad: f32, residual: f32, noise: f32, variance: f32) {
        self.noise += noise;
        self.count += 1.0;
        self.current.take(axis, turned_rad, residual, noise, variance);
        for (hypothesis, variance) in self.grid.iter_mut().zip(variances()) {
            hypothesis.take(axis, turned_rad, residual, noise, variance);
        }
    }

    /// The box leaves the face, or its first stop is another from now on.
    pub fn end_visit(&mut self) {
        self.current.stop = None;
        self.grid.iter_mut().for_each(|hypothesis| hypothesis.stop = None);
    }

    /// Mean of the posterior, rad²; none without closures. `scales`: of each axis the filter's estimate of `k` and its variance, found
    /// with the variance in force. A closure of variance `2v + a` is seen beside `a/2`.
    pub fn variance(&self, stops: TurnStops, scales: &[(f32, f32); 3]) -> Option<f32> {
        let range = if stops == TurnStops::Fenced { FENCED } else { BY_HAND };
        let gravity: [(f32, f32); 3] = core::array::from_fn(|axis| {
            let (k, variance) = scales[axis];
            let information = 1.0 / variance - self.current.information[axis];
            // A difference of two sums: below a hundredth of them it is `f32`'s rounding.
            if information > 0.01 / variance {
                (information, k / variance - self.current.product[axis])
            } else {
                (0.0, 0.0)
            }
        });
        let first = range.start;
        let grid = variances().skip(first).take(range.len());
        let noise = 0.5 * self.noise / self.count;
        // A fence that is exact is as likely as one that is not; a hand is never.
        let exact = if stops == TurnStops::Fenced { 1.0 } else { 0.0 };
        (self.count > 0.5)
            .then(|| mean_variance(grid, noise, exact, |index, _| self.grid[first + index].log_likelihood(&gravity)))
    }
}

impl Hypothesis {
    fn take(&mut self, axis: usize, turned_rad: f32, residual: f32, noise: f32, variance: f32) {
        let [mean, follows, own] = self.stop.unwrap_or([0.0, 0.0, variance]);
        let weight = 1.0 / (own + variance + noise);
        let (left, coefficient) = (residual - mean, turned_rad + follows);
        self.information[axis] += weight * coefficient * coefficient;
        self.product[axis] += weight * coefficient * left;
        self.cost += weight * left * left - libm::logf(weight);
        let share = variance * weight;
        self.stop = Some([-share * left, share * coefficient, variance * (1.0 - share)]);
    }

    fn log_likelihood(&self, gravity: &[(f32, f32); 3]) -> f32 {
        let mut cost = self.cost;
        for (axis, (own, product)) in gravity.iter().enumerate() {
            let information = self.information[axis] + own;
            if information > 0.0 {
                let product = self.product[axis] + product;
                cost += libm::logf(information) - product * product / information;
            }
        }
        -0.5 * cost
    }
}

fn variances() -> impl Iterator<Item = f32> + Clone {
    let mut variance = 0.5 * LEAST * LEAST;
    core::iter::repeat_with(move || {
        variance *= 2.0;
        variance
    })
    .take(GRID)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fixed draws of unit variance, three to a visit: first stop and two closures.
    const DRAWS: [[f32; 3]; 6] =
        [[0.3, -1.2, 0.8], [1.5, 0.2, -0.6], [-0.9, 0.7, 1.1], [0.1, -1.6, 0.5], [-1.3, 1.0, -0.2], [1.2, 0.4, -1.1]];

    /// There and back on six faces by stops of `sigma`, of a scale that is off by `scale`.
    fn there_and_back(sigma: f32, scale: f32) -> Closures {
        let mut closures = Closures::default();
        for (visit, draw) in DRAWS.iter().enumerate() {
            for (turn, x) in [(1, core::f32::consts::TAU), (2, -core::f32::consts::TAU)] {
                let left = scale * x + sigma * (draw[turn - 1] - draw[turn]);
                closures.take(visit / 2, x, left, 1e-9, sigma * sigma);
            }
            closures.end_visit();
        }
        closures
    }

    #[test]
    fn a_known_spread_is_found_whatever_the_scale() {
        let sigma = 0.05 * DEGREE_RAD;
        for scale in [0.0, 1e-4, 3e-3] {
            let closures = there_and_back(sigma, scale);
            let found = closures.variance(TurnStops::Fenced, &[(0.0, 1e3); 3]).expect("closures");
            let found = libm::sqrtf(found) / sigma;
            assert!((0.8..1.7).contains(&found), "scale off by {scale}: {found}");
        }
        assert_eq!(Closures::default().variance(TurnStops::Fenced, &[(0.0, 1.0); 3]), None);
    }

    /// What the gyroscope's noise explains is no stop's: where it leaves a third of its sigma, less than half of that is blamed on stops,
    /// be the grid's least sigma a hundredth of it or a tenth.
    #[test]
    fn noise_is_not_blamed_on_stops() {
        for noise in [0.01f32, 0.1].map(|degrees| degrees * DEGREE_RAD) {
            let mut closures = Closures::default();
            for (visit, draw) in DRAWS.iter().enumerate() {
                closures.take(visit / 2, core::f32::consts::TAU, 0.3 * noise * draw[0], noise * noise, 1e-7);
                closures.end_visit();
            }
            let found = closures.variance(TurnStops::Fenced, &[(0.0, 1e3); 3]).expect("closures");
            assert!(libm::sqrtf(found) < 0.5 * noise, "{} of {noise}", libm::sqrtf(found));
        }
    }

    /// Two closures with a stop in common: the covariance of both at once, `[[2v + a, −v], [−v, 2v + a]]`, says the same.
    #[test]
    fn a_visit_is_its_joint_likelihood() {
        let (v, a, x, [first, second]) = (3e-6f32, 1e-6f32, [6.3f32, -6.1], [2e-3f32, -1.5e-3]);
        let mut hypothesis = Hypothesis::default();
        hypothesis.take(0, x[0], first, a, v);
        hypothesis.take(0, x[1], second, a, v);
        let inverse = nalgebra::Matrix2::new(2.0 * v + a, -v, -v, 2.0 * v + a).try_inverse().expect("regular");
        let (x, d) = (nalgebra::Vector2::from(x), nalgebra::Vector2::new(first, second));
        let cost = d.dot(&(inverse * d)) - libm::logf(inverse.determinant());
        assert!((hypothesis.information[0] / x.dot(&(inverse * x)) - 1.0).abs() < 1e-4);
        assert!((hypothesis.product[0] / x.dot(&(inverse * d)) - 1.0).abs() < 1e-4);
        assert!((hypothesis.cost - cost).abs() < 1e-3, "{} {cost}", hypothesis.cost);
    }
}
