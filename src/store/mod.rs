//! One record in flash that survives a power cut at any moment, and a newer firmware.
//!
//! A log of items over two sectors (`sequential-storage`): a new record is appended and the old one stays valid until
//! the new one is whole. Only when a sector is full, after some two hundred calibrations, is one erased. Forgetting
//! appends an item too, an empty one: nothing is erased because a person typed a word. What the flash holds and we
//! cannot read is left as it is and told.
//!
//! [`recovery`] adds what the log does not do: it survives a sector erase that was cut, whatever that leaves behind.

mod recovery;
mod view;

use core::ops::Range;

use embedded_storage_async::nor_flash::NorFlash;
use sequential_storage::cache::{Cache, Uncached};
use sequential_storage::map::{MapConfig, MapStorage, SerializationError, Value};

/// The calibration's key. Keys are for ever; 0 is the first.
const CALIBRATION: u8 = 0;
/// The largest record.
pub const RECORD: usize = 384;
/// Number and presence, before a record's bytes.
const HEADER: usize = 5;
/// With the key, and padded to words.
const BUFFER: usize = RECORD + 24;

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The flash refused to erase, program or read.
    Flash,
    /// The sectors hold neither an empty log nor one of ours.
    Foreign,
    /// The record is larger than [`RECORD`].
    TooLarge,
    /// What was read back is not what was written.
    ReadBack,
}

/// Nothing is cached: it is read once at start, and written by hand.
type Map<F> = MapStorage<u8, F, Cache<Uncached, Uncached, Uncached, u8>>;

/// The log over the first two sectors of a flash `F`.
pub struct Store<F: NorFlash> {
    flash: F,
    buffer: [u8; BUFFER],
}

impl<F: NorFlash> Store<F> {
    /// Nothing is read yet.
    pub fn new(flash: F) -> Self {
        Self { flash, buffer: [0; BUFFER] }
    }

    /// The bytes stored last, or none if there never were any or they were forgotten.
    pub async fn load(&mut self) -> Result<Option<&[u8]>, Failure> {
        recovery::recover(&mut self.flash, &mut self.buffer).await?;
        let item = fetch(&mut self.flash, &mut self.buffer).await?;
        Ok(item.and_then(|item| item.record))
    }

    /// Appends `record`, then reads it back and compares. What is foreign is erased, since the person was told of it at
    /// start and asks for this all the same.
    pub async fn save(&mut self, record: &[u8]) -> Result<(), Failure> {
        if record.len() > RECORD {
            return Err(Failure::TooLarge);
        }
        self.append_or_wipe(Some(record)).await?;
        if self.load().await? == Some(record) { Ok(()) } else { Err(Failure::ReadBack) }
    }

    /// Forgets the record, and erases what is foreign.
    pub async fn forget(&mut self) -> Result<(), Failure> {
        self.append_or_wipe(None).await?;
        if self.load().await?.is_none() { Ok(()) } else { Err(Failure::ReadBack) }
    }

    async fn append_or_wipe(&mut self, record: Option<&[u8]>) -> Result<(), Failure> {
        match self.append(record).await {
            Err(Failure::Foreign) => {
                let both = range::<F>();
                self.flash.erase(both.start, both.end).await.map_err(|_| Failure::Flash)?;
                self.append(record).await
            }
            other => other,
        }
    }

    async fn append(&mut self, record: Option<&[u8]>) -> Result<(), Failure> {
        recovery::recover(&mut self.flash, &mut self.buffer).await?;
        let last = fetch(&mut self.flash, &mut self.buffer).await?.map_or(0, |item| item.number);
        let item = Item { number: last.wrapping_add(1), record };
        let stored = map(&mut self.flash)?.store_item(&mut self.buffer, &CALIBRATION, &item).await;
        stored.map_err(|error| failure(&error))
    }

    /// The flash back, for the tests to look into.
    #[cfg(not(target_os = "none"))]
    pub fn release(self) -> F {
        self.flash
    }
}

/// Both sectors.
fn range<F: NorFlash>() -> Range<u32> {
    0..2 * F::ERASE_SIZE as u32
}

fn map<F: NorFlash>(flash: F) -> Result<Map<F>, Failure> {
    let config = MapConfig::try_new(range::<F>()).map_err(|_| Failure::TooLarge)?;
    Ok(MapStorage::new(flash, config, Cache::new_uncached()))
}

/// The item written last.
async fn fetch<F: NorFlash>(flash: F, buffer: &mut [u8]) -> Result<Option<Item<'_>>, Failure> {
    map(flash)?.fetch_item(buffer, &CALIBRATION).await.map_err(|error| failure(&error))
}

/// What is logged: a number that tells which of two sectors has the newer item, and a record or that it is forgotten.
#[derive(Clone, Copy)]
struct Item<'a> {
    number: u32,
    record: Option<&'a [u8]>,
}

impl<'a> Value<'a> for Item<'a> {
    fn serialize_into(&self, buffer: &mut [u8]) -> Result<usize, SerializationError> {
        let record = self.record.unwrap_or(&[]);
        let length = HEADER + record.len();
        let bytes = buffer.get_mut(..length).ok_or(SerializationError::BufferTooSmall)?;
        let (header, body) = bytes.split_at_mut(HEADER);
        header[..4].copy_from_slice(&self.number.to_le_bytes());
        header[4] = u8::from(self.record.is_some());
        body.copy_from_slice(record);
        Ok(length)
    }

    fn deserialize_from(buffer: &'a [u8]) -> Result<(Self, usize), SerializationError> {
        let (header, record) = buffer.split_first_chunk::<HEADER>().ok_or(SerializationError::InvalidFormat)?;
        let [a, b, c, d, present] = *header;
        let number = u32::from_le_bytes([a, b, c, d]);
        Ok((Self { number, record: (present != 0).then_some(record) }, buffer.len()))
    }
}

fn failure<E>(error: &sequential_storage::Error<E>) -> Failure {
    use sequential_storage::Error;
    match error {
        Error::Storage { .. } => Failure::Flash,
        Error::BufferTooBig | Error::BufferTooSmall(_) | Error::ItemTooBig | Error::FullStorage => Failure::TooLarge,
        _ => Failure::Foreign,
    }
}
