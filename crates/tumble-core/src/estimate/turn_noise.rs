//! How much noisier than at rest the specific force is in a turn, at the time scale that an estimate hangs on.
//!
//! A hand's tremor is an acceleration whose integral stays bounded: with v its velocity at the borders of groups of length T, a group's
//! mean is off by `(v′ − v)/T`. That has the variance `2 s`, `s = ⟨v²⟩/T²`, and its neighbour the covariance `−s`, so that over many groups
//! nothing is left but both ends. Gyroscope's non-orthogonality shows over a turn, not over half a second; counted as white noise, tremor
//! of 10 µm at 8 to 12 Hz (4 mg) would make a quarter more of the sheet's variance. Hence neighbours' products are counted as well, twice: what
//! is left is the spectrum's level at the low end (a long-run variance; Bartlett 1950), to which an even noise of variance r brings r.
//!
//! A filter that tracks attitude with the gain κ (0.25) turns a tremor into innovations of variance `s (1 + (1+κ)² + κ³/(2−κ))` and neighbours'
//! covariance `−s ((1+κ)(1+κ²) − κ³(1−κ)/(2−κ))`: 2.57 and −1.32, of which a fortieth is left.

use super::filter::Innovation;

/// What one turn's innovations say.
#[derive(Clone, Copy, Debug, Default)]
pub struct TurnNoise {
    numerator: f32,
    denominator: f32,
    last: Option<[Innovation; 3]>,
}

impl TurnNoise {
    /// A group's, each with this much of its variance from the specific force's noise. They should have variance `S + r q` for an unknown
    /// q: method of moments with maximum likelihood's weights, `q = Σ r (ν² − S + 2 ν ν₋)/S² ÷ Σ r²/S²`.
    pub fn take(&mut self, innovations: &[Innovation; 3], variance: f32) {
        for (axis, now) in innovations.iter().enumerate() {
            let share = variance / now.variance;
            let neighbours = self.last.map_or(0.0, |last| last[axis].value * now.value / last[axis].variance);
            self.numerator += share * (now.nis() - 1.0 + 2.0 * neighbours);
            self.denominator += share * share;
        }
        self.last = Some(*innovations);
    }

    /// q, and its variance: ν² has 2 S², 2 ν ν₋ has 4 S². None without data.
    pub fn value(&self) -> Option<(f32, f32)> {
        (self.denominator > 0.0).then(|| (self.numerator / self.denominator, 6.0 / self.denominator))
    }
}

/// The turns' factors, each with its variance. Turns that agree have one factor, known twelve times as well; those that do not are drawn
/// to the mean by what they are known worse than they differ (DerSimonian & Laird 1986). Not in logarithms: a turn knows its factor to
/// 0.4, where a logarithm is far from straight, and a weight must not follow from the value it weighs.
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
