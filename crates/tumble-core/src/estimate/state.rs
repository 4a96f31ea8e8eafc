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
use nalgebra::Vector3;

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

/// A row of the observation matrix with its zeros left out.
#[derive(Clone, Debug, Default)]
pub struct Row {
    entries: Vec<(u8, f32), 36>,
}

impl Row {
    /// All zero.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets one coefficient: `offset` counts within the block.
    pub fn with(mut self, block: Block, offset: usize, value: f32) -> Self {
        // No observation of this model has more than 34 coefficients.
        let _ = self.entries.push(((block.start() + offset) as u8, value));
        self
    }

    /// Sets three coefficients in a row.
    pub fn with_vector(self, block: Block, offset: usize, value: &Vector3<f32>) -> Self {
        self.with(block, offset, value.x).with(block, offset + 1, value.y).with(block, offset + 2, value.z)
    }

    /// All coefficients with the other sign.
    pub fn negated(mut self) -> Self {
        self.entries.iter_mut().for_each(|entry| entry.1 = -entry.1);
        self
    }

    /// (index, coefficient) of what is not zero.
    pub fn entries(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.entries.iter().map(|&(index, value)| (usize::from(index), value))
    }
}
