//! WeAct Black Pill with an STM32F411CE and a 25 MHz crystal.
//!
//! | pin | to |
//! |---|---|
//! | PA4 | sensor NCS |
//! | PA5 | sensor SCK (marked SCL on many boards) |
//! | PA6 | sensor MISO (AD0 or SDO) |
//! | PA7 | sensor MOSI (SDA or SDI) |
//! | PB0 | sensor INT |
//! | PB1 | a GY-91's CSB: held high, so that its barometer stays off the shared bus |
//! | PA9, PA10 | console out, in (460 800 baud) |
//! | PC13 | the board's own LED, lit when low |

use embassy_stm32::exti::{self, ExtiInput};
use embassy_stm32::gpio::{Level, Output, Pull, Speed};
use embassy_stm32::rcc::{Hse, HseMode};
use embassy_stm32::spi::Spi;
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::{self, Uart};
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{bind_interrupts, dma, peripherals};

use super::{Board, Light};

/// As in `@hello`.
pub const NAME: &str = "black-pill-f411ce";

bind_interrupts!(struct Interrupts {
    EXTI0 => exti::InterruptHandler<embassy_stm32::interrupt::typelevel::EXTI0>;
    USART1 => usart::InterruptHandler<peripherals::USART1>;
    DMA2_STREAM0 => dma::InterruptHandler<peripherals::DMA2_CH0>;
    DMA2_STREAM2 => dma::InterruptHandler<peripherals::DMA2_CH2>;
    DMA2_STREAM3 => dma::InterruptHandler<peripherals::DMA2_CH3>;
    DMA2_STREAM7 => dma::InterruptHandler<peripherals::DMA2_CH7>;
});

/// Starts the clocks and takes the pins.
pub fn init() -> Result<Board, &'static str> {
    let p = embassy_stm32::init(super::clocks(Hse { freq: Hertz(25_000_000), mode: HseMode::Oscillator }));
    let reset_cause = super::reset_cause();
    let bus = Spi::new(p.SPI1, p.PA5, p.PA7, p.PA6, p.DMA2_CH3, p.DMA2_CH0, Interrupts, super::spi_config());
    let select = Output::new(p.PA4, Level::High, Speed::Low);
    // Stays an output for good: a dropped one would float.
    core::mem::forget(Output::new(p.PB1, Level::High, Speed::Low));
    let uart = Uart::new(p.USART1, p.PA10, p.PA9, p.DMA2_CH7, p.DMA2_CH2, Interrupts, super::uart_config())
        .map_err(|_| "USART1 cannot make 460800 baud from these clocks")?;
    let (receive, transmit) = super::console(uart);
    Ok(Board {
        sensor: super::sensor(bus, select),
        data_ready: ExtiInput::new(p.PB0, p.EXTI0, Pull::Down, Interrupts),
        led: Light::new(Output::new(p.PC13, Level::High, Speed::Low), true),
        receive,
        transmit,
        flash: super::parameter_flash(p.FLASH),
        watchdog: IndependentWatchdog::new(p.IWDG, super::WATCHDOG_US),
        reset_cause,
    })
}
