//! EXTI, SYSCFG and the flash interface by their registers, with no firmware: what the reference manual says of
//! each, error flags included.

use std::sync::{Arc, Mutex};

use emulator::exti::LedLog;
use emulator::flash::{SR_BSY, SR_EOP, SR_OPERR, SR_PGAERR, SR_PGPERR, SR_PGSERR, SR_WRPERR};
use emulator::flash_array::FlashArray;
use emulator::mpu9250::Mpu9250;
use emulator::part::{Part, Surroundings};
use emulator::serial_wire::SerialWire;
use emulator::stall::SharedCore;
use emulator::{AtRest, FlashTiming, SensorOptions};
use rigless::device::{Level, ResetCause};
use rigless::emulator::{Error, Memory};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::Width;
use rigless::time::VirtualNanos;

const RCC_APB2ENR: u64 = 0x4002_3844;
const RCC_CSR: u64 = 0x4002_3874;
const SYSCFG_EXTICR1: u64 = 0x4001_3808;
const EXTI: u64 = 0x4001_3C00;
const IMR: u64 = EXTI;
const RTSR: u64 = EXTI + 0x08;
const FTSR: u64 = EXTI + 0x0C;
const SWIER: u64 = EXTI + 0x10;
const PR: u64 = EXTI + 0x14;
const FLASH: u64 = 0x4002_3C00;
const KEYR: u64 = FLASH + 0x04;
const SR: u64 = FLASH + 0x0C;
const CR: u64 = FLASH + 0x10;
const SCRATCH: u64 = 0x0804_0000;
const EXTI0_LINE: u16 = 6;

/// The guest's memory is the emulator's; programming it always lands.
struct NoMemory;

impl Memory for NoMemory {
    fn read(&mut self, address: u64, width: Width) -> Result<u64, Error> {
        Err(Error::Memory { address, width })
    }
    fn write(&mut self, address: u64, width: Width, _value: u64) -> Result<(), Error> {
        Err(Error::Memory { address, width })
    }
    fn program(&mut self, _address: u64, _width: Width, _value: u64) -> Result<(), Error> {
        Ok(())
    }
}

struct Bench {
    part: Part,
    around: Surroundings,
    now: u64,
}

impl Bench {
    fn new() -> Self {
        let sensor = Mpu9250::new(SensorOptions::default(), None, Box::new(AtRest));
        let around = Surroundings {
            sensor: Arc::new(Mutex::new(sensor)),
            serial: SerialWire::default(),
            flash: Arc::new(Mutex::new(FlashArray::holding(&[]))),
            core: SharedCore::default(),
            timing: FlashTiming::default(),
            led: LedLog::default(),
        };
        let part = Part::new(around.clone()).expect("the part assembles");
        Self { part, around, now: 20_000_000 }
    }

    fn write(&mut self, address: u64, value: u64) {
        self.write_as(address, Width::W32, value);
    }

    fn write_as(&mut self, address: u64, width: Width, value: u64) {
        self.part.write(VirtualNanos(self.now), address, width, value).expect("it answers");
        self.settle();
    }

    fn read(&mut self, address: u64) -> u64 {
        self.part.read(VirtualNanos(self.now), address, Width::W32).expect("it answers")
    }

    fn settle(&mut self) {
        let refused = self.part.settle(&mut NoMemory).expect("memory programs");
        assert!(refused.is_empty(), "{refused:?}");
    }

    fn advance(&mut self, nanos: u64) {
        self.now += nanos;
        self.part.advance_to(VirtualNanos(self.now));
        self.settle();
    }

    /// The level last driven on an interrupt line since the last call.
    fn line(&mut self, line: u16) -> Option<Level> {
        let changes = self.part.drain_interrupts();
        changes.iter().rev().find(|change| change.interrupt == line).map(|change| change.level)
    }

    fn sensor_write(&mut self, register: u8, value: u8) {
        let mut sensor = self.around.sensor.lock().expect("one thread");
        sensor.select(self.now);
        sensor.transfer(register, self.now);
        sensor.transfer(value, self.now);
        sensor.deselect();
    }

    /// The sensor at 200 Hz with its INT on PB0 latched until any read, and EXTI line 0 on `port`.
    fn with_interrupt_from(port: u64) -> Self {
        let mut bench = Self::new();
        bench.write(RCC_APB2ENR, 1 << 14);
        bench.write(SYSCFG_EXTICR1, port);
        for (register, value) in [(0x1A, 3), (0x19, 4), (0x37, 0x30), (0x38, 1)] {
            bench.sensor_write(register, value);
        }
        bench.clear_sensor();
        bench.part.follow_sensor(VirtualNanos(bench.now));
        bench.settle();
        bench
    }

    fn clear_sensor(&mut self) {
        let mut sensor = self.around.sensor.lock().expect("one thread");
        sensor.select(self.now);
        sensor.transfer(0x80 | 0x3A, self.now);
        sensor.transfer(0, self.now);
        sensor.deselect();
        drop(sensor);
        self.part.follow_sensor(VirtualNanos(self.now));
        self.settle();
    }

    fn unlock_flash(&mut self) {
        self.write(KEYR, 0x4567_0123);
        self.write(KEYR, 0xCDEF_89AB);
    }
}

#[test]
fn a_rising_edge_latches_interrupts_and_is_cleared_by_writing_one() {
    let mut bench = Bench::with_interrupt_from(1);
    bench.write(RTSR, 1);
    bench.write(IMR, 1);
    assert_eq!((bench.read(PR), bench.line(EXTI0_LINE)), (0, None));
    bench.advance(5_000_000);
    assert_eq!((bench.read(PR), bench.line(EXTI0_LINE)), (1, Some(Level::High)));
    bench.write(PR, 0xFFFE);
    assert_eq!((bench.read(PR), bench.line(EXTI0_LINE)), (1, None), "ones elsewhere leave it");
    bench.write(PR, 1);
    assert_eq!((bench.read(PR), bench.line(EXTI0_LINE)), (0, Some(Level::Low)));
    bench.advance(5_000_000);
    assert_eq!(bench.read(PR), 0, "the pin is still high: no second edge");
    bench.clear_sensor();
    bench.advance(5_000_000);
    assert_eq!(bench.read(PR), 1, "low and high again is one");
}

#[test]
fn a_masked_edge_latches_without_interrupting_until_it_is_unmasked() {
    let mut bench = Bench::with_interrupt_from(1);
    bench.write(RTSR, 1);
    bench.advance(5_000_000);
    assert_eq!((bench.read(PR), bench.line(EXTI0_LINE)), (1, None));
    bench.write(IMR, 1);
    assert_eq!(bench.line(EXTI0_LINE), Some(Level::High));
}

#[test]
fn a_falling_edge_and_a_line_routed_elsewhere() {
    let mut bench = Bench::with_interrupt_from(1);
    bench.write(FTSR, 1);
    bench.advance(5_000_000);
    assert_eq!(bench.read(PR), 0, "rising is not falling");
    bench.clear_sensor();
    assert_eq!(bench.read(PR), 1);
    let mut elsewhere = Bench::with_interrupt_from(2);
    elsewhere.write(RTSR, 1);
    elsewhere.advance(5_000_000);
    assert_eq!(elsewhere.read(PR), 0, "line 0 listens to port C");
}

#[test]
fn a_software_interrupt_is_a_request_too() {
    let mut bench = Bench::new();
    bench.write(RCC_APB2ENR, 1 << 14);
    bench.write(IMR, 1 << 7);
    bench.write(SWIER, 1 << 7);
    assert_eq!((bench.read(PR), bench.line(23)), (1 << 7, Some(Level::High)), "lines 5 to 9 share interrupt 23");
    bench.write(PR, 1 << 7);
    assert_eq!((bench.read(PR), bench.read(SWIER), bench.line(23)), (0, 0, Some(Level::Low)));
}

#[test]
fn a_wrong_key_locks_the_flash_until_a_reset() {
    let mut bench = Bench::new();
    assert_eq!(bench.read(CR), 1 << 31);
    bench.write(CR, 1);
    assert_eq!(bench.read(CR), 1 << 31, "locked");
    bench.write(KEYR, 0x4567_0123);
    bench.write(KEYR, 0x4567_0123);
    bench.unlock_flash();
    assert_eq!(bench.read(CR), 1 << 31, "the wrong key");
    bench.part.reset(VirtualNanos(bench.now), ResetCause::Core);
    bench.unlock_flash();
    assert_eq!(bench.read(CR), 0);
    bench.write(CR, 1 << 31);
    assert_eq!(bench.read(CR), 1 << 31, "and locked by hand");
}

#[test]
fn programming_is_refused_with_the_right_flag_and_changes_nothing() {
    let mut bench = Bench::new();
    bench.unlock_flash();
    bench.write(SCRATCH, 0);
    assert_eq!(bench.read(SR), SR_PGSERR, "PG is clear");
    bench.write(SR, SR_PGSERR);
    bench.write(CR, 1 | 2 << 8);
    bench.write_as(SCRATCH, Width::W16, 0);
    assert_eq!(bench.read(SR), SR_PGPERR, "a half word at word parallelism");
    bench.write(SR, SR_PGPERR);
    bench.write(CR, 1 | 3 << 8);
    bench.write_as(SCRATCH + 12, Width::W64, 0);
    assert_eq!(bench.read(SR), SR_PGAERR, "across a 128-bit row");
    bench.write(SR, SR_PGAERR);
    bench.write(CR, 1 << 1 | 9 << 3 | 1 << 16);
    assert_eq!(bench.read(SR), SR_WRPERR, "there is no sector 9");
    bench.write(CR, 1 << 25 | 1 << 1 | 9 << 3 | 1 << 16);
    assert_eq!((bench.read(SR), bench.line(4)), (SR_WRPERR | SR_OPERR, Some(Level::High)), "ERRIE");
    bench.write(SR, SR_WRPERR | SR_OPERR);
    assert_eq!((bench.read(SR), bench.line(4)), (0, Some(Level::Low)));
    let cells = bench.around.flash.lock().expect("one thread");
    assert!(cells.bytes().iter().all(|cell| *cell == 0xFF));
    assert_eq!(cells.operations(), 0);
}

#[test]
fn an_erase_is_busy_for_its_time_and_ends_with_eop() {
    let mut bench = Bench::new();
    bench.unlock_flash();
    bench.write(CR, 1 | 2 << 8);
    bench.write(SCRATCH, 0x1234_5678);
    assert_eq!(bench.read(SR) & SR_BSY, SR_BSY);
    bench.advance(16_001);
    assert_eq!(bench.read(SR), 0);
    assert_eq!(bench.around.flash.lock().expect("one thread").bytes()[0x4_0000..0x4_0004], [0x78, 0x56, 0x34, 0x12]);
    // Sector 6 at x32 with EOPIE.
    bench.write(CR, 1 << 24 | 2 << 8 | 6 << 3 | 1 << 1 | 1 << 16);
    assert_eq!((bench.read(SR), bench.read(CR) >> 16 & 1), (SR_BSY, 1));
    bench.advance(999_000_000);
    assert_eq!(bench.read(SR), SR_BSY);
    bench.advance(1_000_001);
    assert_eq!((bench.read(SR), bench.read(CR) >> 16 & 1, bench.line(4)), (SR_EOP, 0, Some(Level::High)));
    assert_eq!(bench.around.flash.lock().expect("one thread").bytes()[0x4_0000], 0xFF);
}

#[test]
fn reset_flags_gather_until_they_are_removed() {
    let mut bench = Bench::new();
    assert_eq!(bench.read(RCC_CSR), 0x0E00_0000, "power-on, pin, brown-out");
    bench.write(RCC_CSR, 1 << 24);
    assert_eq!(bench.read(RCC_CSR), 0);
    bench.part.reset(VirtualNanos(bench.now), ResetCause::Core);
    assert_eq!(bench.read(RCC_CSR), 0x1400_0000, "software and the pin");
    bench.part.reset(VirtualNanos(bench.now), ResetCause::Model("IWDG"));
    assert_eq!(bench.read(RCC_CSR), 0x3400_0000, "and the watchdog");
}
