//! How noisy the specific force is in each stretch, from what changes faster than any physics that is searched for.

use nalgebra::Vector3;

use super::Twin;
use super::data::{Deed, Stretch};

/// Means of this length are compared, s: as long as a step in a turn.
const MEAN_S: f64 = 0.25;
/// Turns shake; a scale above this is a stretch that tells nothing.
const MOST: f64 = 1e6;

/// Per segment number: variance of its quarter-second means over what quiet rests have, at least 1. Second differences
/// `r₀ − 2 r₁ + r₂` have six times the variance of independent means and leave out constants, trends, and most of what
/// varies once a turn (1 part in 200 of it at 36 °/s).
pub fn force_scales(twin: &Twin) -> Vec<f64> {
    let segments = twin.stretches.iter().map(|stretch| stretch.number + 1).max().unwrap_or(0);
    let mut scales = vec![1.0; segments];
    for stretch in twin.stretches.iter().filter(|stretch| !matches!(stretch.deed, Deed::Move | Deed::Rest { .. })) {
        let means = residual_means(twin, stretch);
        let squares: Vec<f64> =
            means.windows(3).map(|w| (w[0].0 - w[1].0 * 2.0 + w[2].0).norm_squared() / 3.0).collect();
        let duration_s = means.iter().map(|mean| mean.1).sum::<f64>() / means.len().max(1) as f64;
        if squares.len() < 4 {
            continue;
        }
        let variance = squares.iter().sum::<f64>() / squares.len() as f64 / 6.0;
        let expected = twin.noise.force_density / duration_s;
        scales[stretch.number] = (variance / expected).clamp(1.0, MOST);
    }
    scales
}

/// Force less gravity in frame b, in means; with their lengths.
fn residual_means(twin: &Twin, stretch: &Stretch) -> Vec<(Vector3<f64>, f64)> {
    let up = Vector3::z() * twin.gravity_mps2;
    let mut means = Vec::new();
    let mut first = stretch.samples.start;
    for index in stretch.samples.clone() {
        let duration_s = twin.samples[index].t_s - twin.samples[first].t_s;
        if duration_s >= MEAN_S {
            let range = first..index;
            let count = range.len() as f64;
            let sum: Vector3<f64> = range
                .map(|i| {
                    let attitude = twin.trajectory.moments[i].attitude;
                    twin.nominal.force(&twin.samples[i]) - attitude.inverse_transform_vector(&up)
                })
                .sum();
            means.push((sum / count, duration_s));
            first = index;
        }
    }
    means
}
