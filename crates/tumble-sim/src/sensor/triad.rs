//! Three sensitive axes: the linear error model and its exact inverse.

use crate::error::SimError;
use crate::rng::Rng;
use nalgebra::{Matrix3, Vector3};

/// `raw = distortion · ideal + bias`, in SI and the box frame; `ideal = correction · (raw − bias)` with
/// `correction = distortion⁻¹` is the contract's spelling of the same thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triad {
    /// 3×3, raw over ideal.
    pub distortion: Matrix3<f64>,
    /// rad/s or m/s².
    pub bias: Vector3<f64>,
}

/// The non-orthogonality angles of the paper's equation (1), degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "the paper's own symbols")]
pub struct PaperAngles {
    pub xy: f64,
    pub xz: f64,
    pub yx: f64,
    pub yz: f64,
    pub zx: f64,
    pub zy: f64,
}

impl PaperAngles {
    /// The paper's `A` (sensor from body), row by row:
    /// `[cθxy cθxz, sθxz, −cθxz sθxy; −cθyx sθyz, cθyx cθyz, sθyx; sθzy, −cθzy sθzx, cθzx cθzy]`.
    /// Every row is a unit vector: the direction of a sensitive axis in the body.
    pub fn matrix(&self) -> Matrix3<f64> {
        let trig = |deg: f64| deg.to_radians().sin_cos();
        let ((sxy, cxy), (sxz, cxz)) = (trig(self.xy), trig(self.xz));
        let ((syx, cyx), (syz, cyz)) = (trig(self.yx), trig(self.yz));
        let ((szx, czx), (szy, czy)) = (trig(self.zx), trig(self.zy));
        #[rustfmt::skip]
        let a = Matrix3::new(
            cxy * cxz, sxz, -cxz * sxy,
            -cyx * syz, cyx * cyz, syx,
            szy, -czy * szx, czx * czy,
        );
        a
    }
}

impl Triad {
    /// No errors.
    pub fn ideal() -> Self {
        Self { distortion: Matrix3::identity(), bias: Vector3::zeros() }
    }

    /// The paper's gyro model `V = SF·(A·ω + Δ)`: `distortion = SF·A`, `bias = SF·Δ`. `bias_dps` is `Δ`.
    pub fn paper(scale: Vector3<f64>, angles: &PaperAngles, bias_dps: Vector3<f64>) -> Self {
        let scale_matrix = Matrix3::from_diagonal(&scale);
        Self { distortion: scale_matrix * angles.matrix(), bias: scale_matrix * bias_dps.map(f64::to_radians) }
    }

    /// Errors drawn uniformly: sensitivity within `±sensitivity`, each cross-axis term within `±cross_axis`, each
    /// bias within `±bias`.
    pub fn draw(bias: Vector3<f64>, sensitivity: f64, cross_axis: f64, rng: &mut Rng) -> Self {
        let distortion =
            Matrix3::from_fn(|i, j| if i == j { 1.0 + rng.symmetric(sensitivity) } else { rng.symmetric(cross_axis) });
        Self { distortion, bias: bias.map(|limit| rng.symmetric(limit)) }
    }

    /// What the sensor says.
    pub fn distort(&self, ideal: &Vector3<f64>) -> Vector3<f64> {
        self.distortion * ideal + self.bias
    }

    /// `correction` of the contract.
    ///
    /// # Errors
    /// If the axes do not span space.
    pub fn correction(&self) -> Result<Matrix3<f64>, SimError> {
        let error = SimError { setting: "distortion", value: self.distortion.determinant(), must_be: "invertible" };
        self.distortion.try_inverse().ok_or(error)
    }

    /// The rotation `R_a_from_b` to the frame whose `x` is along this triad's x axis and `y` in its x–y plane.
    ///
    /// The rows of `distortion` are the sensitive axes in `b`; Gram–Schmidt on them is `distortion = L·Q` with `L` lower-
    /// triangular of positive diagonal and `Q` the rotation, so `correction·in a = Q·correction = L⁻¹` is
    /// lower-triangular too.
    ///
    /// # Errors
    /// If the axes do not span space or are left-handed.
    pub fn own_frame(&self) -> Result<Matrix3<f64>, SimError> {
        let rows = [0, 1, 2].map(|i| self.distortion.row(i).transpose());
        let flat = SimError { setting: "distortion", value: self.distortion.determinant(), must_be: "right-handed" };
        let x = rows[0].try_normalize(1e-9).ok_or(flat.clone())?;
        let y = (rows[1] - x * x.dot(&rows[1])).try_normalize(1e-9).ok_or(flat.clone())?;
        let z = x.cross(&y);
        if z.dot(&rows[2]) <= 0.0 {
            return Err(flat);
        }
        Ok(Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()]))
    }
}
