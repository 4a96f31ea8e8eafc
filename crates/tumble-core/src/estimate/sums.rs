//! What a pass's innovations say of the noise.

use super::filter::Innovation;

/// What a pass learns about a segment, carried into the next.
#[derive(Clone, Copy, Debug)]
pub struct SegmentNoise {
    /// Factor on the specific force's noise.
    pub force_scale: f32,
    /// Factor on the gyroscope's noise during this move.
    pub rate_scale: f32,
    /// Level error after this move about the nominal, normalised without `rate_scale`: χ² with 2 degrees of freedom if the
    /// move fits. NaN if there was no rest on both sides.
    pub hinge_nis: f32,
}

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// NIS and count over specific force at rest.
    pub rest: (f32, f32),
    /// First vertical specific forces of rests: the growth of variance since the rest before.
    pub force_walk: Excess,
    /// First rates of rests: likewise.
    pub rate_walk: Excess,
    /// Turns: the noise of the specific force.
    pub turn_noise: Pool,
    /// Turns: the pivot's variance.
    pub pivot: Excess,
    /// Closure residuals, rad² and count.
    pub closed: (f32, f32),
}

/// Quantile of χ²_d/d (Wilson & Hilferty 1931).
fn chi_square_over_dof(freedom: f32, quantile: f32) -> f32 {
    let spread = 2.0 / (9.0 * freedom);
    let root = 1.0 - spread + quantile * libm::sqrtf(spread);
    root * root * root
}

/// What turns say of how much noisier than rest the specific force is while they last: the logarithm of each turn's own factor, with its
/// variance. Turns that agree have one factor, known twelve times as well; those that do not are drawn to the mean by what they are
/// known worse than they differ (DerSimonian & Laird 1986).
#[derive(Clone, Copy, Debug, Default)]
pub struct Pool {
    weight: f32,
    weights_squared: f32,
    sum: f32,
    squares: f32,
    count: f32,
}

impl Pool {
    /// A turn's.
    pub fn take(&mut self, value: f32, variance: f32) {
        let weight = 1.0 / variance;
        self.weight += weight;
        self.weights_squared += weight * weight;
        self.sum += weight * value;
        self.squares += weight * value * value;
        self.count += 1.0;
    }

    /// Mean over turns, and the variance by which they differ; none of a single turn.
    pub fn prior(&self) -> Option<(f32, f32)> {
        (self.count > 1.5).then(|| {
            let mean = self.sum / self.weight;
            let excess = self.squares - self.sum * mean - (self.count - 1.0);
            (mean, (excess / (self.weight - self.weights_squared / self.weight)).max(0.0))
        })
    }
}

/// Innovations that should have variance `S + c q` for an unknown q: the method of moments, weighted as maximum
/// likelihood would, `q = Σ c (ν² − S) / S² ÷ Σ c² / S²`, S being the variance with the q of this pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Excess {
    numerator: f32,
    denominator: f32,
    /// `Σ c / S`: what is expected of the weighted squares.
    expected: f32,
}

impl Excess {
    /// Takes an innovation in.
    pub fn take(&mut self, innovation: &Innovation, coefficient: f32) {
        let weight = coefficient / (innovation.variance * innovation.variance);
        self.numerator += weight * (innovation.value * innovation.value - innovation.variance);
        self.denominator += weight * coefficient;
        self.expected += coefficient / innovation.variance;
    }

    /// Is q certainly larger, at this quantile of the normal distribution? Without an excess the weighted squares over their
    /// expectation are χ²_d/d with `d = (Σ c/S)² / Σ (c/S)²` (Satterthwaite 1946). Where few innovations carry the weight, d is small and
    /// the tail long: four of its sigma, which χ²₁₇ exceeds once in 800 sessions, χ²₂ exceeds once in 150.
    pub fn exceeds(&self, quantile: f32) -> bool {
        let freedom = self.expected * self.expected / self.denominator;
        freedom > 0.0 && 1.0 + self.numerator / self.expected > chi_square_over_dof(freedom, quantile)
    }

    /// What q would have to grow by, and one sigma of that (ν² has variance 2 S²); none without data.
    pub fn value(&self) -> Option<(f32, f32)> {
        (self.denominator > 0.0).then(|| (self.numerator / self.denominator, libm::sqrtf(2.0 / self.denominator)))
    }
}
