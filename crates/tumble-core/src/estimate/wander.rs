//! Does a bias wander, and how much: the marginal likelihood of a random walk's density by the rests' means alone.
//!
//! A rest of length T shows the bias with the variance `r = density/T`; from rest to rest its variance grows by `q Δt`. For every q of a
//! grid a scalar Kalman filter per component carries what is known of the bias:
//!
//! `P ← P + q Δt`, `S = P + r`, cost `ln S + ν²/S`, `P ← P r/S`
//!
//! The likelihood is that of q itself, whatever q is in force. (Before this, the innovations of the pass's own filter were taken to grow by
//! `q Δt`. They grow by far less, for turns observe the bias too and the accelerometer's other numbers follow it: a walk believed by chance
//! then grew from pass to pass, to its cap.) What turns say of it is left out: less is seen, and nothing that is not there.

use super::normal::mean_variance;

/// Steps of the grid, each a factor of two.
const GRID: usize = 21;
/// Twice the logarithm of the likelihood's ratio to that of the least density: ½χ²₁ exceeds these once in a hundred sessions and once in
/// a thousand.
const PROBABLE: f32 = 5.41;
const CERTAIN: f32 = 9.55;

/// Of one density.
#[derive(Clone, Copy, Debug)]
struct Hypothesis<const N: usize> {
    mean: [f32; N],
    variance: f32,
    cost: f32,
}

/// Sums over a pass, of N components that are equally well seen.
#[derive(Clone, Copy, Debug)]
pub struct Wander<const N: usize> {
    grid: [Hypothesis<N>; GRID],
    least: f32,
    /// When it was last seen, s; none if what is seen next has nothing to be compared with.
    last_s: Option<f32>,
    /// `Σ Δt/2r` and number of comparisons.
    information: f32,
    count: f32,
}

/// What it comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Mean of the posterior: a bias that does not wander is as likely as one that does before.
    pub density: f32,
    /// Twice the logarithm of the likelihood's ratio.
    ratio: f32,
    /// The logarithm of the best likelihood, but for a constant that counts what was seen.
    pub log_likelihood: f32,
}

impl Found {
    /// Once in a hundred sessions without a walk.
    pub fn probable(&self) -> bool {
        self.ratio > PROBABLE
    }

    /// Once in a thousand.
    pub fn certain(&self) -> bool {
        self.ratio > CERTAIN
    }
}

impl<const N: usize> Wander<N> {
    /// `least` is the least density, unit²/s.
    pub fn new(least: f32) -> Self {
        let grid = [Hypothesis { mean: [0.0; N], variance: 0.0, cost: 0.0 }; GRID];
        Self { grid, least, last_s: None, information: 0.0, count: 0.0 }
    }

    /// What is seen next is off by a constant of its own.
    pub fn restart(&mut self) {
        self.last_s = None;
    }

    /// A rest's mean about the time `t_s`, of this variance.
    pub fn take(&mut self, value: &[f32; N], variance: f32, t_s: f32) {
        let since = self.last_s.replace(t_s).map(|last| t_s - last);
        for (hypothesis, density) in self.grid.iter_mut().zip(densities(self.least)) {
            match since {
                Some(since) => hypothesis.take(value, variance, density * since),
                None => (hypothesis.mean, hypothesis.variance) = (*value, variance),
            }
        }
        if let Some(since) = since {
            self.information += 0.5 * since / variance;
            self.count += 1.0;
        }
    }

    /// None where nothing was seen twice.
    pub fn found(&self) -> Option<Found> {
        let logs = self.grid.map(|hypothesis| -0.5 * hypothesis.cost);
        let best = logs.iter().fold(f32::NEG_INFINITY, |best, log| best.max(*log));
        (self.count > 0.5).then(|| Found {
            density: mean_variance(densities(self.least), self.count / self.information, 1.0, |index, _| logs[index]),
            ratio: 2.0 * (best - logs[0]),
            log_likelihood: best,
        })
    }
}

impl<const N: usize> Hypothesis<N> {
    fn take(&mut self, value: &[f32; N], variance: f32, grown: f32) {
        let own = self.variance + grown;
        let seen = own + variance;
        for (mean, value) in self.mean.iter_mut().zip(value) {
            let left = value - *mean;
            self.cost += libm::logf(seen) + left * left / seen;
            *mean += own / seen * left;
        }
        self.variance = own * variance / seen;
    }
}

fn densities(least: f32) -> impl Iterator<Item = f32> + Clone {
    (0..GRID).map(move |step| least * libm::exp2f(step as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform of unit variance.
    fn draws(seed: u32) -> impl FnMut() -> f32 {
        let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(1);
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) as f32 / 8_388_608.0 - 1.0) * 1.732
        }
    }

    /// Eighteen rests 11 s apart, of unit variance, of a bias that wanders by this density.
    fn seen(density: f32, seed: u32) -> Found {
        let mut draw = draws(seed);
        let (mut wander, mut bias) = (Wander::<3>::new(1e-5), [0.0f32; 3]);
        for rest in 0..18 {
            bias.iter_mut().for_each(|bias| *bias += libm::sqrtf(density * 11.0) * draw());
            wander.take(&bias.map(|bias| bias + draw()), 1.0, 11.0 * rest as f32);
        }
        wander.found().expect("rests")
    }

    #[test]
    fn a_walk_is_found_and_noise_is_not() {
        let count = |density: f32| (0..1000).filter(|seed| seen(density, *seed).certain()).count();
        // Uniform draws have short tails: fewer than the one in a thousand.
        assert!(count(0.0) <= 2, "{} of nothing", count(0.0));
        assert!(count(0.3) > 990, "{} of a walk", count(0.3));
        let mean = (0..1000).map(|seed| seen(0.3, seed).density).sum::<f32>() / 1000.0;
        assert!((0.8..1.4).contains(&(mean / 0.3)), "{mean}");
        assert!(Wander::<1>::new(1e-5).found().is_none());
    }

    /// As the accelerometer is seen: three rests a visit, two comparisons, twelve in all. Measured: 0.6 % and 0.04 %.
    #[test]
    fn noise_is_called_a_walk_no_oftener_than_it_says() {
        let mut draw = draws(1);
        let (mut probable, mut certain) = (0, 0);
        for _ in 0..20_000 {
            let mut wander = Wander::<1>::new(1e-6);
            for rest in 0..18 {
                if rest % 3 == 0 {
                    wander.restart();
                }
                let normal = (0..4).map(|_| 0.5 * draw()).sum::<f32>();
                wander.take(&[normal], 1.0, 14.0 * rest as f32);
            }
            let found = wander.found().expect("rests");
            probable += u32::from(found.probable());
            certain += u32::from(found.certain());
        }
        assert!((20..200).contains(&probable) && certain < 20, "{probable} and {certain} of 20000");
    }

    #[test]
    fn a_step_between_visits_is_no_walk() {
        let mut wander = Wander::<1>::new(1e-5);
        for visit in 0..6 {
            wander.restart();
            for rest in 0..3 {
                wander.take(&[100.0 * visit as f32], 1.0, (40 * visit + 10 * rest) as f32);
            }
        }
        assert!(!wander.found().expect("rests").probable());
    }
}
