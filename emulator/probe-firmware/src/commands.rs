//! What each letter does.

use crate::{Line, imu};
use core::fmt::Write as _;
use core::sync::atomic::Ordering;
use embassy_stm32::Peri;
use embassy_stm32::flash::{Blocking, Flash};
use embassy_stm32::mode::Async;
use embassy_stm32::peripherals::{FLASH, IWDG};
use embassy_stm32::usart::{RingBufferedUartRx, UartTx};
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_time::Instant;

/// The first of the two 128 KB parameter sectors, as an offset into flash.
const SCRATCH: u32 = 0x4_0000;
const SECTOR: u32 = 0x2_0000;

pub async fn serve(
    rx: &mut RingBufferedUartRx<'static>,
    tx: &mut UartTx<'static, Async>,
    flash: Peri<'static, FLASH>,
    watchdog: Peri<'static, IWDG>,
) -> ! {
    let mut flash = Flash::new_blocking(flash);
    let mut watchdog = IndependentWatchdog::new(watchdog, 100_000);
    let mut bytes = [0; 64];
    loop {
        let Ok(count) = rx.read(&mut bytes).await else { continue };
        for &letter in &bytes[..count] {
            let mut line = Line::default();
            answer(letter, &mut line, &mut flash, &mut watchdog);
            line.send(tx).await;
        }
    }
}

fn answer(
    letter: u8,
    line: &mut Line,
    flash: &mut Flash<'static, Blocking>,
    watchdog: &mut IndependentWatchdog<'static, IWDG>,
) {
    let _ = match letter {
        b'w' => write!(line, "who={:02x}\r\n", imu::WHO_AM_I.load(Ordering::Relaxed)),
        b's' => samples(line),
        b'l' => last(line),
        b'e' => erase(line, flash),
        b'f' => program(line, flash),
        b'v' => value(line),
        b'x' => program_refused(line),
        b'c' => cycles(line),
        b'r' => cortex_m::peripheral::SCB::sys_reset(),
        b'd' => {
            watchdog.unleash();
            loop {
                cortex_m::asm::nop();
            }
        }
        other => write!(line, "{}", other as char),
    };
}

fn samples(line: &mut Line) -> core::fmt::Result {
    let [count, first, last] = [&imu::SAMPLES, &imu::FIRST_US, &imu::LAST_US].map(|cell| cell.load(Ordering::Relaxed));
    write!(line, "samples={count} first_us={first} last_us={last}\r\n")
}

fn last(line: &mut Line) -> core::fmt::Result {
    write!(line, "last=")?;
    for byte in imu::LAST.try_take().unwrap_or_default() {
        write!(line, "{byte:02x}")?;
    }
    write!(line, "\r\n")
}

fn erase(line: &mut Line, flash: &mut Flash<'static, Blocking>) -> core::fmt::Result {
    let start = Instant::now();
    let outcome = flash.blocking_erase(SCRATCH, SCRATCH + SECTOR);
    let took = start.elapsed().as_millis();
    write!(line, "erase={} ms={took} sr={:08x}\r\n", outcome.is_ok(), embassy_stm32::pac::FLASH.sr().read().0)
}

fn program(line: &mut Line, flash: &mut Flash<'static, Blocking>) -> core::fmt::Result {
    let outcome = flash.blocking_write(SCRATCH, b"tumble!!");
    write!(line, "program={}\r\n", outcome.is_ok())
}

fn value(line: &mut Line) -> core::fmt::Result {
    let word = unsafe { core::ptr::read_volatile((0x0800_0000 + SCRATCH) as *const u32) };
    write!(line, "word={word:08x}\r\n")
}

/// A store with PG clear must set the sequence error and change nothing.
fn program_refused(line: &mut Line) -> core::fmt::Result {
    unsafe { core::ptr::write_volatile((0x0800_0000 + SCRATCH + 64) as *mut u32, 0) };
    let status = embassy_stm32::pac::FLASH.sr().read().0;
    embassy_stm32::pac::FLASH.sr().write(|w| w.0 = 0xF0);
    let cleared = embassy_stm32::pac::FLASH.sr().read().0;
    let word = unsafe { core::ptr::read_volatile((0x0800_0000 + SCRATCH + 64) as *const u32) };
    write!(line, "refused sr={status:08x} cleared={cleared:08x} word={word:08x}\r\n")
}

/// Ten thousand additions of floats, timed by the cycle counter; `bench_begin`/`bench_end` bracket them for
/// the host's instruction count.
fn cycles(line: &mut Line) -> core::fmt::Result {
    let mut core = unsafe { cortex_m::Peripherals::steal() };
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let before = cortex_m::peripheral::DWT::cycle_count();
    bench_begin();
    let mut sum = 0.0_f32;
    for step in 0..10_000 {
        sum += core::hint::black_box(step as f32);
    }
    bench_end();
    let cycles = cortex_m::peripheral::DWT::cycle_count().wrapping_sub(before);
    write!(line, "cycles={cycles} sum={sum}\r\n")
}

#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn bench_begin() {
    cortex_m::asm::nop();
}

#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn bench_end() {
    cortex_m::asm::nop();
    cortex_m::asm::nop();
}
