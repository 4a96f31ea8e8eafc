//! EXTI and SYSCFG, which rigless does not model: edges on port pins become latched interrupt requests.
//!
//! A port announces each pin's level as its request line; the controller, which hears every port, looks up in
//! SYSCFG's routing which port owns the line and detects the edge. `PR` latches whether or not the line is
//! masked (RM0383 figure 30: the mask comes after the pending register), and is cleared by writing one.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex};

use rigless::device::{Device, DeviceContext, Level, RegisterFile, RequestChange};
use rigless::soc::stm32f427::generated::{exti, syscfg};

use crate::memory_map::PORTS;

const LINES: usize = 16;
/// `EXTICR` codes of [`PORTS`]: A to E are 0 to 4 and H is 7.
const PORT_CODES: [u8; PORTS.len()] = [0, 1, 2, 3, 4, 7];

/// Which port each line listens to, as SYSCFG holds it and EXTI reads it.
pub type Routing = Arc<[AtomicU8; LINES]>;

/// SYSCFG: stores, and keeps [`Routing`] in step with `EXTICR1` to `EXTICR4`.
#[derive(Debug, Default)]
pub struct Syscfg {
    routing: Routing,
}

impl Syscfg {
    #[must_use]
    pub fn routing(&self) -> Routing {
        Arc::clone(&self.routing)
    }
}

impl Device for Syscfg {
    type Register = syscfg::Register;

    fn write(
        &mut self,
        register: syscfg::Register,
        _value: u64,
        registers: &mut RegisterFile,
        _context: &mut DeviceContext<'_>,
    ) {
        use syscfg::Register::{Exticr1, Exticr2, Exticr3, Exticr4};
        let Some(group) = [Exticr1, Exticr2, Exticr3, Exticr4].into_iter().position(|row| row == register) else {
            return;
        };
        let value = registers.get(register);
        for place in 0..4 {
            let code = u8::try_from((value >> (4 * place)) & 0xF).expect("four bits");
            self.routing[4 * group + place].store(code, Ordering::Relaxed);
        }
    }

    fn reset(&mut self) {
        for line in self.routing.iter() {
            line.store(0, Ordering::Relaxed);
        }
    }
}

/// One change of the LED, for whoever counts blinks: when, and whether it is lit from then on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LedChange {
    pub t_ns: u64,
    pub lit: bool,
}

/// The LED's history. It is kept here because this is the one model that hears every pin.
pub type LedLog = Arc<Mutex<Vec<LedChange>>>;

#[derive(Debug)]
pub struct Exti {
    routing: Routing,
    led: LedLog,
    levels: [[Level; LINES]; PORTS.len()],
    driven: [Level; GROUPS.len()],
}

/// The lines behind each interrupt of the instance, by position in its table (position 0 is the tamper line's).
const GROUPS: [(usize, u64); 7] =
    [(1, 1 << 0), (2, 1 << 1), (3, 1 << 2), (4, 1 << 3), (5, 1 << 4), (6, 0x03E0), (7, 0xFC00)];

impl Exti {
    #[must_use]
    pub fn new(routing: Routing, led: LedLog) -> Self {
        Self { routing, led, levels: [[Level::Low; LINES]; PORTS.len()], driven: [Level::Low; GROUPS.len()] }
    }

    fn latch(&mut self, bits: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        let pending = registers.get(exti::Register::Pr) | bits;
        registers.set(exti::Register::Pr, pending);
        self.drive(registers, context);
    }

    /// Puts each interrupt at the level its unmasked pending lines ask for.
    fn drive(&mut self, registers: &RegisterFile, context: &mut DeviceContext<'_>) {
        let active = registers.get(exti::Register::Pr) & registers.get(exti::Register::Imr);
        for (driven, (position, lines)) in self.driven.iter_mut().zip(GROUPS) {
            let wanted = Level::from(active & lines != 0);
            if *driven != wanted {
                *driven = wanted;
                context.interrupt(position, wanted);
            }
        }
    }

    fn observe_led(&self, request: &RequestChange, t_ns: u64) {
        if request.instance == "GPIOC" && request.request == 13 {
            let lit = request.level == Level::Low;
            self.led.lock().expect("no panic holds it").push(LedChange { t_ns, lit });
        }
    }
}

impl Device for Exti {
    type Register = exti::Register;

    fn write(
        &mut self,
        register: exti::Register,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        match register {
            // A software interrupt is a request for the lines that are not masked.
            exti::Register::Swier => {
                let bits = value & registers.get(exti::Register::Imr);
                self.latch(bits, registers, context);
            }
            // The bus already cleared what was written as one; the software request goes with it.
            exti::Register::Pr => {
                let soft = registers.get(exti::Register::Swier) & !value;
                registers.set(exti::Register::Swier, soft);
                self.drive(registers, context);
            }
            exti::Register::Imr => self.drive(registers, context),
            _ => {}
        }
    }

    fn on_request(&mut self, change: RequestChange, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        let Some(port) = PORTS.iter().position(|name| *name == change.instance) else {
            return;
        };
        self.observe_led(&change, context.now().0);
        let before = std::mem::replace(&mut self.levels[port][change.request], change.level);
        let routed = self.routing[change.request].load(Ordering::Relaxed) == PORT_CODES[port];
        if before == change.level || !routed {
            return;
        }
        let edges = match change.level {
            Level::High => exti::Register::Rtsr,
            Level::Low => exti::Register::Ftsr,
        };
        let bit = registers.get(edges) & (1 << change.request);
        if bit != 0 {
            self.latch(bit, registers, context);
        }
    }

    fn reset(&mut self) {
        self.driven = [Level::Low; GROUPS.len()];
    }
}
