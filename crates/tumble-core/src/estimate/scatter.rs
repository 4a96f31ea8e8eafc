//! How much a rest's records scatter, and what many rests have in common of it.

use heapless::Vec;

use crate::order::median;
use crate::tape::{Segment, Tape};

/// Densities of one still, from the differences of neighbouring half-second means.
pub struct Scatter {
    /// rad²/s.
    pub rate: f32,
    /// (m/s²)² s.
    pub force: f32,
    /// Differences it stands on, over three axes.
    pub count: f32,
}

/// A difference of two means of independent noise has twice the variance of one, slow drifts cancel.
pub fn scatter<const R: usize, const S: usize>(tape: &Tape<R, S>, segment: &Segment) -> Scatter {
    let mut result = Scatter { rate: 0.0, force: 0.0, count: 0.0 };
    for index in usize::from(segment.first)..usize::from(segment.end).saturating_sub(1) {
        let (Some(a), Some(b)) = (tape.record(index), tape.record(index + 1)) else { continue };
        let harmonic = 1.0 / (1.0 / a.dt_s + 1.0 / b.dt_s);
        let rate = a.rotation_rad / a.dt_s - b.rotation_rad / b.dt_s;
        let force = a.specific_force_mps2 - b.specific_force_mps2;
        result.rate += rate.norm_squared() * harmonic;
        result.force += force.norm_squared() * harmonic;
        result.count += 3.0;
    }
    if result.count > 0.0 {
        result.rate /= result.count;
        result.force /= result.count;
    }
    result
}

/// Mean weighted by counts, without values above four times the median: a disturbed rest does not make all noisy.
pub fn pooled<const S: usize>(values: &mut Vec<(f32, f32), S>) -> Option<f32> {
    values.retain(|value| value.1 > 0.0 && value.0.is_finite());
    let mut sorted: Vec<f32, S> = values.iter().map(|value| value.0).collect();
    let median = median(&mut sorted)?;
    let (mut sum, mut weight) = (0.0, 0.0);
    for &(value, count) in values.iter().filter(|value| value.0 <= 4.0 * median) {
        sum += value * count;
        weight += count;
    }
    (weight > 0.0).then(|| sum / weight)
}
