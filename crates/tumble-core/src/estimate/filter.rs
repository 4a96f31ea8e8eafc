//! The linearised Kalman filter's arithmetic: scalar observations, a block-sparse transition, a symmetric covariance.
//!
//! Everything is `f32`. It suffices because the covariance is kept symmetric to the bit (an observation subtracts `w wᵀ`)
//! and because no prior is wider than needed: an update's rounding error is 6e-8 of the variance before it.

use nalgebra::{SMatrix, SVector, Vector3};

use super::state::{Block, Row, STATES};

/// Covariance of the whole state.
pub type Covariance = SMatrix<f32, STATES, STATES>;

/// What an observation said that was not expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation {
    /// Observed minus predicted.
    pub value: f32,
    /// Its variance, observation noise included.
    pub variance: f32,
}

impl Innovation {
    /// Normalised innovation squared, χ² with one degree of freedom if all is as assumed.
    pub fn nis(&self) -> f32 {
        self.value * self.value / self.variance
    }
}

/// Mean and covariance of the error state.
#[derive(Clone, Debug)]
pub struct Filter {
    state: SVector<f32, STATES>,
    covariance: Covariance,
}

/// The transition's only rows that are not the identity's: how attitude takes up the other blocks in one step.
#[derive(Clone, Copy, Debug)]
pub struct AttitudeDrive {
    /// 3×9, δM.
    pub correction: SMatrix<f32, 3, 9>,
    /// 3×3, δb.
    pub bias: SMatrix<f32, 3, 3>,
    /// Scalar times the identity, Ω.
    pub earth: f32,
}

impl Default for AttitudeDrive {
    fn default() -> Self {
        Self { correction: SMatrix::zeros(), bias: SMatrix::zeros(), earth: 0.0 }
    }
}

impl AttitudeDrive {
    /// Adds `weight · other`: in frame n attitude errors only ever add up.
    pub fn add(&mut self, other: &Self, weight: f32) {
        self.correction += other.correction * weight;
        self.bias += other.bias * weight;
        self.earth += other.earth * weight;
    }

    /// Adds `weight` times the row of one attitude component.
    pub fn add_to(&self, row: Row, axis: usize, weight: f32) -> Row {
        let mut row = row.with(Block::Earth, axis, self.earth * weight);
        for index in 0..9 {
            row = row.with(Block::GyroCorrection, index, self.correction[(axis, index)] * weight);
        }
        row.with_vector(Block::GyroBias, 0, &(self.bias.row(axis).transpose() * weight))
    }
}

impl Default for Filter {
    fn default() -> Self {
        Self { state: SVector::zeros(), covariance: Covariance::zeros() }
    }
}

impl Filter {
    /// The mean.
    pub fn state(&self) -> &SVector<f32, STATES> {
        &self.state
    }

    /// The covariance.
    pub fn covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// Three states of a block.
    pub fn vector(&self, block: Block, offset: usize) -> Vector3<f32> {
        self.state.fixed_rows::<3>(block.start() + offset).into_owned()
    }

    /// Adds to three states: the nominal they are errors of has moved the other way.
    pub fn shift(&mut self, block: Block, by: &Vector3<f32>) {
        for axis in 0..3 {
            self.state[block.start() + axis] += by[axis];
        }
    }

    /// Forgets a state and starts it anew: what it was correlated with keeps what it learnt.
    pub fn reset(&mut self, block: Block, offset: usize, mean: f32, sigma: f32) {
        let index = block.start() + offset;
        self.covariance.row_mut(index).fill(0.0);
        self.covariance.column_mut(index).fill(0.0);
        self.covariance[(index, index)] = sigma * sigma;
        self.state[index] = mean;
    }

    /// Adds variance to a state: a random walk's step.
    pub fn diffuse(&mut self, block: Block, variance: f32) {
        for index in block.range() {
            self.covariance[(index, index)] += variance;
        }
    }

    /// Makes a state a noisy copy of `row · state + mean` (stochastic cloning). Unlike an observation against a wide prior
    /// it subtracts nothing, so `f32` keeps it sharp.
    pub fn copy_to(&mut self, block: Block, offset: usize, row: &Row, mean: f32, variance: f32) {
        let index = block.start() + offset;
        self.reset(block, offset, 0.0, 0.0);
        let copied = self.covariance_times(row);
        let (mut mean, mut own) = (mean, variance);
        for (from, value) in row.entries() {
            mean += value * self.state[from];
            own += value * copied[from];
        }
        self.covariance.set_column(index, &copied);
        self.covariance.set_row(index, &copied.transpose());
        self.covariance[(index, index)] = own;
        self.state[index] = mean;
    }

    /// One step of motion: `φ ← φ + G·(δM, δb, Ω)`, plus `variance` on each component of φ.
    pub fn propagate(&mut self, drive: &AttitudeDrive, variance: f32) {
        const CORRECTION: usize = Block::GyroCorrection.start();
        const BIAS: usize = Block::GyroBias.start();
        const EARTH: usize = Block::Earth.start();
        let p = &mut self.covariance;
        // The rows of φ against all states, by symmetry read from columns, which lie contiguous.
        let rows = drive.correction * p.fixed_rows::<9>(CORRECTION)
            + drive.bias * p.fixed_rows::<3>(BIAS)
            + p.fixed_rows::<3>(EARTH) * drive.earth;
        let mut attitude = p.fixed_rows_mut::<3>(Block::Attitude.start());
        attitude += rows;
        // What φ has taken up shows in its own 3×3 as well, now through the columns.
        let own = p.fixed_view::<3, 9>(0, CORRECTION) * drive.correction.transpose()
            + p.fixed_view::<3, 3>(0, BIAS) * drive.bias.transpose()
            + p.fixed_view::<3, 3>(0, EARTH) * drive.earth;
        for row in 0..3 {
            for column in 0..3 {
                p[(row, column)] += own[(row, column)];
            }
        }
        for row in 0..3 {
            for column in 0..row {
                let mean = 0.5 * (p[(row, column)] + p[(column, row)]);
                p[(row, column)] = mean;
                p[(column, row)] = mean;
            }
            p[(row, row)] += variance;
            for column in 3..STATES {
                p[(column, row)] = p[(row, column)];
            }
        }
        let step = drive.correction * self.state.fixed_rows::<9>(CORRECTION)
            + drive.bias * self.state.fixed_rows::<3>(BIAS)
            + self.state.fixed_rows::<3>(EARTH) * drive.earth;
        for row in 0..3 {
            self.state[row] += step[row];
        }
    }

    /// Takes in `observed = row · state + noise`.
    pub fn observe(&mut self, row: &Row, observed: f32, variance: f32) -> Innovation {
        let mut column = self.covariance_times(row);
        let mut innovation = Innovation { value: observed, variance };
        for (index, value) in row.entries() {
            innovation.value -= value * self.state[index];
            innovation.variance += value * column[index];
        }
        // Rounding may take a spent variance below nothing; what the reading itself brings always remains.
        innovation.variance = innovation.variance.max(variance);
        let step = innovation.value / innovation.variance;
        let root = 1.0 / libm::sqrtf(innovation.variance);
        let column = column.as_mut_slice();
        for (state, gain) in self.state.as_mut_slice().iter_mut().zip(&*column) {
            *state += gain * step;
        }
        column.iter_mut().for_each(|element| *element *= root);
        // Slices, because a matrix's own iterators and indices cost four times as much: this loop is most of the work.
        for (own, scale) in self.covariance.as_mut_slice().chunks_exact_mut(STATES).zip(&*column) {
            for (element, value) in own.iter_mut().zip(&*column) {
                *element -= value * scale;
            }
        }
        innovation
    }

    fn covariance_times(&self, row: &Row) -> SVector<f32, STATES> {
        let mut product = SVector::<f32, STATES>::zeros();
        let sums = product.as_mut_slice();
        let covariance = self.covariance.as_slice();
        for (index, coefficient) in row.entries() {
            for (sum, value) in sums.iter_mut().zip(&covariance[index * STATES..(index + 1) * STATES]) {
                *sum += value * coefficient;
            }
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter() -> Filter {
        let mut filter = Filter::default();
        for index in 0..STATES {
            filter.covariance[(index, index)] = 1.0 + index as f32 * 0.01;
        }
        filter
    }

    fn drive() -> AttitudeDrive {
        AttitudeDrive {
            correction: SMatrix::from_fn(|i, j| 0.1 * i as f32 - 0.03 * j as f32),
            bias: SMatrix::from_fn(|i, j| 0.2 * j as f32 - 0.05 * i as f32),
            earth: -0.4,
        }
    }

    #[test]
    fn the_sparse_transition_equals_the_dense_one() {
        let mut sparse = filter();
        sparse.observe(&Row::new().with(Block::Attitude, 1, 0.7).with(Block::GyroBias, 2, -0.3), 0.5, 0.1);
        sparse.observe(&Row::new().with(Block::Earth, 0, 1.0).with(Block::GyroCorrection, 4, 0.9), -0.2, 0.2);
        let mut transition = Covariance::identity();
        let drive = drive();
        transition.fixed_view_mut::<3, 9>(0, Block::GyroCorrection.start()).copy_from(&drive.correction);
        transition.fixed_view_mut::<3, 3>(0, Block::GyroBias.start()).copy_from(&drive.bias);
        for axis in 0..3 {
            transition[(axis, Block::Earth.start() + axis)] = drive.earth;
        }
        let mut expected = transition * sparse.covariance * transition.transpose();
        let mean = transition * sparse.state;
        for axis in 0..3 {
            expected[(axis, axis)] += 0.01;
        }
        sparse.propagate(&drive, 0.01);
        assert!((sparse.covariance - expected).amax() < 2e-6, "{}", (sparse.covariance - expected).amax());
        assert!((sparse.state - mean).amax() < 1e-6);
        assert_eq!(sparse.covariance, sparse.covariance.transpose());
    }

    #[test]
    fn an_observation_is_the_textbook_update_and_keeps_symmetry() {
        let mut filter = filter();
        filter.propagate(&drive(), 0.0);
        let row = Row::new().with(Block::Attitude, 0, 1.0).with(Block::AccelBias, 1, 2.0);
        let mut h = SVector::<f32, STATES>::zeros();
        row.entries().for_each(|(index, value)| h[index] = value);
        let s = (h.transpose() * filter.covariance * h).x + 0.5;
        let gain = filter.covariance * h / s;
        let expected = filter.covariance - gain * h.transpose() * filter.covariance;
        let innovation = filter.observe(&row, 0.3, 0.5);
        assert!((innovation.variance - s).abs() < 1e-5);
        assert!((filter.covariance - expected).amax() < 2e-6);
        assert_eq!(filter.covariance, filter.covariance.transpose());
        assert!((filter.state - gain * 0.3).amax() < 1e-6);
    }

    #[test]
    fn a_clone_is_fully_correlated_but_for_its_noise() {
        let mut filter = filter();
        filter.copy_to(Block::Fence, 0, &Row::new().with(Block::Attitude, 2, 1.0), 0.0, 0.25);
        let fence = Block::Fence.start();
        assert!((filter.covariance[(fence, 2)] - filter.covariance[(2, 2)]).abs() < 1e-6);
        assert!((filter.covariance[(fence, fence)] - filter.covariance[(2, 2)] - 0.25).abs() < 1e-6);
    }
}
