//! Normal equations with nuisance unknowns eliminated: what is left says of the rest what the data say when these are free.

/// Sums of `weight · row · rowᵀ`. The last column is what was observed, so that the last diagonal element, once all unknowns
/// are eliminated, is the weighted sum of squared residuals.
#[derive(Clone, Copy, Debug)]
pub struct Normal<const N: usize> {
    sums: [[f32; N]; N],
}

/// Some of the unknowns, a bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unknowns(u32);

impl Unknowns {
    /// None.
    pub const NONE: Self = Self(0);

    /// From the first to before the last.
    pub const fn range(first: usize, end: usize) -> Self {
        Self((1 << end) - (1 << first))
    }

    /// These and those.
    pub const fn and(self, others: Self) -> Self {
        Self(self.0 | others.0)
    }

    const fn without(self, one: usize) -> Self {
        Self(self.0 & !(1 << one))
    }

    const fn has(self, one: usize) -> bool {
        self.0 & (1 << one) != 0
    }
}

impl<const N: usize> Default for Normal<N> {
    fn default() -> Self {
        Self { sums: [[0.0; N]; N] }
    }
}

impl<const N: usize> Normal<N> {
    /// Takes an observation in: its coefficients, then its value.
    pub fn take(&mut self, row: &[f32; N], weight: f32) {
        for (sums, left) in self.sums.iter_mut().zip(row) {
            for (sum, right) in sums.iter_mut().zip(row) {
                *sum += weight * left * right;
            }
        }
    }

    /// What is known of an unknown before: zero with this sigma.
    pub fn expect(&mut self, unknown: usize, sigma: f32) {
        self.sums[unknown][unknown] += 1.0 / (sigma * sigma);
    }

    /// Eliminates unknowns; returns how many of them the data determine at all, and the logarithm of these ones' determinant.
    pub fn eliminate(&mut self, unknowns: Unknowns) -> (usize, f32) {
        let (mut rank, mut log_determinant) = (0, 0.0);
        let own: [f32; N] = core::array::from_fn(|index| self.sums[index][index]);
        for (pivot, own) in own.iter().enumerate().filter(|(pivot, _)| unknowns.has(*pivot)) {
            let row = self.sums[pivot];
            // What elimination left of a pivot below this is rounding.
            if row[pivot] <= 1e-5 * own {
                continue;
            }
            rank += 1;
            log_determinant += libm::logf(row[pivot]);
            for (index, sums) in self.sums.iter_mut().enumerate().filter(|(index, _)| *index != pivot) {
                let share = row[index] / row[pivot];
                sums.iter_mut().zip(&row).for_each(|(sum, value)| *sum -= share * value);
            }
        }
        (rank, log_determinant)
    }

    /// Value and variance of one unknown with `others` free; none where the data do not determine it.
    pub fn marginal(&self, unknown: usize, others: Unknowns) -> Option<(f32, f32)> {
        let mut left = *self;
        left.eliminate(others.without(unknown));
        let information = left.at(unknown, unknown);
        let determined = information > 1e-5 * self.at(unknown, unknown);
        determined.then(|| (left.at(unknown, N - 1) / information, 1.0 / information))
    }

    /// An element.
    pub fn at(&self, row: usize, column: usize) -> f32 {
        self.sums[row][column]
    }
}

/// The mean of the posterior of a variance v over a logarithmic grid, each step a factor of two. What is seen has the variance `v + noise`,
/// and the prior is Jeffreys' for that, `dv/(v + noise)`: uniform over the logarithm of what stands above the noise, and nothing
/// for what is lost in it (Tiao & Tan 1965). Where there may as well be nothing at all, `nothing` times as much as all of this stands on the
/// least value besides. The mean, and not the peak, is what variances of other things are made of: these are linear in it.
pub fn mean_variance(
    grid: impl Iterator<Item = f32> + Clone,
    noise: f32,
    nothing: f32,
    log_likelihood: impl Fn(usize, f32) -> f32,
) -> f32 {
    let prior = |variance: f32| variance / (variance + noise);
    let least = nothing * grid.clone().map(prior).sum::<f32>();
    let (mut best, mut weights, mut sum) = (f32::NEG_INFINITY, 0.0f32, 0.0f32);
    for (index, variance) in grid.enumerate() {
        let log = log_likelihood(index, variance);
        if log > best {
            let scale = libm::expf(best - log);
            weights *= scale;
            sum *= scale;
            best = log;
        }
        let weight = libm::expf(log - best) * (prior(variance) + if index == 0 { least } else { 0.0 });
        weights += weight;
        sum += weight * variance;
    }
    sum / weights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line through four points: slope with the offset free, and what is left.
    #[test]
    fn elimination_is_regression() {
        let mut normal = Normal::<3>::default();
        for (x, y) in [(0.0, 1.0), (1.0, 3.1), (2.0, 4.9), (3.0, 7.0)] {
            normal.take(&[1.0, x, y], 4.0);
        }
        let (slope, variance) = normal.marginal(1, Unknowns::range(0, 2)).expect("two unknowns");
        assert!((slope - 1.98).abs() < 1e-5 && (variance - 1.0 / 20.0).abs() < 1e-6, "{slope} {variance}");
        assert_eq!(normal.eliminate(Unknowns::range(0, 1)), (1, libm::logf(16.0)));
        assert!((normal.at(1, 2) / normal.at(1, 1) - 1.98).abs() < 1e-5);
        assert!((normal.at(1, 1) - 4.0 * 5.0).abs() < 1e-5);
        assert!((normal.at(2, 2) - normal.at(1, 2) * 1.98 - 4.0 * 0.018).abs() < 1e-3, "{}", normal.at(2, 2));
    }

    /// Inverse gamma: n squares of sum n v have a posterior mean of v n/(n − 2) under a prior uniform in log v.
    #[test]
    fn the_mean_is_the_posteriors() {
        let (n, v) = (10.0, 1e-6f32);
        let grid = (0..24).map(|k| 1e-9 * libm::exp2f(k as f32));
        let mean = mean_variance(grid, 0.0, 0.0, |_, x| -0.5 * n * (libm::logf(x) + v / x));
        assert!((mean / (v * n / (n - 2.0)) - 1.0).abs() < 0.02, "{mean}");
    }
}
