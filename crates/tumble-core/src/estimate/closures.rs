//! What the closures of turns say of the stops: the marginal likelihood of a stop's variance, scales being free.
//!
//! On a visit of m turns, closure i leaves `y = x k + h − sᵢ + nᵢ`: x the angle turned, k the error of the axis's scale, h the
//! first stop's error and sᵢ its own, both of the unknown variance v, nᵢ the gyroscope's noise of variance a. Their covariance
//! `(a + v) I + v 1 1ᵀ` has a closed inverse and determinant, so that for every v of a grid a visit adds to the
//! information on k, and what gravity says of k (the filter's posterior less the closures' share of it) is added at the end. A
//! stop between two turns is thus counted once, and scales that follow the stops' errors take up degrees of freedom.

use super::normal::mean_variance;
use crate::DEGREE_RAD;
use crate::setup::TurnStops;

/// Least sigma of the grid, rad: a millidegree, 1 µm on a 6 cm box. It grows by √2 a step, to 5.8°.
const LEAST: f32 = 0.001 * DEGREE_RAD;
const GRID: usize = 26;
/// A fence holds to a degree, a hand errs by a quarter of a degree at least: steps of the grid.
const FENCED: core::ops::Range<usize> = 0..20;
const BY_HAND: core::ops::Range<usize> = 16..GRID;

/// Sums over the visit in progress.
#[derive(Clone, Copy, Debug, Default)]
struct Visit {
    axis: usize,
    count: f32,
    noise: f32,
    x: f32,
    y: f32,
    xx: f32,
    xy: f32,
    yy: f32,
}

/// Of one variance.
#[derive(Clone, Copy, Debug, Default)]
struct Hypothesis {
    /// `xᵀ Σ⁻¹ x` and `xᵀ Σ⁻¹ y` of each axis.
    information: [f32; 3],
    product: [f32; 3],
    /// `yᵀ Σ⁻¹ y + ln det Σ`.
    cost: f32,
}

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closures {
    visit: Visit,
    grid: [Hypothesis; GRID],
    /// Of the variance in force.
    current: Hypothesis,
    any: bool,
}

impl Closures {
    /// A closure about `axis` after turning by `turned_rad` left `residual` rad; `noise` is the gyroscope's own variance in it.
    pub fn take(&mut self, axis: usize, turned_rad: f32, residual: f32, noise: f32) {
        let visit = &mut self.visit;
        visit.axis = axis;
        visit.count += 1.0;
        visit.noise += noise;
        visit.x += turned_rad;
        visit.y += residual;
        visit.xx += turned_rad * turned_rad;
        visit.xy += turned_rad * residual;
        visit.yy += residual * residual;
    }

    /// The box leaves the face, or its first stop is another from now on; `variance` is the one in force.
    pub fn end_visit(&mut self, variance: f32) {
        let visit = core::mem::take(&mut self.visit);
        if visit.count == 0.0 {
            return;
        }
        self.any = true;
        self.current.take(&visit, variance);
        for (hypothesis, variance) in self.grid.iter_mut().zip(variances()) {
            hypothesis.take(&visit, variance);
        }
    }

    /// Mean of the posterior, rad², under a prior uniform over the logarithm; none without closures. `scales`: of each axis the
    /// filter's estimate of `k` and its variance, found with the variance in force.
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
        self.any.then(|| {
            let grid = variances().skip(first).take(range.len());
            mean_variance(grid, |index, _| self.grid[first + index].log_likelihood(&gravity))
        })
    }
}

impl Hypothesis {
    fn take(&mut self, visit: &Visit, variance: f32) {
        let own = visit.noise / visit.count + variance;
        let weight = 1.0 / own;
        let shared = variance / (own + visit.count * variance);
        self.information[visit.axis] += weight * (visit.xx - shared * visit.x * visit.x);
        self.product[visit.axis] += weight * (visit.xy - shared * visit.x * visit.y);
        let determinant = visit.count * libm::logf(own) + libm::logf(1.0 + visit.count * variance * weight);
        self.cost += weight * (visit.yy - shared * visit.y * visit.y) + determinant;
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

fn variances() -> impl Iterator<Item = f32> {
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

    /// Two turns each way on six faces: the stops' own differences, scales removed by hand, tell the same.
    #[test]
    fn a_known_spread_is_found() {
        let sigma = 0.05 * DEGREE_RAD;
        // Fixed draws of unit variance, three to a visit: first stop and two closures.
        let draws = [
            [0.3f32, -1.2, 0.8],
            [1.5, 0.2, -0.6],
            [-0.9, 0.7, 1.1],
            [0.1, -1.6, 0.5],
            [-1.3, 1.0, -0.2],
            [1.2, 0.4, -1.1],
        ];
        let mut closures = Closures::default();
        for (visit, draw) in draws.iter().enumerate() {
            for (turn, x) in [(1, core::f32::consts::TAU), (2, -core::f32::consts::TAU)] {
                let scale = 1e-4 * x;
                closures.take(visit / 2, x, scale + sigma * (draw[0] - draw[turn]), 1e-9);
            }
            closures.end_visit(sigma * sigma);
        }
        let found = closures.variance(TurnStops::Fenced, &[(0.0, 1e3); 3]).expect("closures");
        let found = libm::sqrtf(found) / sigma;
        assert!((0.8..1.7).contains(&found), "{found}");
        assert_eq!(Closures::default().variance(TurnStops::Fenced, &[(0.0, 1.0); 3]), None);
    }
}
