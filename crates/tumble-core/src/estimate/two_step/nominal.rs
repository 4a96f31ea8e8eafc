//! What a pass is linear about.

use nalgebra::{Matrix3, SVector, Vector3};

use super::{Pattern, Variant, other};
use crate::estimate::prior::CORRECTION_SIGMA;
use crate::estimate::six_face::{Real, SixFace, real};

/// Width of K's prior about step 1's, in that one's sigmas: it adds a thousandth to what the turns say.
const WIDE: f32 = 30.0;

/// The gyroscope that a pass is linear about.
#[derive(Clone, Debug)]
pub(super) struct Nominal<T: Real> {
    /// The matrix.
    pub correction: Matrix3<T>,
    /// Scales of raw over true, the diagonal of S.
    scale: Vector3<T>,
    /// Its K.
    pub gyro: SVector<T, 6>,
    /// K's prior, of each element, about `prior`.
    pub prior: SVector<T, 6>,
    /// Its sigma.
    pub sigma: SVector<T, 6>,
}

impl<T: Real> Nominal<T> {
    pub fn new(variant: Variant, first: &SixFace<T>) -> Option<Self> {
        let matrix = &first.gyro.matrix;
        let one = T::one();
        let zeros = SVector::zeros();
        let wide = SVector::repeat(real(CORRECTION_SIGMA));
        Some(match variant {
            Variant::Corrected => {
                let scale = matrix.diagonal();
                let of = |at: &dyn Fn(usize, usize) -> T| SVector::from_fn(|k, _| at(k / 2, other(k)));
                let gyro = of(&|i, j| -matrix[(i, j)] / scale[i]);
                let sigma: SVector<T, 6> = of(&|i, j| first.gyro.variance[(i, j)].sqrt() * real(WIDE));
                let sigma = sigma.zip_map(&wide, |sigma, wide| sigma.min(wide));
                Self { correction: matrix.try_inverse()?, scale, gyro, prior: gyro, sigma }
            }
            Variant::Literal => {
                let cos = (one - first.accel.tilt_squared.unwrap_or(T::zero())).max(T::zero()).sqrt();
                let scale = matrix.diagonal() / cos;
                let correction = Matrix3::from_diagonal(&scale.map(T::recip));
                Self { correction, scale, gyro: zeros, prior: zeros, sigma: wide }
            }
            Variant::Traditional => Self {
                correction: Matrix3::identity(),
                scale: Vector3::repeat(one),
                gyro: zeros,
                prior: zeros,
                sigma: wide,
            },
        })
    }

    /// Moved by what a pass found.
    pub fn moved(&self, pattern: Pattern, found: &SVector<T, 6>) -> Option<Self> {
        let gyro = self.gyro + found;
        let correction = match pattern {
            Pattern::NonOrthogonality => {
                let inverse_scale = Matrix3::from_diagonal(&self.scale.map(T::recip));
                (Matrix3::identity() - pattern.correction(&gyro)).lu().solve(&inverse_scale)?
            }
            Pattern::ScaleAndSkew => (Matrix3::identity() + pattern.correction(found)) * self.correction,
        };
        Some(Self { correction, gyro, ..self.clone() })
    }
}
