//! The 15-state filter's arithmetic: a block-sparse transition and scalar updates, under 1000 multiply–adds a step.
//!
//! State `x = [φ δv δp K]`, 3 + 3 + 3 + 6, in rad, m/s, m and 1; frame n is level, its heading that of the turn's start.
//! One step is the product of three elementary transitions, leap-frog: δp and φ stand at the middle of a record, δv at its
//! end, which makes first-order factors second-order accurate:
//!
//! ```text
//! δp ← δp + τ δv        3 non-zeros     τ: from the middle of the last record to that of this one, s
//! φ  ← φ  + G K        18 non-zeros     G: 3×6, M_k of equation (14) integrated over τ
//! δv ← δv + W φ         6 non-zeros     W = [fⁿ×] dt, m/s
//! P  ← F P Fᵀ + Q                       Q: on the diagonals of φ and δv
//! ```
//!
//! A non-zero of F off the diagonal costs one multiply–add for the state, 15 for a column of P and on average two within its
//! own block's lower triangle: 18. An observation of one state costs 15 for the gain, 15 for the state and 120 for the lower
//! triangle of P: 150. In all 942; building G and its mean takes another 36. Dense, F P Fᵀ alone is 6750.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use nalgebra::{SMatrix, SVector, Vector3};

/// Number of states.
pub const STATES: usize = 15;
/// Where φ begins.
pub const ATTITUDE: usize = 0;
/// Where δv begins.
pub const VELOCITY: usize = 3;
/// Where δp begins.
pub const POSITION: usize = 6;
/// Where K begins.
pub const GYRO: usize = 9;
/// Multiply–adds of [`Filter::predict`]: 27 non-zeros of F and 6 of Q.
pub const PREDICT_MULTIPLY_ADDS: usize = (3 + 18 + 6) * 18 + 6;
/// Multiply–adds of [`Filter::observe`].
pub const OBSERVE_MULTIPLY_ADDS: usize = 15 + 15 + 120;
/// Multiply–adds of a step: a prediction and three components of position.
pub const STEP_MULTIPLY_ADDS: usize = PREDICT_MULTIPLY_ADDS + 3 * OBSERVE_MULTIPLY_ADDS;

/// What the filter's arithmetic asks of its numbers: the four operations. A test counts them with a number of its own.
pub trait Number:
    Copy
    + PartialEq
    + Debug
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
}

impl<T> Number for T where
    T: Copy
        + PartialEq
        + Debug
        + 'static
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<Output = T>
        + Div<Output = T>
        + Neg<Output = T>
        + AddAssign
        + SubAssign
{
}

/// Mean and covariance of the state.
pub type State<T> = SVector<T, STATES>;
/// Covariance of the state.
pub type Covariance<T> = SMatrix<T, STATES, STATES>;

/// One record's transition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T: Number> {
    /// From the middle of the last record to the middle of this one, s.
    pub tau_s: T,
    /// G: 3×6, rad.
    pub drive: SMatrix<T, 3, 6>,
    /// `fⁿ dt`, m/s.
    pub impulse: Vector3<T>,
    /// Variance that each component of φ gains, rad².
    pub attitude_variance: T,
    /// Variance that each component of δv gains, (m/s)².
    pub velocity_variance: T,
}

/// What an observation said that was not expected, and what was made of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation<T: Number> {
    /// Observed minus predicted.
    pub value: T,
    /// Its variance, observation noise included.
    pub variance: T,
    /// 15: state moved by gain · value.
    pub gain: State<T>,
}

impl<T: Number> Innovation<T> {
    /// Normalised innovation squared: χ² with one degree of freedom if all is as assumed.
    pub fn nis(&self) -> T {
        self.value * self.value / self.variance
    }
}

/// The filter. P is symmetric to the bit: its lower triangle is computed, the upper is a copy.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter<T: Number> {
    state: State<T>,
    covariance: Covariance<T>,
}

impl<T: Number> Filter<T> {
    /// From a mean and a symmetric covariance.
    pub fn new(state: State<T>, covariance: Covariance<T>) -> Self {
        Self { state, covariance }
    }

    /// The mean.
    pub fn state(&self) -> &State<T> {
        &self.state
    }

    /// The covariance.
    pub fn covariance(&self) -> &Covariance<T> {
        &self.covariance
    }

    /// Forgets a state and starts it anew at `zero` (the number), independent of the others.
    pub fn reset(&mut self, index: usize, zero: T, variance: T) {
        self.covariance.row_mut(index).fill(zero);
        self.covariance.column_mut(index).fill(zero);
        self.covariance[(index, index)] = variance;
        self.state[index] = zero;
    }

    /// One record further.
    pub fn predict(&mut self, motion: &Motion<T>) {
        self.transform(POSITION, VELOCITY, &[0, 1, 2].map(|axis| (axis, axis, motion.tau_s)));
        self.transform(ATTITUDE, GYRO, &drive(motion));
        self.transform(VELOCITY, ATTITUDE, &cross(&motion.impulse));
        for axis in 0..3 {
            self.covariance[(ATTITUDE + axis, ATTITUDE + axis)] += motion.attitude_variance;
            self.covariance[(VELOCITY + axis, VELOCITY + axis)] += motion.velocity_variance;
        }
    }

    /// `x ← (1 + M) x`, `P ← (1 + M) P (1 + M)ᵀ`, M's entries mapping the block `from` to the three states `to`.
    #[expect(clippy::needless_range_loop, reason = "rows and columns of one symmetric matrix")]
    fn transform<const N: usize>(&mut self, to: usize, from: usize, entries: &[Entry<T>; N]) {
        // By columns, as they are stored.
        let p = &mut self.covariance.data.0;
        for &(i, j, m) in entries {
            let (source, step) = (p[from + j], m * self.state[from + j]);
            self.state[to + i] += step;
            for (sum, value) in p[to + i].iter_mut().zip(source) {
                *sum += m * value;
            }
        }
        // That was P (1 + M)ᵀ. (1 + M) times that, within the own block's lower triangle: the other rows are the columns'
        // mirror image.
        for &(i, j, m) in entries {
            for column in to..=to + i {
                let step = m * p[column][from + j];
                p[column][to + i] += step;
            }
        }
        for i in to..to + 3 {
            for other in (0..to).chain(i + 1..STATES) {
                p[other][i] = p[i][other];
            }
        }
    }

    /// Takes in `observed = x[index] + noise` of this variance.
    #[expect(clippy::needless_range_loop, reason = "rows and columns of one symmetric matrix")]
    pub fn observe(&mut self, index: usize, observed: T, variance: T) -> Innovation<T> {
        let column: State<T> = self.covariance.column(index).into_owned();
        let value = observed - self.state[index];
        let variance = column[index] + variance;
        let gain = column.map(|c| c / variance);
        self.state.iter_mut().zip(gain.iter()).for_each(|(state, gain)| *state += *gain * value);
        let p = &mut self.covariance.data.0;
        let (gains, scales) = (&gain.data.0[0], &column.data.0[0]);
        for j in 0..STATES {
            for i in j..STATES {
                p[j][i] -= gains[i] * scales[j];
            }
            for i in 0..j {
                p[j][i] = p[i][j];
            }
        }
        Innovation { value, variance, gain }
    }
}

/// (row, column, value) of a non-zero within a block of F: where the sparsity is expressed, once.
type Entry<T> = (usize, usize, T);

/// G, dense.
fn drive<T: Number>(motion: &Motion<T>) -> [Entry<T>; 18] {
    core::array::from_fn(|entry| (entry % 3, entry / 3, motion.drive[(entry % 3, entry / 3)]))
}

/// [f×]: row i takes −f_k from column j and f_j from column k, (i, j, k) cyclic.
fn cross<T: Number>(f: &Vector3<T>) -> [Entry<T>; 6] {
    core::array::from_fn(|entry| {
        let (i, j, k) = (entry / 2, (entry / 2 + 1) % 3, (entry / 2 + 2) % 3);
        if entry % 2 == 0 { (i, j, -f[k]) } else { (i, k, f[j]) }
    })
}
