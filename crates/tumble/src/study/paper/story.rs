//! Which slip would give what the paper published? Each hypothesis is run or computed, and its errors of K held against
//! the published ones.

use serde::Serialize;

use super::published::{CROSS, MEAN, SCALE, STD};
use super::{Errors, Method, Run};

/// Mean and standard deviation of a method's errors.
#[derive(Clone, Debug, Serialize)]
pub struct Statistics {
    /// Which.
    pub method: &'static str,
    /// Of k11 to k33.
    pub mean: Errors,
    /// Likewise.
    pub std: Errors,
    /// Mean of the largest level errors over 65 s of tumbling, degrees.
    pub level_max_deg: f64,
}

/// A hypothesis beside the published errors of K.
#[derive(Clone, Debug, Serialize)]
pub struct Hypothesis {
    /// In words.
    pub name: &'static str,
    /// k12 k13 k21 k23 k31 k32.
    pub errors: [f64; 6],
    /// Cosine between them and the published ones: 1 is the same pattern, 0 has nothing to do with it.
    pub cosine: f64,
    /// Rms of them over rms of the published.
    pub size: f64,
}

/// The whole comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Story {
    /// Over all runs.
    pub statistics: Vec<Statistics>,
    /// Against the published.
    pub hypotheses: Vec<Hypothesis>,
    /// `Σ δk δa / Σ δa²` of the runs with a leak: what of an accelerometer's cross-axis error the filter forces onto K.
    pub leak_onto_gyro: f64,
    /// Runs among which the leak that looks most like the published one was sought.
    pub runs: usize,
    /// Tilt at which cos β alone gives the size of the published mean scale error, degrees.
    pub cos_beta_tilt_deg: f64,
    /// Rms of the paper's own K, which an uncalibrated gyroscope is left with.
    pub truth_rms: f64,
    /// Rms of the published errors of K.
    pub published_rms: f64,
}

/// Of the paper's own truth: k12 k13 k21 k23 k31 k32.
fn truth() -> [f64; 6] {
    let angles = tumble_sim::sensor::PaperAngles { xy: -0.45, xz: 0.65, yx: -0.45, yz: 0.65, zx: -0.45, zy: 0.65 };
    let matrix = angles.matrix();
    CROSS.map(|k| matrix[(k / 3, k % 3)])
}

/// Looks at all runs.
pub fn story(runs: &[Run]) -> Story {
    let statistics: Vec<_> =
        Method::ALL.into_iter().enumerate().map(|(i, method)| statistics(runs, i, method)).collect();
    let published = CROSS.map(|k| MEAN[k]);
    let mean = |method: Method| -> [f64; 6] {
        let index = Method::ALL.into_iter().position(|m| m == method).unwrap_or(0);
        CROSS.map(|k| statistics[index].mean[k])
    };
    let corrected = mean(Method::Corrected);
    let truth = truth();
    let left = truth.map(|k| -k);
    let negated = std::array::from_fn(|i| -(truth[i] + corrected[i]) - truth[i]);
    // k12 ↔ k21, k13 ↔ k31, k23 ↔ k32.
    let transposed = std::array::from_fn(|i| truth[[2, 4, 0, 5, 1, 3][i]] - truth[i]);
    let leaks = runs.iter().map(|run| CROSS.map(|k| run.outcomes[leak()].errors[k]));
    let distance = |errors: &[f64; 6]| rms(&std::array::from_fn(|i| errors[i] - published[i]));
    let nearest = leaks.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or([0.0; 6]);
    let hypotheses = [
        ("equations as printed (cos β)", mean(Method::Literal)),
        ("equations corrected", corrected),
        ("not calibrated at all", left),
        ("sign slip: K of the other sign", negated),
        ("transposition: k_ij read as k_ji", transposed),
        ("tilt leaks into the accelerometer, nearest run", nearest),
    ];
    let hypothesis = |(name, errors): (&'static str, [f64; 6])| Hypothesis {
        name,
        errors,
        cosine: cosine(&errors, &published),
        size: rms(&errors) / rms(&published),
    };
    let scale = SCALE.iter().map(|&k| MEAN[k]).sum::<f64>() / 3.0;
    Story {
        hypotheses: hypotheses.into_iter().map(hypothesis).collect(),
        leak_onto_gyro: leak_onto_gyro(runs),
        runs: runs.len(),
        cos_beta_tilt_deg: (1.0 + scale).acos().to_degrees(),
        truth_rms: rms(&truth),
        published_rms: rms(&published),
        statistics,
    }
}

fn leak() -> usize {
    Method::ALL.into_iter().position(|method| method == Method::TiltLeak).unwrap_or(0)
}

fn statistics(runs: &[Run], index: usize, method: Method) -> Statistics {
    let count = runs.len().max(1) as f64;
    let mean: Errors =
        std::array::from_fn(|k| runs.iter().map(|run| run.outcomes[index].errors[k]).sum::<f64>() / count);
    let std = std::array::from_fn(|k| {
        let squares: f64 = runs.iter().map(|run| (run.outcomes[index].errors[k] - mean[k]).powi(2)).sum();
        (squares / (count - 1.0).max(1.0)).sqrt()
    });
    let level_max_deg = runs.iter().map(|run| run.outcomes[index].level_max_deg).sum::<f64>() / count;
    Statistics { method: method.name(), mean, std, level_max_deg }
}

fn leak_onto_gyro(runs: &[Run]) -> f64 {
    let pairs = runs.iter().flat_map(|run| {
        let outcome = &run.outcomes[leak()];
        CROSS.map(|k| (outcome.errors[k], outcome.accel_errors[k]))
    });
    let (product, square) = pairs.fold((0.0, 0.0), |(p, s), (gyro, accel)| (p + gyro * accel, s + accel * accel));
    product / square
}

fn rms(values: &[f64; 6]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / 6.0).sqrt()
}

fn cosine(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    product / (6.0 * rms(a) * rms(b)).max(f64::MIN_POSITIVE)
}

/// The published statistics in the same form.
pub fn published() -> Statistics {
    Statistics { method: "published", mean: MEAN, std: STD, level_max_deg: f64::NAN }
}
