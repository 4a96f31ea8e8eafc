//! The flash array itself: what its cells hold, across power cycles, and what a power cut leaves in them.

use crate::memory_map::{FLASH_BYTES, SECTOR_BYTES, sector_start};

/// How long the array takes, and thereby how long the core stands still: one bank, so an instruction fetch
/// waits for the operation to end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlashTiming {
    /// Multiplies the data sheet's erase times (STM32F411 data sheet table 47: 2 s for 128 KB at x8, 1 s at x32).
    pub erase_scale: f64,
    /// One program operation, 16 µs typical at every parallelism.
    pub program_ns: u64,
}

impl Default for FlashTiming {
    fn default() -> Self {
        Self { erase_scale: 1.0, program_ns: 16_000 }
    }
}

/// Typical erase times in milliseconds: rows 16, 64, 128 KB; columns x8, x16, x32.
const ERASE_MS: [[f64; 3]; 3] = [[400.0, 300.0, 250.0], [1200.0, 700.0, 550.0], [2000.0, 1300.0, 1000.0]];

impl FlashTiming {
    #[must_use]
    pub fn erase_ns(&self, sector: usize, parallelism: usize) -> u64 {
        let row = match SECTOR_BYTES[sector] {
            0x4000 => 0,
            0x1_0000 => 1,
            _ => 2,
        };
        let milliseconds = ERASE_MS[row][parallelism.min(2)] * self.erase_scale;
        (milliseconds * 1e6) as u64
    }
}

/// What one operation did to the cells: the bytes that changed, to be copied into the guest's memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changed {
    pub start: usize,
    pub end: usize,
    /// The power failed during this operation.
    pub cut: bool,
}

#[derive(Debug)]
pub struct FlashArray {
    bytes: Vec<u8>,
    operations: u64,
    erases: u64,
    cut_at: Option<u64>,
    dead: bool,
}

impl FlashArray {
    /// An array holding `image` from its start and erased cells after it.
    #[must_use]
    pub fn holding(image: &[u8]) -> Self {
        let mut bytes = image[..image.len().min(FLASH_BYTES)].to_vec();
        bytes.resize(FLASH_BYTES, 0xFF);
        Self { bytes, operations: 0, erases: 0, cut_at: None, dead: false }
    }

    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }

    /// Program and erase operations since the array was made.
    #[must_use]
    pub fn operations(&self) -> u64 {
        self.operations
    }

    #[must_use]
    pub fn erases(&self) -> u64 {
        self.erases
    }

    /// Has the power fail during the operation after `further` more have completed.
    pub fn cut_after(&mut self, further: u64) {
        self.cut_at = Some(self.operations + further);
    }

    pub fn cancel_cut(&mut self) {
        self.cut_at = None;
    }

    /// Whether the power has failed; nothing changes the cells until [`FlashArray::power_on`].
    #[must_use]
    pub fn dead(&self) -> bool {
        self.dead
    }

    pub fn power_on(&mut self) {
        self.dead = false;
    }

    fn begin(&mut self) -> bool {
        let cut = self.cut_at == Some(self.operations);
        self.operations += 1;
        if cut {
            self.cut_at = None;
            self.dead = true;
        }
        cut
    }

    /// Programs `value` little-endian over `bytes` cells from `offset`: bits only go from one to zero. A cut
    /// leaves a pseudo-random part of the wanted zeros unprogrammed.
    pub fn program(&mut self, offset: usize, bytes: usize, value: u64) -> Option<Changed> {
        if self.dead {
            return None;
        }
        let cut = self.begin();
        let survives = if cut { scramble(self.operations ^ (offset as u64)) } else { 0 };
        for (index, cell) in self.bytes[offset..offset + bytes].iter_mut().enumerate() {
            let wanted = (value >> (8 * index)) as u8;
            let left = (survives >> (8 * index)) as u8;
            *cell &= wanted | left;
        }
        Some(Changed { start: offset, end: offset + bytes, cut })
    }

    /// Erases a sector. A cut leaves its first part erased, then cells whose bits are a mixture of what was
    /// there and ones, then the rest as it was.
    pub fn erase(&mut self, sector: usize) -> Option<Changed> {
        if self.dead {
            return None;
        }
        let start = sector_start(sector)?;
        let size = SECTOR_BYTES[sector];
        let cut = self.begin();
        self.erases += 1;
        let seed = scramble(self.operations);
        let (erased, mixed) = if cut {
            let erased = usize::try_from(seed % (size as u64)).expect("below the sector's size");
            (erased, (erased + 256).min(size))
        } else {
            (size, size)
        };
        self.bytes[start..start + erased].fill(0xFF);
        for index in erased..mixed {
            self.bytes[start + index] |= scramble(seed ^ index as u64) as u8;
        }
        Some(Changed { start, end: start + mixed, cut })
    }
}

/// A fixed mixing of 64 bits (the finaliser of splitmix64), so that a cut is repeatable.
fn scramble(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programming_clears_bits_and_never_sets_them() {
        let mut array = FlashArray::holding(&[]);
        array.program(8, 4, 0xFFFF_0F0F).expect("powered");
        array.program(8, 4, 0x00FF_FFF0).expect("powered");
        assert_eq!(array.bytes()[8..12], [0x00, 0x0F, 0xFF, 0x00]);
    }

    #[test]
    fn an_erase_sets_exactly_its_own_sector() {
        let mut array = FlashArray::holding(&vec![0; FLASH_BYTES]);
        array.erase(6).expect("powered");
        let start = sector_start(6).expect("a sector");
        assert_eq!(start, 0x4_0000);
        assert!(array.bytes()[start..start + 0x2_0000].iter().all(|cell| *cell == 0xFF));
        assert_eq!((array.bytes()[start - 1], array.bytes()[start + 0x2_0000]), (0, 0));
    }

    #[test]
    fn a_cut_erase_leaves_a_sector_in_three_parts_and_the_array_dead() {
        let mut array = FlashArray::holding(&vec![0; FLASH_BYTES]);
        array.cut_after(1);
        array.program(0x6_0000, 4, 0).expect("the operation before the cut");
        let changed = array.erase(6).expect("the cut one");
        assert!(changed.cut && array.dead());
        let sector = &array.bytes()[0x4_0000..0x6_0000];
        let erased = sector.iter().take_while(|cell| **cell == 0xFF).count();
        assert!(erased < sector.len(), "not all of it");
        assert_eq!(sector.last(), Some(&0), "the end was not reached");
        assert_eq!(array.program(0, 4, 0), None, "no power, no programming");
        array.power_on();
        assert!(array.program(0, 4, 0).is_some());
    }

    #[test]
    fn a_cut_program_leaves_some_of_the_wanted_zeros() {
        let mut array = FlashArray::holding(&[]);
        array.cut_after(0);
        array.program(0x4_0000, 4, 0).expect("the cut one");
        let word = u32::from_le_bytes(array.bytes()[0x4_0000..0x4_0004].try_into().expect("four bytes"));
        assert!(word != 0 && word != u32::MAX, "partly written: {word:#x}");
    }
}
