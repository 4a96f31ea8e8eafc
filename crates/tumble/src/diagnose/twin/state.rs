//! The error state, as in `tumble_core::estimate::state`, in `f64` and with the columns that candidates push through it.

use nalgebra::{DVector, Matrix3, SMatrix, SVector, Vector3};

/// Attitude error φ, frame n: `R_true = exp(φ×) R_nominal`.
pub const ATTITUDE: usize = 0;
/// δM by rows.
pub const GYRO: usize = 3;
/// δb, rad/s.
pub const GYRO_BIAS: usize = 12;
/// Earth's rate, frame n, rad/s.
pub const EARTH: usize = 15;
/// δA by rows.
pub const ACCEL: usize = 18;
/// δa, m/s².
pub const ACCEL_BIAS: usize = 27;
/// From the turns' common axis to the sensor, m.
pub const LEVER: usize = 30;
/// The turn's own deviation from it, m.
pub const PIVOT: usize = 33;
/// Table's normal, horizontal components.
pub const TABLE: usize = 36;
/// The face's error, rad.
pub const FACET: usize = 38;
/// Heading error at a visit's first stop, rad.
pub const FENCE: usize = 40;
/// The box's own horizontal acceleration in a turn, frame n, as the tilt that it looks like, rad.
pub const SLIDE: usize = 41;
/// All.
pub const STATES: usize = 43;
/// States that drive φ: δM, δb, Ω, which stand in a row.
pub const DRIVERS: usize = 15;

/// How φ grows over a step: `φ ← φ + drive · (δM, δb, Ω)`.
pub type Drive = SMatrix<f64, 3, DRIVERS>;

/// One scalar observation `residual = row · x + noise`.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Observed less nominal.
    pub residual: f64,
    /// (index, coefficient).
    pub row: Vec<(usize, f64)>,
    /// Of the noise.
    pub variance: f64,
}

impl Observation {
    /// One without coefficients.
    pub fn new(residual: f64, variance: f64) -> Self {
        Self { residual, row: Vec::with_capacity(24), variance }
    }

    /// Adds coefficients from `first` on.
    pub fn with(mut self, first: usize, coefficients: impl IntoIterator<Item = f64>) -> Self {
        self.row.extend(coefficients.into_iter().enumerate().map(|(offset, value)| (first + offset, value)));
        self
    }
}

/// An innovation in units of its own sigma, and what each candidate's unit adds to it.
pub struct Whitened {
    /// Standard normal under the nominal model.
    pub value: f64,
    /// Of the innovation.
    pub sigma: f64,
    /// Response to each column.
    pub response: Vec<f64>,
}

/// Mean, covariance, and the mean's error per unit of every candidate.
#[derive(Clone, Debug)]
pub struct State {
    /// x.
    pub mean: SVector<f64, STATES>,
    /// P.
    pub covariance: SMatrix<f64, STATES, STATES>,
    /// One column a candidate: what its unit has put into `true − estimated` so far.
    pub columns: Vec<[f64; STATES]>,
    /// Has it put in anything yet? Half of all columns are steps and leans, which do nothing before their time.
    begun: Vec<bool>,
}

impl State {
    /// All zero, `columns` candidates.
    pub fn new(columns: usize) -> Self {
        Self {
            mean: SVector::zeros(),
            covariance: SMatrix::zeros(),
            columns: vec![[0.0; STATES]; columns],
            begun: vec![false; columns],
        }
    }

    /// Forgets `count` states from `first`: zero, this sigma, related to nothing.
    pub fn reset(&mut self, first: usize, count: usize, sigma: f64) {
        for index in first..first + count {
            self.covariance.row_mut(index).fill(0.0);
            self.covariance.column_mut(index).fill(0.0);
            self.covariance[(index, index)] = sigma * sigma;
            self.mean[index] = 0.0;
            self.columns.iter_mut().for_each(|column| column[index] = 0.0);
        }
    }

    /// Three states of the mean.
    pub fn vector(&self, first: usize) -> Vector3<f64> {
        self.mean.fixed_rows::<3>(first).into()
    }

    /// φ moves by `drive · (δM, δb, Ω)` and gains `variance` on every axis; `push` is what each candidate puts into φ.
    pub fn propagate(&mut self, drive: &Drive, variance: f64, push: impl Fn(usize) -> Vector3<f64>) {
        // Column by column, φ's three rows of each; then the mirror image into φ's three columns and their corner.
        for column in self.covariance.as_mut_slice().chunks_exact_mut(STATES) {
            let (attitude, rest) = column.split_at_mut(GYRO);
            for (d, value) in rest[..DRIVERS].iter().enumerate() {
                (0..3).for_each(|axis| attitude[axis] += drive[(axis, d)] * value);
            }
        }
        for axis in 0..3 {
            let mut moved = [0.0; STATES];
            for d in 0..DRIVERS {
                let column = &self.covariance.as_slice()[STATES * (GYRO + d)..STATES * (GYRO + d + 1)];
                moved.iter_mut().zip(column).for_each(|(moved, value)| *moved += drive[(axis, d)] * value);
            }
            let column = &mut self.covariance.as_mut_slice()[STATES * axis..STATES * (axis + 1)];
            column.iter_mut().zip(moved).for_each(|(value, moved)| *value += moved);
        }
        for axis in 0..3 {
            self.covariance[(axis, axis)] += variance;
        }
        let moved = drive * self.mean.fixed_rows::<DRIVERS>(GYRO);
        let mut attitude = self.mean.fixed_rows_mut::<3>(ATTITUDE);
        attitude += moved;
        for (c, column) in self.columns.iter_mut().enumerate() {
            let push = push(c);
            self.begun[c] |= push != Vector3::zeros();
            if !self.begun[c] {
                continue;
            }
            let driven: [f64; 3] = std::array::from_fn(|axis| {
                (0..DRIVERS).map(|d| drive[(axis, d)] * column[GYRO + d]).sum::<f64>() + push[axis]
            });
            (0..3).for_each(|axis| column[axis] += driven[axis]);
        }
    }

    /// `count` states from `first` wander.
    pub fn wander(&mut self, first: usize, count: usize, variance: f64) {
        (first..first + count).for_each(|index| self.covariance[(index, index)] += variance);
    }

    /// `count` states from `first` decay by `factor` and gain `variance`: a step of a Gauss–Markov process.
    pub fn fade(&mut self, first: usize, count: usize, factor: f64, variance: f64) {
        for index in first..first + count {
            self.covariance.row_mut(index).scale_mut(factor);
            self.covariance.column_mut(index).scale_mut(factor);
            self.covariance[(index, index)] += variance;
            self.mean[index] *= factor;
            self.columns.iter_mut().for_each(|column| column[index] *= factor);
        }
    }

    /// The mean with candidates of these sizes there.
    pub fn allow_for(&mut self, sizes: &[f64]) {
        for (column, size) in self.columns.iter().zip(sizes) {
            self.mean += SVector::from(*column) * *size;
        }
    }

    /// A noisy clone of `φ · normal`.
    pub fn clone_heading(&mut self, normal: &Vector3<f64>, sigma: f64) {
        self.reset(FENCE, 1, 0.0);
        let row = normal.transpose() * self.covariance.fixed_view::<3, STATES>(ATTITUDE, 0);
        self.covariance.row_mut(FENCE).copy_from(&row);
        self.covariance.column_mut(FENCE).copy_from(&row.transpose());
        let own = (row.fixed_columns::<3>(ATTITUDE) * normal)[0];
        self.covariance[(FENCE, FENCE)] = own + sigma * sigma;
        self.mean[FENCE] = normal.dot(&self.vector(ATTITUDE));
        for column in &mut self.columns {
            column[FENCE] = (0..3).map(|axis| normal[axis] * column[axis]).sum();
        }
    }

    /// The frame's nominal attitude was turned by `rotation`: φ shrinks by as much.
    pub fn relevel(&mut self, rotation: &Vector3<f64>) {
        let mut attitude = self.mean.fixed_rows_mut::<3>(ATTITUDE);
        attitude -= rotation;
    }

    /// Takes an observation in; `push` is what each candidate adds to the residual directly.
    pub fn observe(&mut self, observation: &Observation, push: impl Fn(usize) -> f64) -> Whitened {
        let mut gain = SVector::<f64, STATES>::zeros();
        // By slices, which the compiler turns into vector instructions; nalgebra's `axpy` and `ger` walk with strides.
        for &(index, coefficient) in &observation.row {
            let column = &self.covariance.as_slice()[STATES * index..STATES * (index + 1)];
            gain.as_mut_slice().iter_mut().zip(column).for_each(|(gain, value)| *gain += coefficient * value);
        }
        let dot = |vector: &dyn Fn(usize) -> f64| observation.row.iter().map(|&(i, c)| c * vector(i)).sum::<f64>();
        let variance = dot(&|i| gain[i]) + observation.variance;
        let sigma = variance.sqrt();
        let innovation = observation.residual - dot(&|i| self.mean[i]);
        self.mean.axpy(innovation / variance, &gain, 1.0);
        for (column, share) in self.covariance.as_mut_slice().chunks_exact_mut(STATES).zip(gain.as_slice()) {
            let share = share / variance;
            column.iter_mut().zip(gain.as_slice()).for_each(|(value, gain)| *value -= share * gain);
        }
        let mut response = Vec::with_capacity(self.columns.len());
        for (c, column) in self.columns.iter_mut().enumerate() {
            let push = push(c);
            self.begun[c] |= push != 0.0;
            if !self.begun[c] {
                response.push(0.0);
                continue;
            }
            let moved = observation.row.iter().map(|&(i, k)| k * column[i]).sum::<f64>() + push;
            response.push(moved / sigma);
            let share = moved / variance;
            column.iter_mut().zip(gain.as_slice()).for_each(|(value, gain)| *value -= share * gain);
        }
        Whitened { value: innovation / sigma, sigma, response }
    }
}

/// A matrix' nine elements by rows.
pub fn by_rows(matrix: &Matrix3<f64>) -> impl Iterator<Item = f64> + '_ {
    (0..9).map(|k| matrix[(k / 3, k % 3)])
}

/// A vector of any length as a column.
pub fn column(values: &[f64]) -> DVector<f64> {
    DVector::from_column_slice(values)
}
