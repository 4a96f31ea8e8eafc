//! Gravity alone, after Tedaldi, Pretto & Menegatti 2014 ("A robust and easy to implement method for IMU calibration
//! without external equipments", the method of `imu_tk`), in our own code.
//!
//! 1. Accelerometer, nine numbers: `|A (f − a)| = g` over all rests, A lower-triangular.
//! 2. Gyroscope, nine numbers, its bias being the mean rate over rests: the upward direction of one rest, carried by the
//!    gyroscope through the move, is that of the next.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};
use tumble_core::estimate::{Conditions, Noise};

use super::data::Stretch;
use super::solve::{Block, minimise};
use super::{ACCEL_BIAS_SIGMA, CORRECTION_SIGMA};

/// `A` by rows, its six elements, then `a`.
const LOWER: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

/// A triad with its covariance: bias 3, correction 9 by rows.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// SI.
    pub bias: Vector3<f64>,
    /// 1.
    pub correction: Matrix3<f64>,
    /// Of the bias.
    pub bias_sigma: Vector3<f64>,
    /// Of the correction; zero where the frame fixes it.
    pub correction_sigma: Matrix3<f64>,
    /// Of all twelve, bias first.
    pub covariance: SMatrix<f64, 12, 12>,
}

impl Fitted {
    /// `covariance` of twelve numbers, the bias first.
    pub fn new(bias: Vector3<f64>, correction: Matrix3<f64>, covariance: SMatrix<f64, 12, 12>) -> Self {
        let sigma = |index: usize| covariance[(index, index)].max(0.0).sqrt();
        Self {
            bias,
            correction,
            bias_sigma: Vector3::from_fn(|i, _| sigma(i)),
            correction_sigma: Matrix3::from_fn(|i, j| sigma(3 + 3 * i + j)),
            covariance,
        }
    }
}

/// Both triads in the accelerometer's frame; none without rests or with a singular fit.
pub fn estimate(stretches: &[Stretch], conditions: &Conditions, noise: &Noise) -> Option<(Fitted, Fitted)> {
    let accel = accelerometer(stretches, conditions, noise)?;
    let gyro = gyroscope(stretches, &accel, noise)?;
    Some((accel, gyro))
}

fn accelerometer(stretches: &[Stretch], conditions: &Conditions, noise: &Noise) -> Option<Fitted> {
    let gravity = f64::from(conditions.gravity_mps2);
    let mut blocks: Vec<Block> = Vec::new();
    for rest in stretches.iter().filter(|stretch| stretch.is_rest()) {
        let sigma = (f64::from(noise.force_density) / rest.duration_s).sqrt();
        let force = rest.mean_force;
        blocks.push(Block::new(0..9, move |x| {
            let (correction, bias) = lower(x);
            vec![((correction * (force - bias)).norm() - gravity) / sigma]
        }));
    }
    let start: Vec<f64> = LOWER.iter().map(|&(i, j)| f64::from(u8::from(i == j))).chain([0.0; 3]).collect();
    let sigma = |unknown: usize| if unknown < 6 { CORRECTION_SIGMA } else { ACCEL_BIAS_SIGMA };
    // Priors keep the solver in bounds where the rests do not.
    blocks.extend((0..9).map(|unknown| Block::prior(unknown, start[unknown], sigma(unknown))));
    let solution = minimise(&blocks, start, &[1e-6; 9]);
    let found = solution.covariance.as_ref()?;
    let (correction, bias) = lower(&solution.x);
    // Where each unknown stands among the twelve.
    let place = |unknown: usize| LOWER.get(unknown).map_or_else(|| unknown - 6, |&(i, j)| 3 + 3 * i + j);
    let mut covariance = SMatrix::zeros();
    (0..9).flat_map(|i| (0..9).map(move |j| (i, j))).for_each(|at| covariance[(place(at.0), place(at.1))] = found[at]);
    Some(Fitted::new(bias, correction, covariance))
}

fn lower(x: &[f64]) -> (Matrix3<f64>, Vector3<f64>) {
    let mut correction = Matrix3::zeros();
    LOWER.iter().zip(x).for_each(|(&at, value)| correction[at] = *value);
    (correction, Vector3::from_column_slice(&x[6..9]))
}

fn gyroscope(stretches: &[Stretch], accel: &Fitted, noise: &Noise) -> Option<Fitted> {
    let rests = || stretches.iter().filter(|stretch| stretch.is_rest());
    let time_s: f64 = rests().map(|rest| rest.duration_s).sum();
    let bias = rests().map(|rest| rest.mean_rate * rest.duration_s).sum::<Vector3<f64>>() / time_s;
    let mut blocks: Vec<Block> = Vec::new();
    for (k, from) in stretches.iter().enumerate().filter(|(_, stretch)| stretch.is_rest()) {
        let moves = stretches[k + 1..].iter().take_while(|stretch| !stretch.is_rest());
        let moves: Vec<&Stretch> = moves.collect();
        let Some(to) = stretches.get(k + 1 + moves.len()) else { break };
        if !moves.is_empty() && !moves.iter().any(|stretch| stretch.is_broken()) {
            blocks.push(hinge(from, moves, to, accel, bias, noise));
        }
    }
    let start: Vec<f64> = Matrix3::<f64>::identity().transpose().iter().copied().collect();
    blocks.extend((0..9).map(|unknown| Block::prior(unknown, start[unknown], CORRECTION_SIGMA)));
    let solution = minimise(&blocks, start, &[1e-6; 9]);
    let found = solution.covariance.as_ref()?;
    let own = f64::from(noise.rate_density) / time_s;
    // The bias is taken for known in the fit, so that nothing is said of how the two go together.
    let covariance = SMatrix::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => own * f64::from(u8::from(i == j)),
        (false, false) => found[(i - 3, j - 3)],
        _ => 0.0,
    });
    Some(Fitted::new(bias, Matrix3::from_row_slice(&solution.x), covariance))
}

/// `ΔRᵀ u₀ − u₁`, whitened by the gyroscope's noise over the move and the accelerometer's over both rests.
fn hinge<'a>(
    from: &Stretch,
    moves: Vec<&'a Stretch>,
    to: &Stretch,
    accel: &Fitted,
    bias: Vector3<f64>,
    noise: &Noise,
) -> Block<'a> {
    let up = |rest: &Stretch| (accel.correction * (rest.mean_force - accel.bias)).normalize();
    let (before, after) = (up(from), up(to));
    let level = f64::from(noise.force_density) / tumble_sim::STANDARD_GRAVITY_MPS2.powi(2);
    let rotation =
        |stretch: &&Stretch| f64::from(noise.rate_density * noise.moving(&stretch.segment)) * stretch.duration_s;
    let rotation: f64 = moves.iter().map(rotation).sum();
    let sigma = (rotation + level * (1.0 / from.duration_s + 1.0 / to.duration_s)).sqrt();
    Block::new(0..9, move |x| {
        let correction = Matrix3::from_row_slice(x);
        let mut rotation = UnitQuaternion::identity();
        for interval in moves.iter().flat_map(|stretch| &stretch.intervals) {
            rotation *= interval.turned(&correction, &bias);
        }
        ((rotation.inverse_transform_vector(&before) - after) / sigma).iter().copied().collect()
    })
}
