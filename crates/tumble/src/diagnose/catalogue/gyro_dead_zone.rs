//! Small rates read as zero: `ω_raw = sign(ω) max(|ω| − d, 0)`, so larger ones lose d: `−clamp(ω, −d, d)`.
//!
//! On the axis of a turn that is nearly a change of scale, so that d comes from the axes which hardly turn, whose rates are
//! of its own size and tremble. What is lost there is the mean of the clamp over what the rate may be. Over a turn or move, rates
//! are taken for normal about their mean with variance τ²; the mean m over a sixth of a second, with noise n of σ_n, then leaves
//! `x̂ = m̄ + τ²/(τ² + σ_n²) (m − m̄)`, uncertain by what it trembles about m and by `τ σ_n / √(τ² + σ_n²)`. An axis that
//! reads its own noise and nothing else loses nothing.
//!
//! x̂ holds noise, of which the residual is made too, so that a zone seems to take noise away: `−σ_n² E[g′]` (Stein), a negative
//! zone of at most 0.4 σ_n (0.007 °/s by the sheet) where τ is σ_n, and none where it is less. A zone cannot be negative.

use std::sync::Arc;

use nalgebra::Vector3;

use super::{AXES, Card, DPS, Effect, Model, Variant, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::influence::Push;
use crate::diagnose::twin::trajectory::Moment;

/// Of a zone whose size is not known yet, deg/s: narrow, so that its edge is all that shows.
const NARROW: f64 = 1e-3;
/// Of [`Moment::mean_rate`], s.
const WINDOW_S: f64 = 1.0 / 6.0;

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
    let motions = Arc::new(motions(twin));
    // The zone may lie about the sensor's own zero, or, where a driver takes the bias off first, about rest.
    Model::Shift(vec![variant(1.0, &motions), variant(0.0, &motions)])
}

/// What the rates of a turn or move may have been.
#[derive(Clone, Copy, Default)]
struct Motion {
    first: usize,
    mean: Vector3<f64>,
    /// `τ²/(τ² + σ_n²)`.
    believed: Vector3<f64>,
}

/// x̂, how uncertain it is, and the bias: rad/s.
#[derive(Clone, Copy)]
struct Rate {
    likely: Vector3<f64>,
    sigma: Vector3<f64>,
    zero: Vector3<f64>,
}

impl Motion {
    fn of(moments: &[&Moment], noise: &Vector3<f64>) -> Self {
        let count = moments.len().max(1) as f64;
        let mean = moments.iter().map(|moment| moment.mean_rate).sum::<Vector3<f64>>() / count;
        let about = |moment: &&Moment| (moment.mean_rate - mean).map(|v| v * v);
        let scatter = moments.iter().map(about).sum::<Vector3<f64>>() / count;
        let length_s = moments.last().map_or(0.0, |last| last.t_s) - moments.first().map_or(0.0, |first| first.t_s);
        let believed = scatter.zip_map(noise, |all, noise| believed(all, noise, length_s));
        Self { first: moments.first().map_or(0, |moment| moment.index), mean, believed }
    }

    fn rate(&self, moment: &Moment, noise: &Vector3<f64>) -> Rate {
        let likely = self.mean + self.believed.component_mul(&(moment.mean_rate - self.mean));
        // Of the tremor's variance, σ_n² is the mean's own.
        let sigma = Vector3::from_fn(|i, _| {
            let trembles = (moment.tremor[i].powi(2) - noise[i]).max(0.0);
            (trembles + self.believed[i] * noise[i]).sqrt()
        });
        Rate { likely, sigma, zero: moment.zero }
    }
}

/// `τ²/(τ² + σ_n²)` from the sum's mean square over so many seconds. Noise alone is not taken for a motion: four sigma of a
/// variance from that many windows are asked for.
fn believed(all: f64, noise: f64, length_s: f64) -> f64 {
    let chance = 1.0 + 4.0 * (2.0 / (length_s / WINDOW_S).max(1.0)).sqrt();
    if all > chance * noise { 1.0 - noise / all } else { 0.0 }
}

/// By stretch; rests have none.
fn motions(twin: &Twin) -> Vec<(Motion, Vec<Rate>)> {
    let noise = &twin.trajectory.mean_rate_variance;
    let mut by_stretch: Vec<Vec<&Moment>> = Vec::new();
    for moment in twin.trajectory.moments.iter().filter(|moment| !matches!(moment.deed, Deed::Rest { .. })) {
        by_stretch.resize(by_stretch.len().max(moment.stretch + 1), Vec::new());
        by_stretch[moment.stretch].push(moment);
    }
    let motion = |moments: Vec<&Moment>| {
        let motion = Motion::of(&moments, noise);
        (motion, moments.iter().map(|moment| motion.rate(moment, noise)).collect())
    };
    by_stretch.into_iter().map(motion).collect()
}

fn variant(about: f64, motions: &Arc<Vec<(Motion, Vec<Rate>)>>) -> Variant {
    let motions = motions.clone();
    let at_size = move |axis: usize, half_width_dps: f64| {
        let half_width = half_width_dps.abs().max(NARROW) * DPS;
        let motions = motions.clone();
        reading(move |moment: &Moment| {
            let moving = motions
                .get(moment.stretch)
                .and_then(|(motion, rates)| rates.get(moment.index.checked_sub(motion.first)?));
            let lost = match moving {
                Some(rate) => clamped(about * rate.zero[axis] + rate.likely[axis], rate.sigma[axis], half_width),
                None => (about * moment.zero[axis]).clamp(-half_width, half_width),
            };
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

/// Mean of `clamp(x, −d, d)` for x normal with this mean and sigma:
/// `m (Φ(b) − Φ(a)) + s (φ(a) − φ(b)) + d (1 − Φ(b) − Φ(a))` with `a = (−d − m)/s`, `b = (d − m)/s`.
fn clamped(mean: f64, sigma: f64, half_width: f64) -> f64 {
    // At rest on something solid the rate is known: it is the zone's own middle, or the bias.
    if sigma <= 0.0 || mean.abs() > half_width + 8.0 * sigma {
        return mean.clamp(-half_width, half_width);
    }
    let below = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
    let density = |z: f64| (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    let (a, b) = ((-half_width - mean) / sigma, (half_width - mean) / sigma);
    mean * (below(b) - below(a)) + sigma * (density(a) - density(b)) + half_width * (1.0 - below(b) - below(a))
}

#[cfg(test)]
mod tests {
    use super::{believed, clamped};

    /// An axis that reads its own noise in a turn loses nothing: at −1 to +3 sigma of its mean square over 60 windows.
    #[test]
    fn noise_alone_is_no_motion() {
        for sigmas in [-1.0, 0.0, 3.0] {
            assert_eq!(believed(1.0 + sigmas * (2.0f64 / 60.0).sqrt(), 1.0, 10.0), 0.0);
        }
        assert!((believed(10.0, 1.0, 10.0) - 0.9).abs() < 1e-12);
        assert_eq!(believed(0.0, 0.0, 0.0), 0.0);
    }

    /// Against the trapezoid over eight sigmas to either side.
    #[test]
    fn the_mean_of_a_clamp() {
        for (mean, sigma, half_width) in [(0.3, 0.2, 0.1), (-0.05, 0.3, 0.2), (0.0, 1.0, 0.5), (2.0, 0.1, 0.4)] {
            let steps = 40_000;
            let sum: f64 = (0..=steps)
                .map(|k| {
                    let z = -8.0 + 16.0 * f64::from(k) / f64::from(steps);
                    let x: f64 = mean + sigma * z;
                    x.clamp(-half_width, half_width) * (-0.5 * z * z).exp()
                })
                .sum();
            let expected = sum * 16.0 / f64::from(steps) / std::f64::consts::TAU.sqrt();
            assert!((clamped(mean, sigma, half_width) - expected).abs() < 1e-6, "{mean} {sigma} {half_width}");
        }
    }
}
