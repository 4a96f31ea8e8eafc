//! Rotation between two samples of an angular rate.

use nalgebra::{UnitQuaternion, Vector3};

/// Of the interval that ends with sample `last`: how far the rate's mean over it lies off its ends' mean, times its length,
/// `−ω̈ dt³/12`, with ω̈ from the slopes of the intervals to either side (evenly sampled `−dt/24 (ω₋₁ − ω₀ − ω₁ + ω₂)`); zero at an end of the recording, and where
/// an interval beside it is not between half and twice as long: stamps that came in a bunch would make slopes of nothing.
pub fn bend(
    last: usize,
    samples: usize,
    t_s: impl Fn(usize) -> f64,
    rate: impl Fn(usize) -> Vector3<f64>,
) -> Vector3<f64> {
    if last < 2 || last + 1 >= samples {
        return Vector3::zeros();
    }
    let [before_s, dt_s, after_s] = [last - 1, last, last + 1].map(|index| t_s(index) - t_s(index - 1));
    if ![before_s, after_s].iter().all(|span| (0.5 * dt_s..=2.0 * dt_s).contains(span)) || dt_s <= 0.0 {
        return Vector3::zeros();
    }
    let slope = |index: usize, span_s: f64| (rate(index) - rate(index - 1)) / span_s;
    let change = slope(last + 1, after_s) - slope(last - 1, before_s);
    change * (-dt_s * dt_s * dt_s / 12.0 / (0.5 * (before_s + after_s) + dt_s))
}

/// Rotation over `dt_s` from rate `a` to rate `b` with the [`bend`] between, frame b: `(a + b) dt/2 + bend + a × b dt²/12`, the last the coning of a
/// rate that changes linearly.
pub fn rotation(a: &Vector3<f64>, b: &Vector3<f64>, bend: &Vector3<f64>, dt_s: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis((a + b) * (0.5 * dt_s) + bend + a.cross(b) * (dt_s * dt_s / 12.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rate that swings at 8 Hz, read at 100 Hz.
    fn swings(t_s: f64) -> f64 {
        (50.0 * t_s).sin()
    }

    #[test]
    fn the_bend_takes_nine_tenths_of_the_trapezoids_error() {
        let t_s = |index: usize| 0.01 * index as f64;
        let rate = |index: usize| Vector3::new(swings(t_s(index)), 0.0, 0.0);
        let (mut plain, mut bent) = (0.0_f64, 0.0_f64);
        for last in 2..20 {
            let truth = ((50.0 * t_s(last - 1)).cos() - (50.0 * t_s(last)).cos()) / 50.0;
            let trapezoid = 0.5 * 0.01 * (rate(last - 1) + rate(last)).x;
            plain = plain.max((trapezoid - truth).abs());
            bent = bent.max((trapezoid + bend(last, 21, t_s, rate).x - truth).abs());
        }
        assert!(plain > 1.5e-4, "{plain}");
        assert!(bent < 0.25 * plain, "{bent} of {plain}");
    }

    #[test]
    fn beside_a_gap_and_at_the_ends_nothing_is_bent() {
        let rate = |index: usize| Vector3::new((index * index) as f64, 0.0, 0.0);
        let gap = |index: usize| if index > 3 { 1.0 + 0.01 * index as f64 } else { 0.01 * index as f64 };
        assert_eq!(bend(3, 10, gap, rate), Vector3::zeros());
        assert_eq!(bend(1, 10, gap, rate), Vector3::zeros());
        assert_eq!(bend(9, 10, gap, rate), Vector3::zeros());
        assert!(bend(7, 10, gap, rate).x < 0.0);
    }
}
