//! ST NUCLEO-F411RE: the ST-Link gives an 8 MHz clock and carries the console over USB.
//!
//! The board's LED sits on PA5, where SPI1 has its clock by default, so SPI1 is taken from PB3, PB4 and PB5. That costs
//! SWO on PB3 (the log goes over RTT, which needs none).
//!
//! | pin | Arduino | to |
//! |---|---|---|
//! | PB6 | D10 | sensor NCS |
//! | PB3 | D3 | sensor SCK (marked SCL on many boards) |
//! | PB4 | D5 | sensor MISO (AD0 or SDO) |
//! | PB5 | D4 | sensor MOSI (SDA or SDI) |
//! | PB0 | A3 | sensor INT |
//! | PC1 | A4 | a GY-91's CSB: held high, so that its barometer stays off the shared bus |
//! | PA2, PA3 | | console out, in: the ST-Link's serial port (460 800 baud) |
//! | PA5 | | the board's own LED LD2, lit when high |

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
pub const NAME: &str = "nucleo-f411re";

bind_interrupts!(struct Interrupts {
    EXTI0 => exti::InterruptHandler<embassy_stm32::interrupt::typelevel::EXTI0>;
    USART2 => usart::InterruptHandler<peripherals::USART2>;
    DMA1_STREAM5 => dma::InterruptHandler<peripherals::DMA1_CH5>;
    DMA1_STREAM6 => dma::InterruptHandler<peripherals::DMA1_CH6>;
    DMA2_STREAM0 => dma::InterruptHandler<peripherals::DMA2_CH0>;
    DMA2_STREAM3 => dma::InterruptHandler<peripherals::DMA2_CH3>;
});

/// Starts the clocks and takes the pins.
pub fn init() -> Result<Board, &'static str> {
    let p = embassy_stm32::init(super::clocks(Hse { freq: Hertz(8_000_000), mode: HseMode::Bypass }));
    let reset_cause = super::reset_cause();
    let bus = Spi::new(p.SPI1, p.PB3, p.PB5, p.PB4, p.DMA2_CH3, p.DMA2_CH0, Interrupts, super::spi_config());
    let select = Output::new(p.PB6, Level::High, Speed::Low);
    // Stays an output for good: a dropped one would float.
    core::mem::forget(Output::new(p.PC1, Level::High, Speed::Low));
    let uart = Uart::new(p.USART2, p.PA3, p.PA2, p.DMA1_CH6, p.DMA1_CH5, Interrupts, super::uart_config())
        .map_err(|_| "USART2 cannot make 460800 baud from these clocks")?;
    let (receive, transmit) = super::console(uart);
    Ok(Board {
        sensor: super::sensor(bus, select),
        data_ready: ExtiInput::new(p.PB0, p.EXTI0, Pull::Down, Interrupts),
        led: Light::new(Output::new(p.PA5, Level::Low, Speed::Low), false),
        receive,
        transmit,
        flash: super::parameter_flash(p.FLASH),
        watchdog: IndependentWatchdog::new(p.IWDG, super::WATCHDOG_US),
        reset_cause,
    })
}
