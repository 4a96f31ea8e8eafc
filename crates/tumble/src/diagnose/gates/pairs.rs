//! Pairs of rests between which gravity changed its direction: what the gyroscope says of it against what the accelerometer
//! says, under any mapping of axes and any factor.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::view::{Rest, View};

/// Gravity must have moved by this, rad (25°): less is also an offset of 80 mg twice and a cross-axis error.
const LEAST_RAD: f64 = 0.44;
/// Directions by an uncalibrated accelerometer, rad: offsets of 60 to 80 mg (sheet) are 3° rms over two rests.
const DIRECTION_RAD: f64 = 0.052;
/// Of the angle that was turned: scale 3 %, cross-axis 2 %, 3 % for a move that was partly clipped or coarsely sampled.
const TURNED: f64 = 0.05;
/// Of a pair: beyond ten sigmas wrong is wrong.
const CAP: f64 = 100.0;
/// Samples are summed to increments of this length, s: hands turn below 12 Hz.
const INCREMENT_S: f64 = 0.02;

/// Two neighbouring rests.
pub struct Pair {
    /// Unit vectors.
    before: Vector3<f64>,
    after: Vector3<f64>,
    /// By the raw rates less the rests', rad.
    increments: Vec<Vector3<f64>>,
    /// Sum of their lengths, rad.
    turned_rad: f64,
}

/// A guess of what the rates must be multiplied by.
#[derive(Clone, Copy, Debug)]
pub struct Guess {
    /// A signed permutation.
    pub mapping: Matrix3<f64>,
    /// Times.
    pub factor: f64,
    /// Sum of capped squares over pairs.
    pub chi2: f64,
    /// −2 ln of the density's height, `4 ln σ` summed over pairs, over that of the factor 1: what foretells nothing is no rival
    /// of what foretells it well.
    pub loose: f64,
}

/// All pairs.
pub fn pairs(view: &View) -> Vec<Pair> {
    view.rests.windows(2).filter_map(|rests| pair(view, &rests[0], &rests[1])).collect()
}

fn pair(view: &View, first: &Rest, second: &Rest) -> Option<Pair> {
    let (before, after) = (first.force.try_normalize(0.05)?, second.force.try_normalize(0.05)?);
    if before.angle(&after) < LEAST_RAD {
        return None;
    }
    let middle = |rest: &Rest| (rest.samples.start + rest.samples.end) / 2;
    let (start, end) = (middle(first), middle(second));
    let bias = (first.rate + second.rate) * 0.5;
    let every = view.count(INCREMENT_S);
    let increment = |from: usize| {
        (from..(from + every).min(end)).fold(Vector3::zeros(), |sum, i| {
            let dt_s = view.t_s[i + 1] - view.t_s[i];
            let rate = (view.rate(i) + view.rate(i + 1)) * 0.5 - bias;
            sum + rate * dt_s.to_radians()
        })
    };
    let increments: Vec<Vector3<f64>> = (start..end).step_by(every).map(increment).collect();
    let turned_rad = increments.iter().map(Vector3::norm).sum();
    Some(Pair { before, after, increments, turned_rad })
}

impl Pair {
    /// Body after to body before by rates times a factor.
    fn rotation(&self, factor: f64) -> Rotation3<f64> {
        let turn = |attitude, by: &Vector3<f64>| attitude * UnitQuaternion::from_scaled_axis(by * factor);
        self.increments.iter().fold(UnitQuaternion::identity(), turn).to_rotation_matrix()
    }

    fn chi2(&self, rotation: &Matrix3<f64>, factor: f64) -> f64 {
        let predicted = rotation.transpose() * self.before;
        (predicted.angle(&self.after) / self.sigma(factor)).powi(2).min(CAP)
    }

    /// Of the direction that is foretold, rad. Turning by more than a half turn makes errors no larger on the sphere.
    fn sigma(&self, factor: f64) -> f64 {
        let turned = (self.turned_rad * factor.abs()).min(4.0 * std::f64::consts::PI);
        DIRECTION_RAD.hypot(TURNED * turned)
    }
}

/// All 48 mappings under a factor. A proper mapping turns the rotation as a whole (`R(M·δ) = M·R(δ)·Mᵀ`), an improper one
/// its inverse's, so that two integrations serve all.
pub fn guesses(pairs: &[Pair], factor: f64) -> Vec<Guess> {
    let turned: Vec<[Matrix3<f64>; 2]> =
        pairs.iter().map(|pair| [factor, -factor].map(|factor| *pair.rotation(factor).matrix())).collect();
    let loose = pairs.iter().map(|pair| 4.0 * (pair.sigma(factor) / pair.sigma(1.0)).ln()).sum();
    let guess = |mapping: Matrix3<f64>| {
        let proper = mapping.determinant() > 0.0;
        let (m, which) = if proper { (mapping, 0) } else { (-mapping, 1) };
        let chi2 =
            pairs.iter().zip(&turned).map(|(pair, turned)| pair.chi2(&(m * turned[which] * m.transpose()), factor));
        Guess { mapping, factor, chi2: chi2.sum(), loose }
    };
    mappings().into_iter().map(guess).collect()
}

/// The signed permutations, the identity first.
fn mappings() -> Vec<Matrix3<f64>> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [2, 1, 0], [0, 2, 1], [1, 2, 0], [2, 0, 1]];
    let signed = |order: [usize; 3], signs: usize| {
        let mut matrix = Matrix3::zeros();
        for (row, column) in order.into_iter().enumerate() {
            matrix[(row, column)] = if signs >> row & 1 == 1 { -1.0 } else { 1.0 };
        }
        matrix
    };
    ORDERS.into_iter().flat_map(|order| (0..8).map(move |signs| signed(order, signs))).collect()
}
