//! Looking inside a stopped board: memory, symbols, exact instruction counts, resets, and what the firmware
//! reached that the emulator does not have.

use std::sync::atomic::Ordering;

use rigless::emulator::{Host, Watch};
use rigless::soc::Width;

use crate::board::{Board, BoardError, Stopped};
use crate::memory_map::{RAM_BASE, RAM_BYTES};

/// An arrival at a watched instruction, before it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    pub address: u64,
    pub t_s: f64,
    /// Instructions retired since the present power-on.
    pub instructions: u64,
}

/// Unused stack is painted with this word at power-on.
const PAINT: u32 = 0xC0DE_57AC;

fn read_bytes(host: &mut dyn Host, address: u64, length: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(length + 4);
    let mut at = address & !3;
    while at < address + length as u64 {
        let word = host.read(at, Width::W32).ok()?;
        bytes.extend((word as u32).to_le_bytes());
        at += 4;
    }
    let skip = (address & 3) as usize;
    Some(bytes[skip..skip + length].to_vec())
}

impl Board {
    /// `length` bytes of RAM or flash at `address`.
    #[must_use]
    pub fn read_memory(&self, address: u64, length: usize) -> Option<Vec<u8>> {
        self.run.as_ref()?.at_stop(move |_, host| read_bytes(host, address, length))?
    }

    /// Writes words to RAM. Answers whether they landed.
    pub fn write_memory(&mut self, address: u64, words: Vec<u32>) -> bool {
        let write = move |host: &mut dyn Host| {
            (address..).step_by(4).zip(words).all(|(at, word)| host.write(at, Width::W32, u64::from(word)).is_ok())
        };
        let run = self.run.as_ref();
        run.and_then(|run| run.at_stop(move |_, host| write(host))).unwrap_or(false)
    }

    /// The address of a symbol of the firmware, as `nm` prints its name; of a function, its first instruction.
    pub fn symbol(&self, name: &str) -> Result<u64, BoardError> {
        self.symbols.get(name).map_err(|error| BoardError(error.to_string()))
    }

    /// Notes every arrival at a function from now until the next power-on.
    pub fn watch_function(&mut self, name: &str) -> Result<u64, BoardError> {
        let address = self.symbol(name)?;
        self.watch(address);
        Ok(address)
    }

    /// Notes every arrival at the instruction at `address` from now until the next power-on.
    pub fn watch(&mut self, address: u64) {
        if let Some(run) = &self.run {
            run.at_stop(move |session, _| session.watch(Watch::Instruction(address)));
        }
    }

    /// The arrivals since the last call, in order. The difference of two instruction counts is exact.
    pub fn take_arrivals(&mut self) -> Vec<Arrival> {
        let hits = std::mem::take(&mut *self.shared.hits.lock().expect("no panic holds it"));
        let epoch_s = self.epoch_s;
        let arrival = |hit: rigless::emulator::Hit| Arrival {
            address: hit.address,
            t_s: epoch_s + hit.at.0 as f64 * 1e-9,
            instructions: hit.instruction_count,
        };
        hits.into_iter().map(arrival).collect()
    }

    /// Runs to the next arrival at a watched instruction, or to board time `t_s` if none comes.
    pub fn run_to_arrival(&mut self, t_s: f64) -> Result<Stopped, BoardError> {
        self.shared.stop_at_hits.store(true, Ordering::Relaxed);
        let stopped = self.run_until(t_s);
        self.shared.stop_at_hits.store(false, Ordering::Relaxed);
        stopped
    }

    fn stack(&self) -> Option<(u64, u64)> {
        let ram = RAM_BASE..=RAM_BASE + RAM_BYTES as u64;
        let end = ["_stack_end", "__euninit", "__ebss"].iter().find_map(|name| self.symbols.get(name).ok())?;
        let start = self.symbols.get("_stack_start").ok()?;
        (ram.contains(&end) && ram.contains(&start) && end < start).then_some(((end + 3) & !3, start))
    }

    pub(crate) fn paint_stack(&mut self) {
        if let Some((end, start)) = self.stack() {
            let words = vec![PAINT; ((start - end) / 4) as usize];
            self.write_memory(end, words);
        }
    }

    /// The most bytes of stack in use at once since power-on, and how many there are, where the firmware has
    /// cortex-m-rt's symbols.
    #[must_use]
    pub fn stack_high_water(&self) -> Option<(usize, usize)> {
        let (end, start) = self.stack()?;
        let size = (start - end) as usize;
        let bytes = self.read_memory(end, size)?;
        let untouched = bytes.chunks_exact(4).take_while(|word| *word == PAINT.to_le_bytes()).count() * 4;
        Some((size - untouched, size))
    }

    /// Where the core is: the next instruction's address, or `None` once it has locked up in a fault.
    #[must_use]
    pub fn pc(&self) -> Option<u64> {
        (!self.around.core.locked_up()).then(|| self.around.core.pc())
    }

    /// Every restart since power-on: board time, and `Core`, `Model("IWDG")` or `Pin`.
    #[must_use]
    pub fn resets(&self) -> Vec<(f64, String)> {
        let epoch_s = self.epoch_s;
        let list = self.run.as_ref().and_then(|run| {
            run.at_stop(move |session, _| {
                let reset = |reset: &rigless::session::Reset| {
                    (epoch_s + reset.at.0 as f64 * 1e-9, format!("{:?}", reset.cause))
                };
                session.resets().iter().map(reset).collect()
            })
        });
        list.unwrap_or_default()
    }

    /// What the firmware reached that this board does not have, one line each: unmapped addresses, refused
    /// accesses, registers no model answers for, and what a model holds against the firmware.
    #[must_use]
    pub fn gaps(&self) -> Vec<String> {
        let list = self.run.as_ref().and_then(|run| {
            run.at_stop(|session, _| {
                let mut gaps: Vec<String> = session.unmapped().iter().map(|gap| format!("{gap:?}")).collect();
                gaps.extend(session.refused().iter().map(|(at, fault)| format!("refused {at:#x}: {fault}")));
                gaps.extend(session.unimplemented().values().map(|gap| format!("{gap:?}")));
                gaps.extend(session.told().map(|told| format!("{told:?}")));
                gaps
            })
        });
        list.unwrap_or_default()
    }
}
