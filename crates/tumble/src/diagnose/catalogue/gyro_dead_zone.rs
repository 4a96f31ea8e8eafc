//! Small rates read as zero: `ω_raw = sign(ω) max(|ω| − d, 0)`, so larger ones lose d: `−clamp(ω, −d, d)`.
//!
//! On the axis of a turn that is nearly a change of scale, so that d comes from the axes which hardly turn, whose rates are
//! of its own size and tremble. What is lost there is the mean of the clamp over what the rate may be: a normal distribution
//! about the mean over a sixth of a second (the sample's own noise in the regressor would pass for an effect that takes noise
//! away), as wide as the rate trembles about that mean and as the mean is uncertain.

use std::sync::Arc;

use nalgebra::Vector3;

use super::{AXES, Card, DPS, Effect, Model, Variant, parameter, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Push;
use crate::diagnose::twin::trajectory::Moment;

/// Of a zone whose size is not known yet, deg/s: narrow, so that its edge is all that shows.
const NARROW: f64 = 1e-3;

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

fn model(_: &Twin) -> Model {
    // The zone may lie about the sensor's own zero, or, where a driver takes the bias off first, about rest.
    Model::Shift(vec![variant(1.0), variant(0.0)])
}

fn variant(zero: f64) -> Variant {
    let at_size = move |axis: usize, half_width_dps: f64| {
        let half_width = half_width_dps.abs().max(NARROW) * DPS;
        reading(move |moment: &Moment| {
            let mean = zero * moment.zero[axis] + moment.smooth_rate[axis];
            let lost = clamped(mean, moment.tremor[axis], half_width);
            Push::rate(Vector3::ith(axis, -DPS * lost / half_width))
        })
    };
    Variant {
        setting: None,
        parameters: AXES.iter().map(|axis| parameter(*axis, "dps", 0.2)).collect(),
        influences: (0..3).map(|axis| at_size(axis, NARROW)).collect(),
        own: None,
        at_size: Some(Arc::new(at_size)),
    }
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
    use super::clamped;

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
