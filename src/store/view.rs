//! A flash of which only a part is seen, and nothing can be changed: the rest reads as erased.

use core::ops::Range;

use embedded_storage_async::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};

/// `visible` of `flash`, at its own addresses.
pub struct View<'a, F> {
    pub flash: &'a mut F,
    pub visible: Range<u32>,
}

#[derive(Debug)]
pub enum ViewError {
    /// What is only looked at is not changed.
    ReadOnly,
    /// The flash itself.
    Flash,
}

impl NorFlashError for ViewError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl<F> ErrorType for View<'_, F> {
    type Error = ViewError;
}

impl<F: NorFlash> ReadNorFlash for View<'_, F> {
    const READ_SIZE: usize = F::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), ViewError> {
        self.flash.read(offset, bytes).await.map_err(|_| ViewError::Flash)?;
        for (address, byte) in (offset..).zip(bytes) {
            if !self.visible.contains(&address) {
                *byte = 0xFF;
            }
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.flash.capacity()
    }
}

impl<F: NorFlash> NorFlash for View<'_, F> {
    const WRITE_SIZE: usize = F::WRITE_SIZE;
    const ERASE_SIZE: usize = F::ERASE_SIZE;

    async fn erase(&mut self, _: u32, _: u32) -> Result<(), ViewError> {
        Err(ViewError::ReadOnly)
    }

    async fn write(&mut self, _: u32, _: &[u8]) -> Result<(), ViewError> {
        Err(ViewError::ReadOnly)
    }
}
