//! The one place that knows a pin. A board is one file: it names its pins and hands out a [`Board`], whose parts no
//! longer know which board they came from.

use embassy_stm32::exti::ExtiInput;
use embassy_stm32::flash::{Bank1Region3, Blocking, Flash};
use embassy_stm32::gpio::{Output, Pull};
use embassy_stm32::mode::Async;
use embassy_stm32::peripherals::{FLASH, IWDG};
use embassy_stm32::rcc::{AHBPrescaler, APBPrescaler, Hse, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk};
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{self, Spi};
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::{self, RingBufferedUartRx, Uart, UartTx};
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{Peri, pac};
use embassy_time::Delay;
use embedded_hal_bus::spi::ExclusiveDevice;
use mpu9250_spi::Mpu9250;
use static_cell::StaticCell;

#[cfg(all(feature = "black-pill", feature = "nucleo-f411re"))]
compile_error!("one board at a time: build the NUCLEO with `--no-default-features --features nucleo-f411re`");
#[cfg(not(any(feature = "black-pill", feature = "nucleo-f411re")))]
compile_error!("name the board: `--features black-pill` or `--features nucleo-f411re`");

#[cfg(feature = "black-pill")]
mod black_pill;
#[cfg(feature = "black-pill")]
pub use black_pill::{NAME, init};
#[cfg(feature = "nucleo-f411re")]
mod nucleo_f411re;
#[cfg(feature = "nucleo-f411re")]
pub use nucleo_f411re::{NAME, init};

/// Text at 200 Hz is about 13 kB/s, more than 115 200 baud carries; 460 800 (46 kB/s) leaves room for prompts.
const BAUD: u32 = 460_800;
/// At most 1 MHz for the sensor's configuration registers; 96 MHz / 128 = 750 kHz, at which a burst takes 0.2 ms.
const SPI_CLOCK: Hertz = Hertz(750_000);
/// Longer than the slowest sector erase (4 s), for which nothing else runs, even where the watchdog's oscillator is at
/// its fastest (47 kHz for a nominal 32 kHz: 12 s are then 8 s).
pub const WATCHDOG_US: u32 = 12_000_000;
/// Received bytes wait here until the console task looks: 11 ms of a full line at 460 800 baud.
const RECEIVE_BUFFER: usize = 512;

/// The sensor on its bus.
pub type Sensor = Mpu9250<SensorBus, Delay>;
/// SPI with the select line that belongs to the sensor alone.
pub type SensorBus = ExclusiveDevice<Spi<'static, Async, Master>, Output<'static>, Delay>;
/// The last three sectors of 128 KB.
pub type ParameterFlash = Bank1Region3<'static, Blocking>;
/// Of these the last two, which `memory.x` keeps the program out of.
pub const PARAMETER_RANGE: core::ops::Range<u32> = 0x2_0000..0x6_0000;

/// Everything the tasks need.
pub struct Board {
    /// Not started yet.
    pub sensor: Sensor,
    /// High while a reading waits.
    pub data_ready: ExtiInput<'static, Async>,
    /// The light.
    pub led: Light,
    /// From the person.
    pub receive: RingBufferedUartRx<'static>,
    /// To the person.
    pub transmit: UartTx<'static, Async>,
    /// For the parameters.
    pub flash: ParameterFlash,
    /// Not running yet.
    pub watchdog: IndependentWatchdog<'static, IWDG>,
    /// Why we started.
    pub reset_cause: &'static str,
}

/// An LED that knows which level lights it.
pub struct Light {
    pin: Output<'static>,
    active_low: bool,
}

impl Light {
    fn new(pin: Output<'static>, active_low: bool) -> Self {
        let mut light = Self { pin, active_low };
        light.set(false);
        light
    }

    /// On or off.
    pub fn set(&mut self, on: bool) {
        self.pin.set_level((on != self.active_low).into());
    }
}

/// 96 MHz from the board's external clock: the crystal is what time-stamps rest on.
fn clocks(hse: Hse) -> embassy_stm32::Config {
    let mut config = embassy_stm32::Config::default();
    let divider = if hse.freq.0 == 25_000_000 { PllPreDiv::DIV25 } else { PllPreDiv::DIV8 };
    config.rcc.hse = Some(hse);
    config.rcc.pll_src = PllSource::HSE;
    // 1 MHz · 192 / 2.
    config.rcc.pll =
        Some(Pll { prediv: divider, mul: PllMul::MUL192, divp: Some(PllPDiv::DIV2), divq: None, divr: None });
    config.rcc.sys = Sysclk::PLL1_P;
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV2;
    config.rcc.apb2_pre = APBPrescaler::DIV1;
    config
}

fn spi_config() -> spi::Config {
    let mut config = spi::Config::default();
    config.mode = spi::MODE_3;
    config.frequency = SPI_CLOCK;
    // An absent sensor then answers 0xFF and not whatever the wire picks up.
    config.miso_pull = Pull::Up;
    config
}

fn uart_config() -> usart::Config {
    let mut config = usart::Config::default();
    config.baudrate = BAUD;
    // With nobody at the other end the line must read idle and not noise.
    config.rx_pull = Pull::Up;
    config
}

fn sensor(bus: Spi<'static, Async, Master>, select: Output<'static>) -> Sensor {
    // The select line cannot fail to be set: its error type is `Infallible`.
    let Ok(device) = ExclusiveDevice::new(bus, select, Delay);
    Mpu9250::new(device, Delay)
}

fn console(uart: Uart<'static, Async>) -> (RingBufferedUartRx<'static>, UartTx<'static, Async>) {
    static BUFFER: StaticCell<[u8; RECEIVE_BUFFER]> = StaticCell::new();
    let (transmit, receive) = uart.split();
    (receive.into_ring_buffered(BUFFER.init([0; RECEIVE_BUFFER])), transmit)
}

fn parameter_flash(flash: Peri<'static, FLASH>) -> ParameterFlash {
    Flash::new_blocking(flash).into_blocking_regions().bank1_region3
}

/// Reads and clears the reset flags. The pin's flag is set with every other, so it is asked last.
fn reset_cause() -> &'static str {
    let flags = pac::RCC.csr().read();
    pac::RCC.csr().modify(|w| w.set_rmvf(true));
    match () {
        () if flags.wdgrstf() || flags.wwdgrstf() => "watchdog",
        () if flags.sftrstf() => "software",
        () if flags.porrstf() => "power",
        () if flags.borrstf() => "brown-out",
        () if flags.lpwrrstf() => "low-power",
        () if flags.padrstf() => "pin",
        () => "unknown",
    }
}
