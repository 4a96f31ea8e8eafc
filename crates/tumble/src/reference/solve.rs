//! Least squares over blocks of residuals, each of which depends on few unknowns; solved by the crate
//! `levenberg-marquardt` (MINPACK's algorithm). Its nalgebra is a version older than ours, so matrices are copied here.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::DMatrix;
use nalgebra_of_solver::{DMatrix as Matrix, DVector as Vector, Dyn, storage::Owned};

/// From all unknowns to residuals.
type Residual<'a> = dyn Fn(&[f64]) -> Vec<f64> + 'a;

/// Whitened residuals: of variance 1 if all is as assumed.
pub struct Block<'a> {
    /// Unknowns it depends on.
    pub unknowns: Vec<usize>,
    /// Of all unknowns.
    pub residual: Box<Residual<'a>>,
}

impl<'a> Block<'a> {
    /// A block.
    pub fn new(unknowns: impl IntoIterator<Item = usize>, residual: impl Fn(&[f64]) -> Vec<f64> + 'a) -> Self {
        Self { unknowns: unknowns.into_iter().collect(), residual: Box::new(residual) }
    }

    /// What was known of one unknown before.
    pub fn prior(unknown: usize, mean: f64, sigma: f64) -> Self {
        Self::new([unknown], move |x| vec![(x[unknown] - mean) / sigma])
    }
}

/// Where it ended.
pub struct Solution {
    /// Unknowns.
    pub x: Vec<f64>,
    /// `(JᵀJ)⁻¹`: their covariance; none if it is singular.
    pub covariance: Option<DMatrix<f64>>,
    /// Half the sum of squares.
    pub cost: f64,
    /// Residuals.
    pub residuals: usize,
}

struct Problem<'a, 'b> {
    blocks: &'b [Block<'a>],
    steps: &'b [f64],
    x: Vector<f64>,
    rows: usize,
}

/// Minimises half the sum of squares from `start`. `steps` are those of the central differences: with them of
/// 1e-6 of a radian or of 1, `f64` leaves derivatives exact to 1e-9.
pub fn minimise(blocks: &[Block], start: Vec<f64>, steps: &[f64]) -> Solution {
    let rows = blocks.iter().map(|block| (block.residual)(&start).len()).sum();
    let problem = Problem { blocks, steps, x: Vector::from_vec(start), rows };
    let solver = LevenbergMarquardt::new().with_ftol(1e-14).with_xtol(1e-12).with_patience(20);
    let (problem, report) = solver.minimize(problem);
    let jacobian = problem.derivatives();
    let n = problem.x.len();
    // Scaled to unit columns: unknowns differ by many decades.
    let norms: Vec<f64> = jacobian.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
    let scaled = DMatrix::from_fn(rows, n, |i, j| jacobian[(i, j)] / norms[j]);
    let inverse = scaled.tr_mul(&scaled).cholesky().map(|cholesky| cholesky.inverse());
    let covariance = inverse.map(|inverse| DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] / (norms[i] * norms[j])));
    Solution { x: problem.x.as_slice().to_vec(), covariance, cost: report.objective_function, residuals: rows }
}

impl Problem<'_, '_> {
    fn derivatives(&self) -> Matrix<f64> {
        let mut jacobian = Matrix::zeros(self.rows, self.x.len());
        let mut x = self.x.as_slice().to_vec();
        let mut first = 0;
        for block in self.blocks {
            let mut length = 0;
            for &unknown in &block.unknowns {
                let (here, step) = (x[unknown], self.steps[unknown]);
                x[unknown] = here + step;
                let above = (block.residual)(&x);
                x[unknown] = here - step;
                let below = (block.residual)(&x);
                x[unknown] = here;
                length = above.len();
                for (row, (above, below)) in above.iter().zip(&below).enumerate() {
                    jacobian[(first + row, unknown)] = (above - below) / (2.0 * step);
                }
            }
            first += length;
        }
        jacobian
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_, '_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &Vector<f64>) {
        self.x.copy_from(x);
    }

    fn params(&self) -> Vector<f64> {
        self.x.clone()
    }

    fn residuals(&self) -> Option<Vector<f64>> {
        let x = self.x.as_slice();
        let all: Vec<f64> = self.blocks.iter().flat_map(|block| (block.residual)(x)).collect();
        all.iter().all(|residual| residual.is_finite()).then(|| Vector::from_vec(all))
    }

    fn jacobian(&self) -> Option<Matrix<f64>> {
        Some(self.derivatives())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two readings of a, one of a·b, a prior on b: by hand, the linearised covariance.
    #[test]
    fn a_small_problem_is_solved_with_its_covariance() {
        let blocks = [
            Block::new([0], |x| vec![(x[0] - 2.0) / 0.1, (x[0] - 2.2) / 0.1]),
            Block::new([0, 1], |x| vec![(x[0] * x[1] - 6.3) / 0.01]),
            Block::prior(1, 3.0, 1e3),
        ];
        let solution = minimise(&blocks, vec![1.0, 1.0], &[1e-6, 1e-6]);
        assert!((solution.x[0] - 2.1).abs() < 1e-6 && (solution.x[1] - 3.0).abs() < 1e-6, "{:?}", solution.x);
        let covariance = solution.covariance.expect("determined");
        assert!((covariance[(0, 0)] - 0.005).abs() < 1e-6);
        let expected = (0.01f64 / 2.1).powi(2) + 0.005 * (3.0f64 / 2.1).powi(2);
        assert!((covariance[(1, 1)] - expected).abs() < 1e-6, "{} {expected}", covariance[(1, 1)]);
        assert_eq!(solution.residuals, 4);
    }
}
