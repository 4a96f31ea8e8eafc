//! The board as rigless runs it: the part, and how its core is made.

use std::num::{NonZeroU32, NonZeroU64};

use rigless::machine::armv7m::{Core, Fpu, MpuRegions, Variant};
use rigless::machine::{Board, Target};
use rigless::mcu::Mcu;
use rigless::snapshot::Store;

use crate::memory_map::INTERRUPT_LINES;
use crate::part::Part;
use crate::stall::{SharedCore, stalling};

const MCU: &str = "stm32f411";

#[derive(Debug)]
pub struct BlackPill {
    pub part: Part,
    pub instructions_per_second: NonZeroU64,
    pub core: SharedCore,
}

/// Snapshots are not used here: a run always starts from power-on.
impl Store for BlackPill {}

impl Board for BlackPill {
    fn name(&self) -> &'static str {
        "black-pill"
    }

    fn target_names(&self) -> Vec<&'static str> {
        vec![MCU]
    }

    fn mcu(&mut self, target: usize) -> Option<&mut dyn Mcu> {
        (target == 0).then_some(&mut self.part as &mut dyn Mcu)
    }

    fn targets(&mut self) -> Vec<Target<'_>> {
        let core = Core {
            variant: Variant::M4,
            // SysTick's clock; the product's time driver uses TIM instead.
            clock_hz: NonZeroU64::new(96_000_000).expect("above zero"),
            interrupt_lines: NonZeroU32::new(u32::from(INTERRUPT_LINES)).expect("above zero"),
            priority_bits: 4,
            refclk_divider: NonZeroU32::new(8).expect("above zero"),
            instructions_per_second: self.instructions_per_second,
            boot: "flash",
        };
        let windows = rigless::cpu::armv7m::windows(self.part.bus());
        let mut spec = core.spec_with_parts(&windows, Fpu::FpV4Sp, MpuRegions::Eight);
        spec.processor = stalling(spec.processor, self.core.clone());
        vec![Target::new(MCU, &mut self.part, spec)]
    }
}
