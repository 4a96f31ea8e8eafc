//! The linearised Kalman filter's arithmetic: scalar observations, a block-sparse transition, a symmetric covariance.
//!
//! Everything is `f32`. It suffices because the covariance is kept symmetric to the bit (an observation subtracts `w wᵀ`)
//! and because no prior is wider than needed: an update's rounding error is 6e-8 of the variance before it.

use core::array::from_fn;

use nalgebra::{SMatrix, Vector3};

pub use super::covariance::{Column, Covariance};
use super::state::{Block, Row, Rows};

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
    state: Column,
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
    pub fn add_to(&self, row: &mut Row, axis: usize, weight: f32) {
        row.set(Block::Earth, axis, [self.earth * weight]);
        for offset in 0..9 {
            row.set(Block::GyroCorrection, offset, [self.correction[(axis, offset)] * weight]);
        }
        for offset in 0..3 {
            row.set(Block::GyroBias, offset, [self.bias[(axis, offset)] * weight]);
        }
    }

    /// G as a whole.
    fn rows(&self) -> Rows<3> {
        let mut rows = Rows::new();
        rows.set_matrix(Block::GyroCorrection, &self.correction);
        rows.set_matrix(Block::GyroBias, &self.bias);
        for axis in 0..3 {
            let mut column = [0.0; 3];
            column[axis] = self.earth;
            rows.set(Block::Earth, axis, column);
        }
        rows
    }
}

impl Default for Filter {
    fn default() -> Self {
        Self { state: Column::ZERO, covariance: Covariance::default() }
    }
}

impl Filter {
    /// The mean.
    pub fn state(&self) -> &Column {
        &self.state
    }

    /// The covariance.
    pub fn covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// Three states of a block.
    pub fn vector(&self, block: Block, offset: usize) -> Vector3<f32> {
        Vector3::from_fn(|axis, _| self.state[block.start() + offset + axis])
    }

    /// Adds to three states: the nominal they are errors of has moved the other way.
    pub fn shift(&mut self, block: Block, by: &Vector3<f32>) {
        for axis in 0..3 {
            self.state[block.start() + axis] += by[axis];
        }
    }

    /// Everything is zero, and certain.
    pub fn clear(&mut self) {
        self.state = Column::ZERO;
        self.covariance.clear();
    }

    /// Forgets a state and starts it anew: what it was correlated with keeps what it learnt.
    pub fn reset(&mut self, block: Block, offset: usize, mean: f32, sigma: f32) {
        let index = block.start() + offset;
        self.covariance.set(index, &Column::ZERO);
        self.covariance.widen(index, sigma * sigma);
        self.state[index] = mean;
    }

    /// Adds variance to a state: a random walk's step.
    pub fn diffuse(&mut self, block: Block, variance: f32) {
        for index in block.range() {
            self.covariance.widen(index, variance);
        }
    }

    /// Makes a state a noisy copy of `row · state + mean` (stochastic cloning). Unlike an observation against a wide prior
    /// it subtracts nothing, so `f32` keeps it sharp.
    pub fn copy_to(&mut self, block: Block, offset: usize, row: &Row, mean: f32, variance: f32) {
        let index = block.start() + offset;
        self.reset(block, offset, 0.0, 0.0);
        let [mut copied] = self.covariance.times(row);
        copied[index] = variance + copied.dot(row, 0);
        self.state[index] = mean + self.state.dot(row, 0);
        self.covariance.set(index, &copied);
    }

    /// One step of motion: `φ ← φ + G·(δM, δb, Ω)`, plus `variance` on each component of φ.
    pub fn propagate(&mut self, drive: &AttitudeDrive, variance: f32) {
        let rows = drive.rows();
        // What φ takes up of the others …
        let added = self.covariance.times(&rows);
        // … and of itself: G P Gᵀ.
        let own: [[f32; 3]; 3] = from_fn(|i| from_fn(|j| added[i].dot(&rows, j)));
        let steps: [f32; 3] = from_fn(|axis| self.state.dot(&rows, axis));
        for axis in 0..3 {
            let mut column = *self.covariance.column(axis);
            column.add(&added[axis], 1.0);
            for other in 0..axis {
                // This row of φ's own 3×3 was completed with the column of the same number.
                column[other] = self.covariance[(axis, other)];
            }
            for other in axis..3 {
                column[other] += added[other][axis] + 0.5 * (own[axis][other] + own[other][axis]);
            }
            column[axis] += variance;
            self.covariance.set(axis, &column);
            self.state[axis] += steps[axis];
        }
    }

    /// Takes in `observed = row · state + noise`.
    pub fn observe(&mut self, row: &Row, observed: f32, variance: f32) -> Innovation {
        let [innovation] = self.observe_each(row, [observed], variance);
        innovation
    }

    /// Takes in a vector, `observed = rows · state + noise`, each component with noise of this variance: what [`Self::observe`] would
    /// make of one component after the other.
    pub fn observe_vector(&mut self, rows: &Rows<3>, observed: &Vector3<f32>, variance: f32) -> [Innovation; 3] {
        self.observe_each(rows, (*observed).into(), variance)
    }

    /// One component after the other, but for P, which is read once and written once: `C = P Hᵀ`, and from each column of C is taken
    /// what the components before it would have taken from P, `c − w (w · h)`.
    fn observe_each<const N: usize>(&mut self, rows: &Rows<N>, observed: [f32; N], variance: f32) -> [Innovation; N] {
        let mut columns = self.covariance.times(rows);
        let mut innovations = [Innovation { value: 0.0, variance }; N];
        for (n, innovation) in innovations.iter_mut().enumerate() {
            let mut column = columns[n];
            for before in &columns[..n] {
                column.add(before, -before.dot(rows, n));
            }
            // Rounding may take a spent variance below nothing; what the reading itself brings always remains.
            innovation.variance = (variance + column.dot(rows, n)).max(variance);
            innovation.value = observed[n] - self.state.dot(rows, n);
            self.state.add(&column, innovation.value / innovation.variance);
            columns[n] = column.scaled(1.0 / libm::sqrtf(innovation.variance));
        }
        self.covariance.subtract(&columns);
        innovations
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;

    use super::*;
    use crate::estimate::state::STATES;

    type Dense = SMatrix<f32, STATES, STATES>;
    type Vector = SVector<f32, STATES>;

    fn filter() -> Filter {
        let mut filter = Filter::default();
        for index in 0..STATES {
            filter.covariance.widen(index, 1.0 + index as f32 * 0.01);
        }
        filter
    }

    fn dense(filter: &Filter) -> (Vector, Dense) {
        (Vector::from_fn(|i, _| filter.state[i]), Dense::from_fn(|i, j| filter.covariance[(i, j)]))
    }

    fn vector(row: &Row) -> Vector {
        let mut h = Vector::zeros();
        row.entries().iter().for_each(|(index, [value])| h[usize::from(*index)] = *value);
        h
    }

    fn drive() -> AttitudeDrive {
        AttitudeDrive {
            correction: SMatrix::from_fn(|i, j| 0.1 * i as f32 - 0.03 * j as f32),
            bias: SMatrix::from_fn(|i, j| 0.2 * j as f32 - 0.05 * i as f32),
            earth: -0.4,
        }
    }

    /// Everything correlated with everything.
    fn tangled() -> Filter {
        let mut filter = filter();
        filter.observe(&Row::new().with(Block::Attitude, 1, 0.7).with(Block::GyroBias, 2, -0.3), 0.5, 0.1);
        filter.observe(&Row::new().with(Block::Earth, 0, 1.0).with(Block::GyroCorrection, 4, 0.9), -0.2, 0.2);
        let all = (0..34).fold(Row::new(), |row, k| row.with(Block::Attitude, k * 5 / 4, 0.4 - 0.03 * k as f32));
        filter.observe(&all, 0.3, 0.1);
        filter
    }

    fn assert_same(filter: &Filter, mean: &Vector, covariance: &Dense) {
        let (state, own) = dense(filter);
        assert!((own - covariance).amax() < 2e-6, "{}", (own - covariance).amax());
        assert!((state - mean).amax() < 1e-6, "{}", (state - mean).amax());
        assert_eq!(own, own.transpose());
    }

    #[test]
    fn the_sparse_transition_equals_the_dense_one() {
        let mut sparse = tangled();
        let (mean, covariance) = dense(&sparse);
        let mut transition = Dense::identity();
        let drive = drive();
        transition.fixed_view_mut::<3, 9>(0, Block::GyroCorrection.start()).copy_from(&drive.correction);
        transition.fixed_view_mut::<3, 3>(0, Block::GyroBias.start()).copy_from(&drive.bias);
        for axis in 0..3 {
            transition[(axis, Block::Earth.start() + axis)] = drive.earth;
        }
        let mut expected = transition * covariance * transition.transpose();
        for axis in 0..3 {
            expected[(axis, axis)] += 0.01;
        }
        sparse.propagate(&drive, 0.01);
        assert_same(&sparse, &(transition * mean), &expected);
    }

    #[test]
    fn an_observation_is_the_textbook_update_and_keeps_symmetry() {
        let mut filter = tangled();
        filter.propagate(&drive(), 0.0);
        let row = Row::new().with(Block::Attitude, 0, 1.0).with(Block::AccelBias, 1, 2.0);
        let (h, (mean, covariance)) = (vector(&row), dense(&filter));
        let s = (h.transpose() * covariance * h).x + 0.5;
        let gain = covariance * h / s;
        let value = 0.3 - h.dot(&mean);
        let innovation = filter.observe(&row, 0.3, 0.5);
        assert!((innovation.variance - s).abs() < 1e-5);
        assert!((innovation.value - value).abs() < 1e-6);
        assert_same(&filter, &(mean + gain * value), &(covariance - gain * h.transpose() * covariance));
    }

    #[test]
    fn a_vector_is_its_components_one_after_the_other() {
        let mut together = tangled();
        together.propagate(&drive(), 0.0);
        let mut apart = together.clone();
        let observed = Vector3::new(0.2, -0.1, -0.4);
        let mut rows = drive().rows();
        rows.set(Block::Attitude, 0, [9.8, 0.0, 0.3]);
        rows.set(Block::Wobble, 1, [0.5, -2.0, 0.7]);
        let innovations = together.observe_vector(&rows, &observed, 0.05);
        for (axis, found) in innovations.into_iter().enumerate() {
            let mut row = Row::new();
            for (index, column) in rows.entries() {
                row.set(Block::Attitude, usize::from(*index), [column[axis]]);
            }
            let expected = apart.observe(&row, observed[axis], 0.05);
            assert!((found.value - expected.value).abs() < 1e-5, "{found:?} {expected:?}");
            assert!((found.variance / expected.variance - 1.0).abs() < 1e-5, "{found:?} {expected:?}");
        }
        let (mean, covariance) = dense(&apart);
        assert_same(&together, &mean, &covariance);
    }

    #[test]
    fn a_clone_is_fully_correlated_but_for_its_noise() {
        let mut filter = tangled();
        filter.copy_to(Block::Fence, 0, &Row::new().with(Block::Attitude, 2, 1.0), 0.0, 0.25);
        let fence = Block::Fence.start();
        assert!((filter.covariance[(fence, 2)] - filter.covariance[(2, 2)]).abs() < 1e-6);
        assert!((filter.covariance[(fence, fence)] - filter.covariance[(2, 2)] - 0.25).abs() < 1e-6);
        let (_, own) = dense(&filter);
        assert_eq!(own, own.transpose());
    }
}
