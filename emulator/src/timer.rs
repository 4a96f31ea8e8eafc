//! A general-purpose timer whose stopped counter matches nothing.
//!
//! rigless's timer sets a compare flag when `CNT` is written, or re-initialised by `UG`, to the compare value
//! while the counter stands still. embassy's time driver writes `CNT = 0` before it writes `CCR1`, so it would
//! take an interrupt for a half period that never passed: its count of half periods would be one too high for
//! ever, and an alarm due more than 16 ms into a half period would ring 65 ms late. On the part the comparison
//! is clocked by the counter, and embassy's alarms ring on time.

use rigless::device::{Device, DeviceContext, RegisterFile, RequestChange};
use rigless::soc::stm32f427::peripherals::tim::{Counter, General, Tim};
use rigless::soc::{Layout, RegisterSpec};
use rigless::time::{EventId, VirtualNanos};

type Row = <Tim<General> as Device>::Register;

/// `CC1IF` to `CC4IF`, and their places in `EGR`.
const COMPARE_FLAGS: u64 = 0x1E;
const ENABLED: u64 = 1;

#[derive(Debug)]
pub struct Timer {
    inner: Tim<General>,
    control: Row,
    status: Row,
    generation: Row,
}

fn row(name: &str) -> Row {
    let index = <Row as Layout>::REGISTERS.iter().position(|register| register.name == name);
    index.and_then(Row::from_index).expect("every timer has it")
}

impl Timer {
    #[must_use]
    pub fn with_clock(clock_hz: u64, counter: Counter) -> Self {
        Self {
            inner: Tim::with_clock(clock_hz, counter),
            control: row("CR1"),
            status: row("SR"),
            generation: row("EGR"),
        }
    }
}

impl Device for Timer {
    type Register = Row;

    fn layout(&self) -> &'static [RegisterSpec] {
        Device::layout(&self.inner)
    }

    fn read(&mut self, register: Row, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) -> Option<u64> {
        self.inner.read(register, registers, context)
    }

    fn peek(&self, register: Row, registers: &RegisterFile, now: VirtualNanos) -> Option<u64> {
        Device::peek(&self.inner, register, registers, now)
    }

    fn write(&mut self, register: Row, value: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        let stopped = registers.get(self.control) & ENABLED == 0;
        let before = registers.get(self.status);
        self.inner.write(register, value, registers, context);
        if !stopped || register == self.status {
            return;
        }
        let asked = if register == self.generation { value } else { 0 };
        let spurious = registers.get(self.status) & !before & !asked & COMPARE_FLAGS;
        if spurious != 0 {
            // As the firmware clears a flag: the bus stores the cleared value, then the model hears the write.
            let kept = registers.get(self.status) & !spurious;
            registers.set(self.status, kept);
            self.inner.write(self.status, !spurious & 0xFFFF, registers, context);
        }
    }

    fn on_event(&mut self, event: EventId, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.inner.on_event(event, registers, context);
    }

    fn on_request(&mut self, change: RequestChange, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.inner.on_request(change, registers, context);
    }

    fn on_clock(&mut self, hz: u64, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.inner.on_clock(hz, registers, context);
    }

    fn reset(&mut self) {
        Device::reset(&mut self.inner);
    }

    fn reset_line(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.inner.reset_line(registers, context);
    }
}
