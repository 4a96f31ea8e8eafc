//! A flash whose power can be cut at any word, with what a cut does to a cell: nothing, half, or all of it.

use embedded_storage_async::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};

pub const WORD: usize = 4;
pub const SECTOR: usize = 2048;
pub const SECTORS: usize = 2;

/// What the cut operation leaves behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Torn {
    /// It had not begun.
    Not,
    /// Half of the bits of a word; the first half of an erased sector.
    Half,
    /// Other bits of a word; the second half of an erased sector.
    OtherHalf,
    /// Each word of an erased sector is somewhere between: every third is erased, the rest is not.
    Speckled,
    /// An erased sector keeps its first and last word and loses all between; the opposite of a word.
    Middle,
    /// An erased sector keeps its first part and its last word: its newest items are gone and its marks stand.
    Newest,
    /// It was done, but nobody was told.
    Done,
}

pub const ALL_TORN: [Torn; 7] =
    [Torn::Not, Torn::Half, Torn::OtherHalf, Torn::Speckled, Torn::Middle, Torn::Newest, Torn::Done];

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// The power went.
    PowerCut,
    /// A cell does not take its value.
    Worn,
}

impl NorFlashError for Fault {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

#[derive(Clone)]
pub struct FlashDouble {
    bytes: Vec<u8>,
    /// Words programmed and sectors erased so far.
    pub operations: usize,
    /// The operation at which the power goes, and how.
    pub cut: Option<(usize, Torn)>,
    /// Every programming from this operation on fails, the power stays.
    pub worn_from: Option<usize>,
    dead: bool,
    pub erases: usize,
}

impl FlashDouble {
    pub fn new() -> Self {
        let bytes = vec![0xFF; SECTOR * SECTORS];
        Self { bytes, operations: 0, cut: None, worn_from: None, dead: false, erases: 0 }
    }

    pub fn filled_with(pattern: impl Fn(usize) -> u8) -> Self {
        Self { bytes: (0..SECTOR * SECTORS).map(pattern).collect(), ..Self::new() }
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// After the cut: the same cells, counting afresh.
    pub fn power_on(self) -> Self {
        Self { operations: 0, cut: None, dead: false, erases: 0, ..self }
    }

    /// Counts an operation and says how it is torn, if it is.
    fn operate(&mut self) -> Result<Option<Torn>, Fault> {
        if self.dead {
            return Err(Fault::PowerCut);
        }
        let at = self.operations;
        self.operations += 1;
        if self.worn_from.is_some_and(|from| at >= from) {
            return Err(Fault::Worn);
        }
        Ok(self.cut.filter(|(cut, _)| *cut == at).map(|(_, torn)| {
            self.dead = true;
            torn
        }))
    }
}

impl ErrorType for FlashDouble {
    type Error = Fault;
}

impl ReadNorFlash for FlashDouble {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Fault> {
        if self.dead {
            return Err(Fault::PowerCut);
        }
        let at = offset as usize;
        bytes.copy_from_slice(&self.bytes[at..at + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for FlashDouble {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Fault> {
        assert!(from.is_multiple_of(SECTOR as u32) && to.is_multiple_of(SECTOR as u32));
        for start in (from as usize..to as usize).step_by(SECTOR) {
            let torn = self.operate()?;
            self.erases += 1;
            let sector = &mut self.bytes[start..start + SECTOR];
            match torn {
                None | Some(Torn::Done) => sector.fill(0xFF),
                Some(Torn::Not) => {}
                Some(Torn::Half) => sector[..SECTOR / 2].fill(0xFF),
                Some(Torn::OtherHalf) => sector[SECTOR / 2..].fill(0xFF),
                Some(Torn::Middle) => sector[WORD..SECTOR - WORD].fill(0xFF),
                Some(Torn::Newest) => sector[SECTOR / 3..SECTOR - WORD].fill(0xFF),
                Some(Torn::Speckled) => sector.chunks_mut(WORD).step_by(3).for_each(|word| word.fill(0xFF)),
            }
            if torn.is_some() {
                return Err(Fault::PowerCut);
            }
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Fault> {
        assert!((offset as usize).is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD));
        for (i, word) in bytes.chunks(WORD).enumerate() {
            let torn = self.operate()?;
            let mask = match torn {
                None | Some(Torn::Done) => 0x00,
                Some(Torn::Not) => 0xFF,
                Some(Torn::Half) => 0x0F,
                Some(Torn::OtherHalf) => 0xF0,
                Some(Torn::Speckled) => 0x55,
                Some(Torn::Middle) => 0xAA,
                Some(Torn::Newest) => 0xFE,
            };
            let at = offset as usize + i * WORD;
            for (cell, byte) in self.bytes[at..at + WORD].iter_mut().zip(word) {
                // Programming only ever clears bits; those under the mask were not reached.
                *cell &= byte | mask;
            }
            if torn.is_some() {
                return Err(Fault::PowerCut);
            }
        }
        Ok(())
    }
}
