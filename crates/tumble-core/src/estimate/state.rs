//! The error state: which numbers stand where, said once.
//!
//! | block | size | unit | meaning |
//! |---|---|---|---|
//! | attitude φ | 3 | rad | `rotation_n_from_b = exp(φ×) · nominal`, frame n |
//! | gyro correction δM | 9 | 1 | row by row, `ω = (M + δM)(raw − b − δb)` |
//! | gyro bias δb | 3 | rad/s | sensor axes, a random walk |
//! | accelerometer correction δA | 9 | 1 | row by row, `f = (A + δA)(raw − a − δa)` |
//! | accelerometer bias δa | 3 | m/s² | sensor axes |
//! | lever l | 3 | m | from the turns' common axis to the sensor, frame b |
//! | pivot | 3 | m | how far a turn's own axis is from the common one, frame b; anew for every turn |
//! | table p | 2 | 1 | horizontal components of the table's normal, frame n |
//! | Earth Ω | 3 | rad/s | Earth's rotation, frame n, whose heading is that of the first still |
//! | fence h | 1 | rad | heading error at the first stop of a visit, less that stop's own error |
//! | facet e | 2 | rad | how far the face that lies on the table is from square, frame b; anew for every visit |
//! | wobble w | 2 | rad | how far the face leaves the table in a turn, as seen from the box; anew for every turn |

use heapless::Vec;
use nalgebra::{SMatrix, Vector3};

/// All of it.
pub const STATES: usize = 43;

/// A run of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// φ.
    Attitude,
    /// δM.
    GyroCorrection,
    /// δb.
    GyroBias,
    /// δA.
    AccelCorrection,
    /// δa.
    AccelBias,
    /// l.
    Lever,
    /// Its deviation in this turn.
    Pivot,
    /// p.
    Table,
    /// Ω.
    Earth,
    /// h.
    Fence,
    /// e.
    Facet,
    /// w.
    Wobble,
}

impl Block {
    /// Where it begins.
    pub const fn start(self) -> usize {
        match self {
            Self::Attitude => 0,
            Self::GyroCorrection => 3,
            Self::GyroBias => 12,
            Self::AccelCorrection => 15,
            Self::AccelBias => 24,
            Self::Lever => 27,
            Self::Pivot => 30,
            Self::Table => 33,
            Self::Earth => 35,
            Self::Fence => 38,
            Self::Facet => 39,
            Self::Wobble => 41,
        }
    }

    /// How many states it has.
    pub const fn size(self) -> usize {
        match self {
            Self::GyroCorrection | Self::AccelCorrection => 9,
            Self::Table | Self::Facet | Self::Wobble => 2,
            Self::Fence => 1,
            _ => 3,
        }
    }

    /// Its indices.
    pub fn range(self) -> core::ops::Range<usize> {
        self.start()..self.start() + self.size()
    }
}

/// Rows of an observation matrix, N×`STATES`, column by column with the empty columns left out.
#[derive(Clone, Debug, Default)]
pub struct Rows<const N: usize> {
    entries: Vec<(u8, [f32; N]), 36>,
}

/// One of them.
pub type Row = Rows<1>;

impl<const N: usize> Rows<N> {
    /// All zero.
    pub fn new() -> Self {
        Self { entries: Vec::new() }
    }

    /// Sets the column of one state: `offset` counts within the block. By reference, because a `Rows` is 0.6 KB to move.
    pub fn set(&mut self, block: Block, offset: usize, column: [f32; N]) {
        // No observation of this model has more than 34 columns.
        let _ = self.entries.push(((block.start() + offset) as u8, column));
    }

    /// Sets the columns of a block's first states.
    pub fn set_matrix<const C: usize>(&mut self, block: Block, matrix: &SMatrix<f32, N, C>) {
        for (offset, column) in matrix.data.0.iter().enumerate() {
            self.set(block, offset, *column);
        }
    }

    /// (index, column) of what is not empty.
    pub fn entries(&self) -> &[(u8, [f32; N])] {
        &self.entries
    }
}

impl Row {
    /// Sets one coefficient: `offset` counts within the block.
    pub fn with(mut self, block: Block, offset: usize, value: f32) -> Self {
        self.set(block, offset, [value]);
        self
    }

    /// Sets three coefficients in a row.
    pub fn with_vector(mut self, block: Block, offset: usize, value: &Vector3<f32>) -> Self {
        (0..3).for_each(|axis| self.set(block, offset + axis, [value[axis]]));
        self
    }

    /// All coefficients with the other sign.
    pub fn negated(mut self) -> Self {
        self.entries.iter_mut().for_each(|entry| entry.1 = [-entry.1[0]]);
        self
    }
}
