//! How much noisier than at rest the specific force is in a turn, at the time scale that an estimate hangs on.
//!
//! A hand's tremor is an acceleration whose integral stays bounded: with v its velocity at the borders of groups of length T, a group's
//! mean is off by `(v′ − v)/T`. That has the variance `2 s`, `s = ⟨v²⟩/T²`, and with its neighbour the covariance `−s`, so that over many
//! groups nothing is left but both ends. 10 µm at 8 to 12 Hz (4 mg) make a quarter of the sheet's variance in half a second.
//!
//! A filter that follows attitude with the gain κ has from such readings an attitude of variance `2 κ² s/(2 − κ)`, and `κ r/(2 − κ)` from an
//! even noise of variance r: the tremor counts as `r = 2 κ s`, all of it where every reading is believed, a quarter at the sheet's noise
//! (κ = 0.25). Its innovations, `(1 − z)/(1 − (1−κ) z)` of the readings' noise, have from both
//!
//! `⟨ν²⟩ = 2 r/(2−κ) + s (2 + 4κ/(2−κ))`, `⟨ν ν₋⟩ = −κ r/(2−κ) − s (1 + κ + 2κ²/(2−κ))`,  `⟨ν²⟩ + ⟨ν ν₋⟩ = r + (1 + κ) s`,
//!
//! so that their sum counts all of what is even and no less of the tremor than is due. `⟨ν²⟩ + 2/(1+κ) ⟨ν ν₋⟩` is proportional to `r + 2 κ s`
//! itself, but it depends on κ and κ on it: with sensors twenty times as quiet as the sheet's the two swing against each other.

use super::filter::Innovation;

/// What one turn's innovations say.
#[derive(Clone, Copy, Debug, Default)]
pub struct TurnNoise {
    squares: f32,
    neighbours: f32,
    denominator: f32,
    last: Option<[Innovation; 3]>,
}

impl TurnNoise {
    /// A group's, each with r of its variance S from the specific force's noise. They should have variance `S + r q` for an unknown q: method
    /// of moments with maximum likelihood's weights, `q = Σ r (ν² − S + ν ν₋)/S² ÷ Σ r²/S²`.
    pub fn take(&mut self, innovations: &[Innovation; 3], variance: f32) {
        for (axis, now) in innovations.iter().enumerate() {
            let share = variance / now.variance;
            let neighbours = self.last.map_or(0.0, |last| last[axis].value * now.value / last[axis].variance);
            self.squares += share * (now.nis() - 1.0);
            self.neighbours += share * neighbours;
            self.denominator += share * share;
        }
        self.last = Some(*innovations);
    }

    /// q, and its variance: ν² has 2 S², ν ν₋ has S². Neighbours only ever take back: where they are alike it is no tremor but a misfit,
    /// which is not of the specific force alone. None without data.
    pub fn value(&self) -> Option<(f32, f32)> {
        let sum = self.squares + self.neighbours.min(0.0);
        (self.denominator > 0.0).then(|| (sum / self.denominator, 3.0 / self.denominator))
    }
}

/// The turns' factors, each with its relative variance. Turns that agree have one factor, known twelve times as well; those that do not are drawn
/// to the mean by what they are known worse than they differ (DerSimonian & Laird 1986). Not in logarithms: a turn knows its factor to
/// 0.3, where a logarithm is far from straight. And a weight must not follow from the value that it weighs: all turns' variances are taken about
/// their common factor. (Each about its own, two turns on the spot beside twelve that slid, factors 1 and 200, made a mean of 1 known so well that the
/// twelve were drawn to 10, and K was off by 16 sigma.)
#[derive(Clone, Copy, Debug, Default)]
pub struct Pool {
    weight: f32,
    weights_squared: f32,
    sum: f32,
    squares: f32,
    count: f32,
}

impl Pool {
    /// A turn's; the variance is that of its logarithm.
    pub fn take(&mut self, value: f32, variance: f32) {
        let weight = 1.0 / variance;
        self.weight += weight;
        self.weights_squared += weight * weight;
        self.sum += weight * value;
        self.squares += weight * value * value;
        self.count += 1.0;
    }

    /// Mean over turns, and the variance by which they differ over the mean's square; none of a single turn.
    pub fn prior(&self) -> Option<(f32, f32)> {
        (self.count > 1.5).then(|| {
            let mean = (self.sum / self.weight).max(1.0);
            let excess = (self.squares - self.sum * self.sum / self.weight) / (mean * mean) - (self.count - 1.0);
            (mean, (excess / (self.weight - self.weights_squared / self.weight)).max(0.0))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform of unit variance, without end.
    fn draws() -> impl FnMut() -> f32 {
        let mut state = 1u32;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) as f32 / 8_388_608.0 - 1.0) * 1.732
        }
    }

    /// What ν² with its neighbours' share comes to above S, in a filter with this gain that takes readings for noise of variance 1 and gets
    /// that and a tremor of this velocity (in units of a group's length).
    fn excess(gain: f32, tremor: f32) -> f32 {
        let mut draw = draws();
        let (mut noise, mut lag, mut before) = (TurnNoise::default(), 0.0f32, 0.0f32);
        // In a steady state S = r/(1 − κ), and attitude wanders by κ²S a group.
        let variance = 1.0 / (1.0 - gain);
        for _ in 0..100_000 {
            let velocity = tremor * draw();
            let value = lag + draw() + velocity - core::mem::replace(&mut before, velocity);
            lag += gain * (libm::sqrtf(variance) * draw() - value);
            noise.take(&[Innovation { value, variance }; 3], 1.0);
        }
        noise.value().expect("groups").0
    }

    #[test]
    fn a_tremor_counts_for_half_of_what_it_is() {
        for gain in [0.1, 0.25, 0.6] {
            let even = excess(gain, 0.0);
            assert!(even.abs() < 0.04, "gain {gain}: {even} of nothing");
            let (found, expected) = (excess(gain, 1.0) - even, 1.0 + gain);
            assert!((found / expected - 1.0).abs() < 0.1, "gain {gain}: {found} of {expected}");
        }
    }
}
