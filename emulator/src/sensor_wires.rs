//! The sensor's wires: SPI1 behind NCS on PA4, and INT on PB0.
//!
//! The chip keeps its own time in port B's slot, because INT ends there: a sample raises the pin at its exact
//! instant. A read that clears the interrupt happens on SPI1; port B hears every request of the part (DMA
//! requests of that read, NCS), and puts the pin where the chip has it each time.

use std::sync::{Arc, Mutex, MutexGuard};

use rigless::chip::Timeline;
use rigless::chip::spi::Peer;
use rigless::device::{Device, DeviceContext, Level, RegisterFile, RequestChange};
use rigless::snapshot::Store;
use rigless::soc::stm32f427::generated::gpioa;
use rigless::soc::stm32f427::peripherals::gpio::{Gpio, Pin};
use rigless::time::{EventId, VirtualNanos};

use crate::mpu9250::Mpu9250;

pub type SharedSensor = Arc<Mutex<Mpu9250>>;

pub const NCS_PIN: u8 = 4;
const INT_PIN: u8 = 0;

fn lock(sensor: &SharedSensor) -> MutexGuard<'_, Mpu9250> {
    sensor.lock().expect("no panic holds it")
}

/// The chip's end of SPI1.
#[derive(Debug)]
pub struct SensorOnSpi(pub SharedSensor);

/// Snapshots are not used here.
impl Store for SensorOnSpi {}

impl Peer for SensorOnSpi {
    fn transfer(&mut self, mosi: u32, _bits: u8, context: &mut Timeline<'_, '_>) -> u32 {
        u32::from(lock(&self.0).transfer(mosi as u8, context.now().0))
    }

    fn select(&mut self, context: &mut Timeline<'_, '_>) {
        lock(&self.0).select(context.now().0);
    }

    fn deselect(&mut self, _context: &mut Timeline<'_, '_>) {
        lock(&self.0).deselect();
    }
}

/// Port B with the chip's INT soldered to pin 0.
#[derive(Debug)]
pub struct PortB {
    pub gpio: Gpio,
    sensor: SharedSensor,
    shown: Option<Level>,
}

impl PortB {
    #[must_use]
    pub fn new(sensor: SharedSensor) -> Self {
        Self { gpio: Gpio::default(), sensor, shown: None }
    }

    /// Puts the pin where the chip has it, and asks to be woken at the chip's next instant.
    pub fn follow(&mut self, registers: &RegisterFile, context: &mut DeviceContext<'_>) {
        self.show(registers, context);
        let now = context.now().0;
        if let Some(next) = lock(&self.sensor).next_event_ns(now) {
            context.schedule(VirtualNanos(next));
        }
    }

    fn show(&mut self, registers: &RegisterFile, context: &mut DeviceContext<'_>) {
        let level = Level::from(lock(&self.sensor).int_high(context.now().0));
        if self.shown != Some(level) {
            self.shown = Some(level);
            let pin = Pin::new(INT_PIN).expect("a port has sixteen pins");
            self.gpio.drive(pin, Some(level), registers, context);
        }
    }
}

impl Device for PortB {
    type Register = gpioa::Register;

    fn read(
        &mut self,
        register: gpioa::Register,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) -> Option<u64> {
        self.show(registers, context);
        self.gpio.read(register, registers, context)
    }

    fn peek(&self, register: gpioa::Register, registers: &RegisterFile, now: VirtualNanos) -> Option<u64> {
        self.gpio.peek(register, registers, now)
    }

    fn write(
        &mut self,
        register: gpioa::Register,
        value: u64,
        registers: &mut RegisterFile,
        context: &mut DeviceContext<'_>,
    ) {
        self.gpio.write(register, value, registers, context);
    }

    fn on_event(&mut self, _event: EventId, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        // The level before the sample first: an edge needs both sides.
        self.show(registers, context);
        lock(&self.sensor).on_event(context.now().0);
        self.follow(registers, context);
    }

    fn on_request(&mut self, change: RequestChange, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        if change.instance == "GPIOA" && change.request == usize::from(NCS_PIN) {
            // A transaction may have changed when the chip samples next.
            self.follow(registers, context);
        } else if change.instance == "SPI1" {
            self.show(registers, context);
        }
    }

    fn reset_line(&mut self, registers: &mut RegisterFile, context: &mut DeviceContext<'_>) {
        self.gpio.reset_line(registers, context);
    }
}
