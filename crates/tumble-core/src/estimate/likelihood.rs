//! One variance behind values that are each known with their own.

use super::normal::mean_variance;

/// Steps of the grid: from the least variance by factors of two, to 5800 times its sigma.
const GRID: usize = 26;
/// Twice the logarithm of the likelihoods' ratio from which there certainly is something: ½χ²₁ exceeds it once in a thousand sessions.
pub const CERTAIN: f32 = 9.55;

/// `−2 ln L` of each variance of a grid, in units of its least.
#[derive(Clone, Copy, Debug, Default)]
pub struct Likelihood {
    costs: [f32; GRID],
    /// Number of values, and the sum of what they are known by.
    count: f32,
    information: f32,
}

impl Likelihood {
    /// A value of variance `v + noise`; `least` is the grid's least sigma.
    pub fn take(&mut self, value: f32, noise: f32, least: f32) {
        let (square, noise) = ((value / least) * (value / least), (noise / (least * least)).max(1.0));
        for (cost, variance) in self.costs.iter_mut().zip(variances()) {
            let own = variance + noise;
            *cost += libm::logf(own) + square / own;
        }
        self.count += 1.0;
        self.information += 1.0 / noise;
    }

    /// What a turn made of a state that is anew for every turn and had the variance `prior` at first: a posterior of this mean and
    /// variance says that `mean / c`, `c = 1 − variance/prior`, was seen with `variance / c`, or with `loose` if that is less.
    pub fn take_state(&mut self, mean: f32, variance: f32, prior: f32, loose: f32, least: f32) {
        let share = 1.0 - variance / prior;
        // What brought nothing says nothing.
        if share > 0.01 {
            self.take(mean / share, (variance / share).min(loose), least);
        }
    }

    /// Is there certainly more than the grid's least?
    pub fn is_certain(&self) -> bool {
        self.costs[0] - self.costs.iter().fold(f32::INFINITY, |least, cost| least.min(*cost)) > CERTAIN
    }

    /// Mean of the posterior; none without data. As often as not there is nothing that shows.
    pub fn mean(&self, least: f32) -> Option<f32> {
        let noise = self.count / self.information;
        (self.count > 0.5)
            .then(|| least * least * mean_variance(variances(), noise, 1.0, |index, _| -0.5 * self.costs[index]))
    }
}

fn variances() -> impl Iterator<Item = f32> + Clone {
    (0..GRID).map(|step| libm::exp2f(step as f32))
}
