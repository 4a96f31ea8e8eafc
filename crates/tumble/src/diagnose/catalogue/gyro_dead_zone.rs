//! Small rates read as zero: `ω_raw = sign(ω) max(|ω| − d, 0)`, so larger ones lose d: `−clamp(ω, −d, d)`.
//!
//! On the axis of a turn that is nearly a change of scale, so that d comes from the axes which hardly turn, whose rates are
//! of its own size and tremble. The rate is not known: the reading is, and that without noise is `r = sign(ω) max(|ω| − d, 0)`. A
//! small reading has lost all of d, not the part of d that it is itself; to take r for ω made zones too large by 5 %.
//! So the regressor is the mean of the clamp over the rates that may have made the mean reading m of a sixth of a second, with noise
//! σ. Over a turn or move ω is taken for normal, mean μ, variance τ², such that the readings' mean and variance come out. Then
//!
//! `E[clamp | m] = d (P₊ − P₋) + P₀ E[ω | |ω| < d]`, with the shares of rates above, below and inside the zone
//! `P₊ ∝ N(m + d; μ, τ² + σ²) Φ((x₊ − d)/s)`, `P₋ ∝ N(m − d; μ, τ² + σ²) Φ(−(x₋ + d)/s)`, `P₀ ∝ N(m; 0, σ²) P(|ω| < d)`,
//! `x± = m ± d` drawn to μ by `τ²/(τ² + σ²)`, `s = τσ/√(τ² + σ²)`.
//!
//! What trembles within the window by more than the zone (t > d) is all rates at once: `m = x − C(x)`, C the mean of the clamp
//! over a normal with variance t² + s², is solved for x.
//!
//! An axis that reads its own noise and nothing else loses nothing. The reading holds noise, of which the residual is made too,
//! so that a zone seems to take noise away: `−σ² E[g′]` (Stein), a negative zone of at most 0.4 σ (0.007 °/s by the
//! sheet) where τ is σ, and none where it is less. A zone cannot be negative.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::{AXES, Card, DPS, Effect, Model, Variant, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::influence::Push;
use crate::diagnose::twin::trajectory::{Moment, SLOPE_S};

/// Of a zone whose size is not known yet, deg/s: narrow, so that its edge is all that shows.
const NARROW: f64 = 1e-3;
/// Of [`Moment::mean_rate`], s.
const WINDOW_S: f64 = 2.0 * SLOPE_S;
/// A mean rate that never changes counts as one where it stands out by so many sigmas.
const STANDS_OUT: f64 = 6.0;

const CARD: Card = Card {
    id: "gyro_dead_zone",
    name: "the gyroscope reads nothing below a least rate",
    equation: "rate_raw = sign(rate) * max(|rate| - d, 0)",
    typical: "none in a healthy MEMS gyroscope; firmware that zeroes small rates uses 0.05 to 1 deg/s",
    shows: "turns miss by an angle that grows with their duration and has the sign of the turn; rests read exactly zero",
    confounded: &["gyro_scale_asymmetry", "gyro_coarse_quantization"],
    separate_by: "turn at two speeds: what is lost per second stays the same",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    // The zone may lie about the reading's zero, or, where a driver takes the bias off first, about rest; and it may be of the body's
    // rate, before the axes are crooked: one per cent of a turn at 60 deg/s is wider than most zones.
    let element = Arc::new(motions(twin, twin.nominal.gyro.try_inverse().unwrap_or_else(Matrix3::identity)));
    let body = Arc::new(motions(twin, Matrix3::identity()));
    Model::Shift(vec![variant(1.0, &element), variant(0.0, &element), variant(0.0, &body)])
}

/// The readings of a turn or move, by axis; rests have none.
#[derive(Clone, Default)]
struct Motion {
    first: usize,
    readings: Vec<Seen>,
    /// Mean and variance without noise, rad/s.
    mean: Vector3<f64>,
    variance: Vector3<f64>,
    /// Of the readings.
    noise: Vector3<f64>,
    steady: Vector3<f64>,
}

/// Mean over [`WINDOW_S`], what trembles about it, and the bias: rad/s.
#[derive(Clone, Copy)]
struct Seen {
    mean: Vector3<f64>,
    tremor: Vector3<f64>,
    zero: Vector3<f64>,
}

impl Motion {
    /// `axes` takes the body's rates to those on which the zone acts.
    fn of(moments: &[&Moment], axes: &Matrix3<f64>, noise: &Vector3<f64>) -> Self {
        let count = moments.len().max(1) as f64;
        let mean = moments.iter().map(|moment| axes * moment.mean_rate).sum::<Vector3<f64>>() / count;
        let about = |moment: &&Moment| (axes * moment.mean_rate - mean).map(|v| v * v);
        let scatter = moments.iter().map(about).sum::<Vector3<f64>>() / count;
        let length_s = moments.last().map_or(0.0, |last| last.t_s) - moments.first().map_or(0.0, |first| first.t_s);
        let windows = (length_s / WINDOW_S).max(1.0);
        let seen = |moment: &&Moment| Seen {
            mean: axes * moment.mean_rate,
            tremor: moment.tremor.zip_map(noise, |tremor, noise| (tremor * tremor - noise).max(0.0).sqrt()),
            zero: moment.zero,
        };
        Self {
            first: moments.first().map_or(0, |moment| moment.index),
            readings: moments.iter().map(seen).collect(),
            mean,
            variance: scatter.zip_map(noise, |all, noise| all * believed(all, noise, windows)),
            noise: noise.map(f64::sqrt),
            steady: noise.map(|noise| (noise / windows).sqrt()),
        }
    }

    /// What each of its readings has lost on an axis to a zone of this half width about `about` times the bias.
    fn lost(&self, axis: usize, about: f64, half_width: f64) -> Vec<f64> {
        let zero = self.readings.first().map_or(0.0, |seen| about * seen.zero[axis]);
        let (mean, variance) = (zero + self.mean[axis], self.variance[axis]);
        if variance <= 0.0 {
            let stands_out = mean.abs() > STANDS_OUT * self.steady[axis];
            let lost = if stands_out { half_width.copysign(mean) } else { 0.0 };
            return vec![lost; self.readings.len()];
        }
        let rate = before(mean, variance, half_width);
        let lost = |seen: &Seen| {
            rate.lost(about * seen.zero[axis] + seen.mean[axis], self.noise[axis], seen.tremor[axis], half_width)
        };
        self.readings.iter().map(lost).collect()
    }
}

/// `τ²/(τ² + σ²)` from the sum's mean square over so many windows. Noise alone is not taken for a motion: four sigma of a
/// variance from that many windows are asked for.
fn believed(all: f64, noise: f64, windows: f64) -> f64 {
    let chance = 1.0 + 4.0 * (2.0 / windows).sqrt();
    if all > chance * noise { 1.0 - noise / all } else { 0.0 }
}

/// By stretch; rests have none.
fn motions(twin: &Twin, axes: Matrix3<f64>) -> Vec<Motion> {
    let noise = &twin.trajectory.mean_rate_variance;
    let mut by_stretch: Vec<Vec<&Moment>> = Vec::new();
    for moment in twin.trajectory.moments.iter().filter(|moment| !matches!(moment.deed, Deed::Rest { .. })) {
        by_stretch.resize(by_stretch.len().max(moment.stretch + 1), Vec::new());
        by_stretch[moment.stretch].push(moment);
    }
    by_stretch.into_iter().map(|moments| Motion::of(&moments, &axes, noise)).collect()
}

fn variant(about: f64, motions: &Arc<Vec<Motion>>) -> Variant {
    let motions = motions.clone();
    let at_size = move |axis: usize, half_width_dps: f64| {
        let half_width = half_width_dps.abs().max(NARROW) * DPS;
        let lost: Vec<Vec<f64>> = motions.iter().map(|motion| motion.lost(axis, about, half_width)).collect();
        let motions = motions.clone();
        reading(move |moment: &Moment| {
            let moving = motions
                .get(moment.stretch)
                .and_then(|motion| lost[moment.stretch].get(moment.index.checked_sub(motion.first)?));
            let lost = moving.copied().unwrap_or((about * moment.zero[axis]).clamp(-half_width, half_width));
            Push::rate(Vector3::ith(axis, -DPS * lost / half_width))
        })
    };
    let variant = Variant {
        setting: None,
        parameters: AXES.iter().map(|axis| parameter(*axis, "dps", 0.2)).collect(),
        influences: (0..3).map(|axis| at_size(axis, NARROW)).collect(),
        own: None,
        at_size: Some(Arc::new(at_size)),
    };
    variant.positive()
}

/// A rate taken for normal.
#[derive(Clone, Copy)]
struct Normal {
    mean: f64,
    variance: f64,
}

/// The rate whose readings have this mean and variance: by steps that put both right to first order.
fn before(mean: f64, variance: f64, half_width: f64) -> Normal {
    const STEPS: usize = 12;
    let mut rate = Normal { mean, variance };
    for _ in 0..STEPS {
        let read = rate.read(half_width);
        rate.mean += mean - read.mean;
        rate.variance *= (variance / read.variance.max(1e-3 * variance)).clamp(0.25, 4.0);
    }
    rate
}

impl Normal {
    /// Mean and variance of `sign(ω) max(|ω| − d, 0)`.
    fn read(self, half_width: f64) -> Self {
        let sigma = self.variance.sqrt();
        // E[max(X, 0)] and E[max(X, 0)²] of a normal X.
        let above = |mean: f64| {
            let (below, density) = (below(mean / sigma), density(mean / sigma));
            (mean * below + sigma * density, (mean * mean + self.variance) * below + mean * sigma * density)
        };
        let (up, down) = (above(self.mean - half_width), above(-self.mean - half_width));
        let mean = up.0 - down.0;
        Self { mean, variance: (up.1 + down.1 - mean * mean).max(0.0) }
    }

    /// `E[clamp | m]`.
    fn lost(self, m: f64, noise: f64, tremor: f64, half_width: f64) -> f64 {
        if m.abs() > 8.0 * (noise + tremor) + half_width {
            return half_width.copysign(m);
        }
        if tremor > half_width {
            let spread = (tremor * tremor + noise * noise).sqrt();
            // The step shrinks by at least P(|ω| < d) < 0.68 a time: to 2 %.
            return (0..10).fold(0.0, |lost, _| clamped(m + lost, spread, half_width));
        }
        let seen = (noise * noise + tremor * tremor).max(f64::MIN_POSITIVE);
        let (all, sigma) = (self.variance + seen, self.variance.sqrt());
        let drawn = |x: f64| self.mean + self.variance / all * (x - self.mean);
        let s = (self.variance * seen / all).sqrt();
        // Logarithms, for all three can be too small for a number.
        let log_normal = |x: f64, variance: f64| -0.5 * (x * x / variance + variance.ln());
        let log = |share: f64| share.max(f64::MIN_POSITIVE).ln();
        let up = log_normal(m + half_width - self.mean, all) + log(below((drawn(m + half_width) - half_width) / s));
        let down = log_normal(m - half_width - self.mean, all) + log(below(-(drawn(m - half_width) + half_width) / s));
        let (a, b) = ((-half_width - self.mean) / sigma, (half_width - self.mean) / sigma);
        let share = below(b) - below(a);
        let inside = log_normal(m, seen) + log(share);
        let most = up.max(down).max(inside);
        let [up, down, inside] = [up, down, inside].map(|log| (log - most).exp());
        let middle = self.mean + sigma * (density(a) - density(b)) / share.max(f64::MIN_POSITIVE);
        (half_width * (up - down) + inside * middle.clamp(-half_width, half_width)) / (up + down + inside)
    }
}

fn below(z: f64) -> f64 {
    0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)
}

fn density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt()
}

/// Mean of `clamp(x, −d, d)` for x normal with this mean and sigma:
/// `m (Φ(b) − Φ(a)) + s (φ(a) − φ(b)) + d (1 − Φ(b) − Φ(a))` with `a = (−d − m)/s`, `b = (d − m)/s`.
fn clamped(mean: f64, sigma: f64, half_width: f64) -> f64 {
    let (a, b) = ((-half_width - mean) / sigma, (half_width - mean) / sigma);
    mean * (below(b) - below(a)) + sigma * (density(a) - density(b)) + half_width * (1.0 - below(b) - below(a))
}

#[cfg(test)]
mod tests {
    use super::{Normal, before, believed, clamped, density};

    /// Trapezoid over eight sigmas to either side.
    fn mean_over(mean: f64, sigma: f64, f: impl Fn(f64) -> f64) -> f64 {
        let steps = 40_000;
        let z = |k: i32| -8.0 + 16.0 * f64::from(k) / f64::from(steps);
        (0..=steps).map(|k| f(mean + sigma * z(k)) * density(z(k))).sum::<f64>() * 16.0 / f64::from(steps)
    }

    fn read(rate: f64, half_width: f64) -> f64 {
        rate - rate.clamp(-half_width, half_width)
    }

    /// An axis that reads its own noise in a turn loses nothing: at −1 to +3 sigma of its mean square over 60 windows.
    #[test]
    fn noise_alone_is_no_motion() {
        for sigmas in [-1.0, 0.0, 3.0] {
            assert_eq!(believed(1.0 + sigmas * (2.0f64 / 60.0).sqrt(), 1.0, 60.0), 0.0);
        }
        assert!((believed(10.0, 1.0, 60.0) - 0.9).abs() < 1e-12);
        assert_eq!(believed(0.0, 0.0, 60.0), 0.0);
    }

    #[test]
    fn the_mean_of_a_clamp() {
        for (mean, sigma, half_width) in [(0.3, 0.2, 0.1), (-0.05, 0.3, 0.2), (0.0, 1.0, 0.5), (2.0, 0.1, 0.4)] {
            let expected = mean_over(mean, sigma, |x| x.clamp(-half_width, half_width));
            assert!((clamped(mean, sigma, half_width) - expected).abs() < 1e-6, "{mean} {sigma} {half_width}");
        }
    }

    /// Against Bayes' rule by the trapezoid: also where a reading is smaller than the zone, of which it has lost all.
    #[test]
    fn what_a_reading_has_lost() {
        let (noise, half_width) = (0.02, 0.05);
        for rate in [Normal { mean: 0.0, variance: 0.01 }, Normal { mean: 0.08, variance: 0.0025 }] {
            for m in [-0.3, -0.04, 0.0, 0.01, 0.045, 0.1] {
                let weight = |x: f64| density((m - read(x, half_width)) / noise);
                let sigma = rate.variance.sqrt();
                let sum = mean_over(rate.mean, sigma, |x| weight(x) * x.clamp(-half_width, half_width));
                let expected = sum / mean_over(rate.mean, sigma, weight);
                let lost = rate.lost(m, noise, 0.0, half_width);
                assert!((lost - expected).abs() < 1e-5, "{m}: {lost} for {expected}");
            }
        }
        let sharp = Normal { mean: 0.0, variance: 0.01 }.lost(0.025, 0.002, 0.0, half_width);
        assert!((sharp / half_width - 1.0).abs() < 1e-6, "half a zone's reading has lost {sharp}");
    }

    #[test]
    fn rates_before_the_zone_come_back_from_readings() {
        for (mean, variance) in [(0.0, 0.01), (0.1, 0.01), (-30.0, 100.0)] {
            let rate = Normal { mean, variance };
            let seen = rate.read(0.05);
            let expected = mean_over(mean, variance.sqrt(), |x| read(x, 0.05));
            assert!((seen.mean - expected).abs() < 1e-6);
            let back = before(seen.mean, seen.variance, 0.05);
            assert!((back.mean - mean).abs() < 2e-3 && (back.variance / variance - 1.0).abs() < 0.02, "{mean}");
        }
    }
}
