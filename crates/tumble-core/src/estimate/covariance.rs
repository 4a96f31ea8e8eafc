//! A symmetric covariance, stored whole, in the shapes that a Cortex-M4F multiplies fastest.
//!
//! The microcontroller spends most of an estimate in two products: `C = P Hᵀ` and `P ← P − W Wᵀ`. Both are loads, multiply–adds
//! and stores, so what counts is how many multiply–adds come to one load. A column lies in chunks of four numbers, which one
//! instruction loads; H may have several rows and W several columns, which are then done in one walk over P; and of `W Wᵀ` the lower
//! triangle is computed, by blocks of 4×4, and copied. Three observations at once take a quarter of the instructions that one
//! after the other took on the full square (`cargo xtask bench`).

use core::ops::{Index, IndexMut};

use super::state::{Rows, STATES};

/// Numbers that are loaded together.
const WIDTH: usize = 4;
/// Chunks of a column.
const CHUNKS: usize = STATES.div_ceil(WIDTH);
/// States with those that fill the last chunk: their covariance is nothing, and stays nothing.
const PADDED: usize = CHUNKS * WIDTH;

type Chunk = [f32; WIDTH];

/// A vector over the states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column([Chunk; CHUNKS]);

impl Column {
    /// Nothing.
    pub const ZERO: Self = Self([[0.0; WIDTH]; CHUNKS]);

    /// `self + other · factor`.
    pub fn add(&mut self, other: &Self, factor: f32) {
        for (sum, value) in self.0.iter_mut().zip(&other.0) {
            add(sum, value, factor);
        }
    }

    /// Times a number.
    pub fn scaled(&self, factor: f32) -> Self {
        Self(self.0.map(|chunk| chunk.map(|value| value * factor)))
    }

    /// Row n of these times this.
    pub fn dot<const N: usize>(&self, rows: &Rows<N>, n: usize) -> f32 {
        let values = self.0.as_flattened();
        rows.entries().iter().fold(0.0, |sum, (index, column)| sum + column[n] * values[usize::from(*index)])
    }

    /// The states' numbers.
    pub fn values(&self) -> &[f32] {
        &self.0.as_flattened()[..STATES]
    }
}

impl Index<usize> for Column {
    type Output = f32;

    fn index(&self, index: usize) -> &f32 {
        &self.0.as_flattened()[index]
    }
}

impl IndexMut<usize> for Column {
    fn index_mut(&mut self, index: usize) -> &mut f32 {
        &mut self.0.as_flattened_mut()[index]
    }
}

/// P, `STATES`×`STATES`, symmetric to the bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance([Column; PADDED]);

impl Default for Covariance {
    fn default() -> Self {
        Self([Column::ZERO; PADDED])
    }
}

impl Index<(usize, usize)> for Covariance {
    type Output = f32;

    fn index(&self, (row, column): (usize, usize)) -> &f32 {
        &self.0[column][row]
    }
}

impl Covariance {
    /// Everything is zero.
    pub fn clear(&mut self) {
        self.0.fill(Column::ZERO);
    }

    /// The variances.
    pub fn diagonal(&self) -> impl Iterator<Item = f32> + '_ {
        (0..STATES).map(|index| self[(index, index)])
    }

    /// A state's covariance with all states, its variance among them.
    pub fn set(&mut self, index: usize, with: &Column) {
        self.0[index] = *with;
        for (column, value) in self.0.iter_mut().zip(with.values()) {
            column[index] = *value;
        }
    }

    /// Adds to a variance.
    pub fn widen(&mut self, index: usize, variance: f32) {
        self.0[index][index] += variance;
    }

    /// Of one state.
    pub fn column(&self, index: usize) -> &Column {
        &self.0[index]
    }

    /// `P Hᵀ`: two of P's columns at a time, each loaded once for all rows.
    pub fn times<const N: usize>(&self, rows: &Rows<N>) -> [Column; N] {
        let mut product = [Column::ZERO; N];
        let (pairs, last) = rows.entries().as_chunks::<2>();
        for [(first, a), (second, b)] in pairs {
            add_pair(&mut product, [self.column((*first).into()), self.column((*second).into())], a, b);
        }
        for (index, coefficients) in last {
            for (sum, coefficient) in product.iter_mut().zip(coefficients) {
                sum.add(self.column((*index).into()), *coefficient);
            }
        }
        product
    }

    /// `P ← P − W Wᵀ`.
    pub fn subtract<const N: usize>(&mut self, w: &[Column; N]) {
        for block in 0..CHUNKS {
            let (_, columns) = self.0.split_at_mut(block * WIDTH);
            let (own, right) = columns.split_at_mut(WIDTH);
            let Some(own) = own.first_chunk_mut::<WIDTH>() else { return };
            let scales = chunks(w, block);
            // On the diagonal the block is its own mirror image: products commute to the bit.
            subtract_block(own, block, &scales, &scales);
            for (chunk, mirror) in (block + 1..CHUNKS).zip(right.as_chunks_mut::<WIDTH>().0) {
                let columns = subtract_block(own, chunk, &chunks(w, chunk), &scales);
                for row in 0..WIDTH {
                    mirror[row].0[block] = [columns[0][row], columns[1][row], columns[2][row], columns[3][row]];
                }
            }
        }
    }
}

/// The same chunk of each column. Written as a loop: `array::from_fn` stays a call of its own here, which costs twice the arithmetic.
#[inline(always)]
fn chunks<const N: usize>(columns: &[Column; N], chunk: usize) -> [Chunk; N] {
    let mut taken = [[0.0; WIDTH]; N];
    for n in 0..N {
        taken[n] = columns[n].0[chunk];
    }
    taken
}

#[inline(always)]
fn add(sum: &mut Chunk, value: &Chunk, factor: f32) {
    for i in 0..WIDTH {
        sum[i] += value[i] * factor;
    }
}

#[inline(always)]
fn add_pair<const N: usize>(product: &mut [Column; N], pair: [&Column; 2], first: &[f32; N], second: &[f32; N]) {
    for chunk in 0..CHUNKS {
        let [a, b] = pair.map(|column| column.0[chunk]);
        for n in 0..N {
            let sum = &mut product[n].0[chunk];
            add(sum, &a, first[n]);
            add(sum, &b, second[n]);
        }
    }
}

/// One block of 4×4, by columns: as it was, less `factors` times `scales`.
#[inline(always)]
fn subtract_block<const N: usize>(
    own: &mut [Column; WIDTH],
    chunk: usize,
    factors: &[Chunk; N],
    scales: &[Chunk; N],
) -> [Chunk; WIDTH] {
    let mut block = [[0.0; WIDTH]; WIDTH];
    for i in 0..WIDTH {
        let mut column = own[i].0[chunk];
        for n in 0..N {
            add(&mut column, &factors[n], -scales[n][i]);
        }
        own[i].0[chunk] = column;
        block[i] = column;
    }
    block
}
