//! The flash interface: keys, sector erase, programming, their errors, and the core standing still meanwhile.
//!
//! RM0383 section 3.5 to 3.8. The firmware runs from the one bank this part has, so the core's next fetch waits
//! until an erase or program ends and no interrupt is taken before; [`crate::stall`] carries that out.

use std::sync::{Arc, Mutex, MutexGuard};

use rigless::device::{Device, DeviceContext, Level, RegisterFile};
use rigless::soc::Width;
use rigless::soc::stm32f427::generated::flash::Register;
use rigless::time::{EventId, VirtualNanos};

use crate::flash_array::{Changed, FlashArray, FlashTiming};
use crate::memory_map::{FLASH_BASE, SECTOR_BYTES};
use crate::stall::SharedCore;

pub type SharedFlash = Arc<Mutex<FlashArray>>;

const KEYS: [u64; 2] = [0x4567_0123, 0xCDEF_89AB];

const CR_PG: u64 = 1 << 0;
const CR_SER: u64 = 1 << 1;
const CR_MER: u64 = 1 << 2;
const CR_STRT: u64 = 1 << 16;
const CR_EOPIE: u64 = 1 << 24;
const CR_ERRIE: u64 = 1 << 25;
const CR_LOCK: u64 = 1 << 31;

pub const SR_EOP: u64 = 1 << 0;
pub const SR_OPERR: u64 = 1 << 1;
pub const SR_WRPERR: u64 = 1 << 4;
pub const SR_PGAERR: u64 = 1 << 5;
pub const SR_PGPERR: u64 = 1 << 6;
pub const SR_PGSERR: u64 = 1 << 7;
pub const SR_BSY: u64 = 1 << 16;
const SR_CLEARABLE: u64 = SR_EOP | SR_OPERR | SR_WRPERR | SR_PGAERR | SR_PGPERR | SR_PGSERR;

/// The interface's interrupt, the only one in its table.
const GLOBAL: usize = 0;

#[derive(Debug)]
pub struct Flash {
    array: SharedFlash,
    core: SharedCore,
    timing: FlashTiming,
    /// How many of [`KEYS`] have come in order; a wrong one locks until reset.
    keys: usize,
    locked_until_reset: bool,
    cr: u64,
    sr: u64,
    end: Option<EventId>,
    driven: Level,
}

impl Flash {
    #[must_use]
    pub fn new(array: SharedFlash, core: SharedCore, timing: FlashTiming) -> Self {
        Self {
            array,
            core,
            timing,
            keys: 0,
            locked_until_reset: false,
            cr: CR_LOCK,
            sr: 0,
            end: None,
            driven: Level::Low,
        }
    }

    fn cells(&self) -> MutexGuard<'_, FlashArray> {
        self.array.lock().expect("no panic holds it")
    }

    fn take_key(&mut self, key: u64) {
        if self.locked_until_reset || self.cr & CR_LOCK == 0 {
            return;
        }
        if key != KEYS[self.keys] {
            self.locked_until_reset = true;
        } else if self.keys == 1 {
            self.keys = 0;
            self.cr &= !CR_LOCK;
        } else {
            self.keys = 1;
        }
    }

    fn write_control(&mut self, value: u64, context: &mut DeviceContext<'_>) {
        if self.cr & CR_LOCK != 0 {
            return;
        }
        if value & CR_LOCK != 0 {
            self.cr |= CR_LOCK;
            return;
        }
        self.cr = value & !CR_STRT;
        if value & CR_STRT != 0 {
            self.start_erase(context);
        }
    }

    fn start_erase(&mut self, context: &mut DeviceContext<'_>) {
        let parallelism = usize::try_from((self.cr >> 8) & 3).expect("two bits");
        let number = usize::try_from((self.cr >> 3) & 0xF).expect("four bits");
        let sectors = match (self.cr & CR_MER != 0, self.cr & CR_SER != 0) {
            (true, _) => 0..SECTOR_BYTES.len(),
            (false, true) if number < SECTOR_BYTES.len() => number..number + 1,
            (false, true) => return self.fail(SR_WRPERR),
            (false, false) => return,
        };
        let mut took = 0;
        for sector in sectors {
            took += self.timing.erase_ns(sector, parallelism);
            let changed = self.cells().erase(sector);
            self.carry_out(changed, context);
        }
        self.cr |= CR_STRT;
        self.occupy(took, context);
    }

    /// Copies changed cells into the guest's memory.
    fn carry_out(&self, changed: Option<Changed>, context: &mut DeviceContext<'_>) {
        let Some(Changed { start, end, .. }) = changed else {
            return;
        };
        let cells = self.cells();
        for offset in (start & !7..end).step_by(8) {
            let word: [u8; 8] = cells.bytes()[offset..offset + 8].try_into().expect("eight cells");
            context.program(FLASH_BASE + offset as u64, Width::W64, u64::from_le_bytes(word), 0);
        }
    }

    /// Busy, with the core standing still, for `nanos`.
    fn occupy(&mut self, nanos: u64, context: &mut DeviceContext<'_>) {
        self.sr |= SR_BSY;
        self.core.stall(true);
        let now = context.now();
        // A stop at this same instant takes the core back from the stretch of instructions it is in.
        context.schedule(now);
        if !self.cells().dead() {
            self.end = Some(context.schedule(VirtualNanos(now.0 + nanos.max(1))));
        }
    }

    fn fail(&mut self, flag: u64) {
        self.sr |= flag;
        if self.cr & CR_ERRIE != 0 {
            self.sr |= SR_OPERR;
        }
    }

    fn refusal(&self, address: u64, width: Width) -> Option<u64> {
        let bytes = u64::from(width.bytes());
        let parallelism = 1 << ((self.cr >> 8) & 3);
        if self.cr & CR_PG == 0 || self.cr & (CR_SER | CR_MER) != 0 || self.sr & SR_BSY != 0 {
            Some(SR_PGSERR)
        } else if bytes != parallelism {
            Some(SR_PGPERR)
        } else if address % 16 + bytes > 16 || !address.is_multiple_of(bytes) {
            Some(SR_PGAERR)
        } else {
            None
        }
    }

    /// Shows the firmware the state, and drives the interrupt it asks for.
    fn publish(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        registers.set(Register::Cr, self.cr);
        registers.set(Register::Sr, self.sr);
        let ended = self.sr & SR_EOP != 0 && self.cr & CR_EOPIE != 0;
        let failed = self.sr & SR_OPERR != 0 && self.cr & CR_ERRIE != 0;
        let wanted = Level::from(ended || failed);
        if wanted != self.driven {
            self.driven = wanted;
            context.interrupt(GLOBAL, wanted);
        }
    }
}

impl Device for Flash {
    type Register = Register;

    fn read(
        &mut self,
        register: Register,
        _registers: &mut RegisterFile,
        _context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        // The key registers read zero; the generated table has no opinion.
        matches!(register, Register::Keyr | Register::Optkeyr).then_some(0)
    }

    fn write(&mut self, register: Register, value: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        match register {
            Register::Keyr => self.take_key(value),
            Register::Cr => self.write_control(value, context),
            Register::Sr => self.sr &= !(value & SR_CLEARABLE),
            _ => return,
        }
        self.publish(registers, context);
    }

    fn write_region(
        &mut self,
        address: u64,
        width: Width,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> bool {
        if let Some(flag) = self.refusal(address, width) {
            self.fail(flag);
        } else {
            let offset = usize::try_from(address - FLASH_BASE).expect("inside the flash");
            let changed = self.cells().program(offset, width.bytes() as usize, value);
            self.carry_out(changed, context);
            self.occupy(self.timing.program_ns, context);
        }
        self.publish(registers, context);
        true
    }

    fn on_event(&mut self, event: EventId, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if self.end != Some(event) {
            return;
        }
        self.end = None;
        self.sr &= !SR_BSY;
        self.cr &= !CR_STRT;
        if self.cr & CR_EOPIE != 0 {
            self.sr |= SR_EOP;
        }
        self.core.stall(false);
        self.publish(registers, context);
    }
}
