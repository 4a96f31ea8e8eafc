//! After a cut: which of the two sectors counts.
//!
//! The log erases a sector only after copying what counts from it to the other one. A cut erase may leave anything of
//! the old sector: its marks, some items, half-erased cells. The log's own repair trusts the marks; left alone it would
//! then read an old record, or copy from the torn sector over the good one (our sweep of power cuts found both). So
//! before the log looks, the sector that does not count is erased again. Which one that is, the items' numbers tell.

use embedded_storage_async::nor_flash::NorFlash;

use super::view::View;
use super::{Failure, HEADER, Map, fetch};

/// What a sector looks like. The log marks its first word when it begins to use a sector and its last when it is full.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Look {
    /// Erased, but for perhaps a first mark that was cut.
    Blank,
    /// In use.
    Open,
    /// Full.
    Full,
    /// Anything else.
    Odd,
}

/// Where the newest item of a sector is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Newest {
    number: u32,
    /// It is the first of its sector, as one that was just copied is. Of two equal items this one counts: its sector is
    /// the fresh one.
    first: bool,
}

/// Brings the sectors into a state that the log itself makes, which is nearly always the case already.
pub async fn recover<F: NorFlash>(flash: &mut F, buffer: &mut [u8]) -> Result<(), Failure> {
    let looks = [look(flash, 0, buffer).await?, look(flash, 1, buffer).await?];
    let at_most_one_in_use = looks.contains(&Look::Blank) && !looks.contains(&Look::Odd);
    if at_most_one_in_use {
        return Ok(());
    }
    let newest = [newest(flash, 0, buffer).await, newest(flash, 1, buffer).await];
    if newest == [None, None] {
        return Err(Failure::Foreign);
    }
    let stale = u32::from(newest[0] >= newest[1]);
    let (start, end) = bounds::<F>(stale);
    flash.erase(start, end).await.map_err(|_| Failure::Flash)
}

fn bounds<F: NorFlash>(sector: u32) -> (u32, u32) {
    let size = F::ERASE_SIZE as u32;
    (sector * size, (sector + 1) * size)
}

/// Where the first item of a sector ends: the mark, the log's header, key, number, record, padding.
fn first_item_end<F: NorFlash>(record: usize) -> u32 {
    let data = (1 + HEADER + record).next_multiple_of(F::WRITE_SIZE);
    F::WRITE_SIZE as u32 + Map::<F>::item_overhead_size() + data as u32
}

async fn look<F: NorFlash>(flash: &mut F, sector: u32, buffer: &mut [u8]) -> Result<Look, Failure> {
    /// Cleared bits of a mark's byte from which the log takes it for set.
    const MARKED: u32 = 4;
    let (start, end) = bounds::<F>(sector);
    let word = F::WRITE_SIZE as u32;
    let (mut blank, mut first, mut last) = (true, 0xFF, 0xFF);
    let mut at = start;
    while at < end {
        let length = ((end - at) as usize).min(buffer.len() / F::WRITE_SIZE * F::WRITE_SIZE);
        let chunk = &mut buffer[..length];
        flash.read(at, chunk).await.map_err(|_| Failure::Flash)?;
        if at == start {
            first = chunk[0];
            chunk[..word as usize].fill(0xFF);
        }
        last = chunk[length - 1];
        blank &= chunk.iter().all(|&byte| byte == 0xFF);
        at += length as u32;
    }
    Ok(match (first.count_zeros() >= MARKED, last.count_zeros() >= MARKED) {
        (false, _) if blank => Look::Blank,
        (true, false) => Look::Open,
        (true, true) => Look::Full,
        _ => Look::Odd,
    })
}

/// The newest whole item of one sector, looked at alone. What cannot be read is none.
async fn newest<F: NorFlash>(flash: &mut F, sector: u32, buffer: &mut [u8]) -> Option<Newest> {
    let (start, end) = bounds::<F>(sector);
    let item = fetch(View { flash, visible: start..end }, buffer).await.ok()??;
    let (number, length) = (item.number, item.record.map_or(0, <[u8]>::len));
    let first_slot = start..start + first_item_end::<F>(length);
    let alone = fetch(View { flash, visible: first_slot }, buffer).await.ok().flatten();
    Some(Newest { number, first: alone.is_some_and(|item| item.number == number) })
}
