//! The sensor on SPI1 by DMA, sampled at its data-ready interrupt from the high-priority executor.

use core::sync::atomic::{AtomicU32, Ordering};
use embassy_stm32::exti::ExtiInput;
use embassy_stm32::gpio::Output;
use embassy_stm32::mode::Async;
use embassy_stm32::spi::Spi;
use embassy_stm32::spi::mode::Master;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Instant, Timer};

pub static WHO_AM_I: AtomicU32 = AtomicU32::new(0x100);
pub static SAMPLES: AtomicU32 = AtomicU32::new(0);
pub static LAST_US: AtomicU32 = AtomicU32::new(0);
pub static FIRST_US: AtomicU32 = AtomicU32::new(0);
/// The last burst: status, accelerometer, temperature, gyroscope.
pub static LAST: Signal<CriticalSectionRawMutex, [u8; 15]> = Signal::new();

type Bus = Spi<'static, Async, Master>;

async fn write(spi: &mut Bus, select: &mut Output<'static>, register: u8, value: u8) {
    select.set_low();
    let _ = spi.write(&[register, value]).await;
    select.set_high();
}

async fn read(spi: &mut Bus, select: &mut Output<'static>, register: u8, out: &mut [u8]) {
    let mut command = [0_u8; 16];
    let mut answer = [0_u8; 16];
    command[0] = register | 0x80;
    let length = out.len() + 1;
    select.set_low();
    let _ = spi.transfer(&mut answer[..length], &command[..length]).await;
    select.set_high();
    out.copy_from_slice(&answer[1..length]);
}

#[embassy_executor::task]
pub async fn sample(mut spi: Bus, mut select: Output<'static>, mut ready: ExtiInput<'static, Async>) {
    let (spi, select) = (&mut spi, &mut select);
    write(spi, select, 0x6B, 0x80).await;
    Timer::after_millis(100).await;
    let mut id = [0];
    read(spi, select, 0x75, &mut id).await;
    WHO_AM_I.store(u32::from(id[0]), Ordering::Relaxed);
    // I2C_IF_DIS; clock from the gyroscope; 200 Hz; 1000 dps; 4 g; latched, cleared by any read.
    for (register, value) in [
        (0x6A, 0x10),
        (0x6B, 0x01),
        (0x19, 4),
        (0x1A, 3),
        (0x1B, 0x10),
        (0x1C, 0x08),
        (0x1D, 3),
        (0x37, 0x30),
        (0x38, 1),
    ] {
        write(spi, select, register, value).await;
    }
    loop {
        ready.wait_for_high().await;
        let now = Instant::now().as_micros() as u32;
        let mut burst = [0; 15];
        read(spi, select, 0x3A, &mut burst).await;
        if SAMPLES.fetch_add(1, Ordering::Relaxed) == 0 {
            FIRST_US.store(now, Ordering::Relaxed);
        }
        LAST_US.store(now, Ordering::Relaxed);
        LAST.signal(burst);
    }
}
