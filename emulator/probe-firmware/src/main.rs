//! The probe: one-letter commands on USART1, each exercising one part of the board and printing one line.
//! The emulator's tests read those lines; see `emulator/tests/probe.rs` for what each must say.

#![no_std]
#![no_main]

mod commands;
mod imu;

use core::fmt::Write as _;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_stm32::exti::{self, ExtiInput};
use embassy_stm32::gpio::{Level, Output, Pull, Speed};
use embassy_stm32::interrupt;
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::mode::Async;
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::{self, Uart, UartTx};
use embassy_stm32::{Config, bind_interrupts, dma, peripherals, rcc, spi};
use embassy_time::Timer;

bind_interrupts!(struct Irqs {
    USART1 => usart::InterruptHandler<peripherals::USART1>;
    DMA2_STREAM0 => dma::InterruptHandler<peripherals::DMA2_CH0>;
    DMA2_STREAM2 => dma::InterruptHandler<peripherals::DMA2_CH2>;
    DMA2_STREAM3 => dma::InterruptHandler<peripherals::DMA2_CH3>;
    DMA2_STREAM7 => dma::InterruptHandler<peripherals::DMA2_CH7>;
    EXTI0 => exti::InterruptHandler<interrupt::typelevel::EXTI0>;
});

static SAMPLING: InterruptExecutor = InterruptExecutor::new();

/// An interrupt line nothing else uses; the executor pends it through the NVIC's STIR.
#[interrupt]
unsafe fn SPI5() {
    unsafe { SAMPLING.on_interrupt() }
}

/// Formats into a buffer on the stack and sends it by DMA.
pub struct Line {
    bytes: [u8; 160],
    length: usize,
}

impl Default for Line {
    fn default() -> Self {
        Self { bytes: [0; 160], length: 0 }
    }
}

impl Line {
    pub async fn send(&self, tx: &mut UartTx<'static, Async>) {
        let _ = tx.write(&self.bytes[..self.length]).await;
    }
}

impl core::fmt::Write for Line {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let end = (self.length + text.len()).min(self.bytes.len());
        let fits = end - self.length;
        self.bytes[self.length..end].copy_from_slice(&text.as_bytes()[..fits]);
        self.length = end;
        Ok(())
    }
}

/// HSE 25 MHz / 25 * 192 / 2 = 96 MHz, APB1 at 48 MHz: the product's own clock tree.
fn clocks() -> Config {
    let mut config = Config::default();
    config.rcc.hse = Some(rcc::Hse { freq: Hertz(25_000_000), mode: rcc::HseMode::Oscillator });
    config.rcc.pll_src = rcc::PllSource::HSE;
    config.rcc.pll = Some(rcc::Pll {
        prediv: rcc::PllPreDiv::DIV25,
        mul: rcc::PllMul::MUL192,
        divp: Some(rcc::PllPDiv::DIV2),
        divq: None,
        divr: None,
    });
    config.rcc.sys = rcc::Sysclk::PLL1_P;
    config.rcc.ahb_pre = rcc::AHBPrescaler::DIV1;
    config.rcc.apb1_pre = rcc::APBPrescaler::DIV2;
    config.rcc.apb2_pre = rcc::APBPrescaler::DIV1;
    config
}

#[embassy_executor::task]
async fn blink(mut led: Output<'static>) {
    loop {
        led.toggle();
        Timer::after_millis(500).await;
    }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let p = embassy_stm32::init(clocks());
    let csr = embassy_stm32::pac::RCC.csr().read().0;
    embassy_stm32::pac::RCC.csr().modify(|w| w.set_rmvf(true));

    let mut serial = usart::Config::default();
    serial.baudrate = 460_800;
    let uart = Uart::new(p.USART1, p.PA10, p.PA9, p.DMA2_CH7, p.DMA2_CH2, Irqs, serial).unwrap();
    let (mut tx, rx) = uart.split();
    let received = cortex_m::singleton!(: [u8; 256] = [0; 256]).unwrap();
    let mut rx = rx.into_ring_buffered(received);

    spawner.spawn(blink(Output::new(p.PC13, Level::High, Speed::Low)).unwrap());

    let mut bus = spi::Config::default();
    bus.frequency = Hertz(700_000);
    bus.mode = spi::MODE_3;
    let spi = spi::Spi::new(p.SPI1, p.PA5, p.PA7, p.PA6, p.DMA2_CH3, p.DMA2_CH0, Irqs, bus);
    let select = Output::new(p.PA4, Level::High, Speed::High);
    let ready = ExtiInput::new(p.PB0, p.EXTI0, Pull::None, Irqs);
    interrupt::SPI5.set_priority(Priority::P6);
    let sampling = SAMPLING.start(interrupt::SPI5);
    sampling.spawn(imu::sample(spi, select, ready).unwrap());

    let mut line = Line::default();
    let _ = write!(line, "boot csr={csr:08x}\r\n");
    line.send(&mut tx).await;
    commands::serve(&mut rx, &mut tx, p.FLASH, p.IWDG).await
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {
        cortex_m::asm::bkpt();
    }
}
