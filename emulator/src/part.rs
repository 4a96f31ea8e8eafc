//! The microcontroller: rigless's models where it has them, ours where it has not, on the F411's bus.

use std::num::NonZeroU64;

use rigless::cpu::armv7m::{self, Dwt};
use rigless::device::{DeviceContext, ErasedDevice, Level, RegisterFile, ResetCause};
use rigless::mcu::{Mcu, Operate};
use rigless::soc::stm32f427::generated::rcc::Register as RccRegister;
use rigless::soc::stm32f427::peripherals::CONTROLLERS;
use rigless::soc::stm32f427::peripherals::dbg::Dbg;
use rigless::soc::stm32f427::peripherals::dma::Dma;
use rigless::soc::stm32f427::peripherals::gpio::{Gpio, Pin};
use rigless::soc::stm32f427::peripherals::iwdg::Iwdg;
use rigless::soc::stm32f427::peripherals::pwr::Pwr;
use rigless::soc::stm32f427::peripherals::rcc::{HSI_HZ, Rcc};
use rigless::soc::stm32f427::peripherals::rtc::Rtc;
use rigless::soc::stm32f427::peripherals::spi::{Select, Spi};
use rigless::soc::stm32f427::peripherals::tim::{Advanced, Counter, Tim};
use rigless::soc::stm32f427::peripherals::usart::{Kind, Usart};
use rigless::soc::{Bus, Error};
use rigless::time::VirtualNanos;

use crate::exti::{Exti, LedChange, LedLog, Syscfg};
use crate::flash::{Flash, SharedFlash};
use crate::flash_array::FlashTiming;
use crate::memory_map::{self, PORTS, SPIS, TIMERS, USARTS};
use crate::sensor_wires::{NCS_PIN, PortB, SensorOnSpi, SharedSensor};
use crate::serial_wire::SerialWire;
use crate::stall::SharedCore;
use crate::timer::Timer;

pub const HSE_HZ: u64 = 25_000_000;
const SUPPLY_MV: u32 = 3300;

/// What hangs on the part and what its cells hold: everything a reset leaves alone.
#[derive(Debug, Clone)]
pub struct Surroundings {
    pub sensor: SharedSensor,
    pub serial: SerialWire,
    pub flash: SharedFlash,
    pub core: SharedCore,
    pub timing: FlashTiming,
    pub led: LedLog,
}

#[derive(Debug)]
pub struct Part {
    rcc: Rcc,
    pwr: Pwr,
    /// Ports A and C to H in [`PORTS`]' order; port B is its own, since the sensor's INT is wired to it.
    gpio: [Gpio; PORTS.len()],
    port_b: PortB,
    spi: [Spi; SPIS.len()],
    usart: [Usart; USARTS.len()],
    tim: [Timer; TIMERS.len()],
    tim1: Tim<Advanced>,
    dma: [Dma; 2],
    flash: Flash,
    exti: Exti,
    syscfg: Syscfg,
    iwdg: Iwdg,
    rtc: Rtc,
    dbg: Dbg,
    dwt: Dwt,
    bus: Bus,
    models: Box<[Model]>,
    around: Surroundings,
}

/// Which field answers for a slot of the bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Model {
    None,
    Rcc,
    Pwr,
    Gpio(usize),
    PortB,
    Spi(usize),
    Usart(usize),
    Tim(usize),
    Tim1,
    Dma(usize),
    Flash,
    Exti,
    Syscfg,
    Iwdg,
    Rtc,
    Dbg,
    Dwt,
}

impl Model {
    fn of(instance: &str) -> Self {
        let among = |names: &[&str]| names.iter().position(|name| *name == instance);
        let timers = TIMERS.map(|(name, _)| name);
        if instance == "GPIOB" {
            return Self::PortB;
        }
        if let Some(nth) = among(&PORTS) {
            return Self::Gpio(nth);
        }
        if let Some(nth) = among(&SPIS) {
            return Self::Spi(nth);
        }
        if let Some(nth) = among(&USARTS) {
            return Self::Usart(nth);
        }
        if let Some(nth) = among(&timers) {
            return Self::Tim(nth);
        }
        match instance {
            "RCC" => Self::Rcc,
            "PWR" => Self::Pwr,
            "TIM1" => Self::Tim1,
            "DMA1" => Self::Dma(0),
            "DMA2" => Self::Dma(1),
            "FLASH" => Self::Flash,
            "EXTI" => Self::Exti,
            "SYSCFG" => Self::Syscfg,
            "IWDG" => Self::Iwdg,
            "RTC" => Self::Rtc,
            "DBG" => Self::Dbg,
            armv7m::DWT => Self::Dwt,
            _ => Self::None,
        }
    }
}

impl Part {
    /// The part out of a power-on reset, with the board's chips on its pins.
    pub fn new(around: Surroundings) -> Result<Self, Error> {
        let mut part = Self::bare(around)?;
        part.check()?;
        part.fit();
        Ok(part)
    }

    fn bare(around: Surroundings) -> Result<Self, Error> {
        let bus = memory_map::bus()?;
        let models = bus.peripherals().map(|instance| Model::of(instance.name)).collect();
        let syscfg = Syscfg::default();
        Ok(Self {
            rcc: Rcc::new(),
            pwr: Pwr::new(),
            gpio: std::array::from_fn(|_| Gpio::default()),
            port_b: PortB::new(around.sensor.clone()),
            spi: std::array::from_fn(|_| Spi::with_clock(HSI_HZ)),
            usart: std::array::from_fn(|_| Usart::with_clock(Kind::Usart, HSI_HZ)),
            tim: TIMERS.map(|(_, counter)| Timer::with_clock(HSI_HZ, counter)),
            tim1: Tim::with_clock(HSI_HZ, Counter::Narrow),
            dma: std::array::from_fn(|nth| {
                let controller = &CONTROLLERS[nth];
                Dma::new(controller.wiring, controller.last_data, controller.reaches_memory)
            }),
            flash: Flash::new(around.flash.clone(), around.core.clone(), around.timing),
            exti: Exti::new(syscfg.routing(), around.led.clone()),
            syscfg,
            iwdg: Iwdg::new(),
            rtc: Rtc,
            dbg: Dbg,
            dwt: Dwt::with_clock(HSI_HZ),
            bus,
            models,
            around,
        })
    }

    /// The board's crystal, rail and chips.
    fn fit(&mut self) {
        self.rcc.attach_crystals(HSE_HZ, 0);
        let registers = self.bus.slot_mut(self.bus.slot_of("PWR").expect("on the bus")).registers_mut();
        self.pwr.set_supply(SUPPLY_MV, registers);
        let ncs = Select { port: "GPIOA", pin: Pin::new(NCS_PIN).expect("sixteen pins"), active: Level::Low };
        self.spi[0].attach_selected(SensorOnSpi(self.around.sensor.clone()), ncs);
        self.usart[0].attach(self.around.serial.clone());
        self.around.core.stall(false);
    }

    /// Has port B follow the sensor from `at`: at power-on, after a reset, and after the host changed the chip.
    pub fn follow_sensor(&mut self, at: VirtualNanos) {
        let slot = self.bus.slot_of("GPIOB").expect("on the bus");
        let (registers, mut context) = self.bus.drive(at, slot);
        self.port_b.follow(registers, &mut context);
    }

    /// The clock the core runs at.
    #[must_use]
    pub fn hclk_hz(&self) -> Option<NonZeroU64> {
        NonZeroU64::new(self.rcc.hclk(self.bus.registers("RCC")?))
    }

    /// The level on a pin, as a wire soldered to it would see.
    #[must_use]
    pub fn pin_high(&self, port: &str, pin: u8) -> Option<bool> {
        let nth = PORTS.iter().position(|name| *name == port)?;
        let registers: &RegisterFile = self.bus.registers(port)?;
        let gpio = if port == "GPIOB" { &self.port_b.gpio } else { &self.gpio[nth] };
        Some(gpio.level(Pin::new(pin)?, registers) == Level::High)
    }

    fn call_usart(
        &mut self,
        now: VirtualNanos,
        poll: impl FnOnce(&mut Usart, &mut RegisterFile, &mut DeviceContext<'_>),
    ) {
        let slot = self.bus.slot_of("USART1").expect("on the bus");
        let (registers, mut context) = self.bus.drive(now, slot);
        poll(&mut self.usart[0], registers, &mut context);
    }
}

impl Mcu for Part {
    fn bus(&self) -> &Bus {
        &self.bus
    }

    fn bus_mut(&mut self) -> &mut Bus {
        &mut self.bus
    }

    /// A system reset: a part as new, with the board around it as it was and the reset flags saying why. The
    /// sensor is not told: its supply never went.
    fn reset(&mut self, at: VirtualNanos, cause: ResetCause) {
        let flags = self.bus.registers("RCC").expect("on the bus").get(RccRegister::Csr);
        let mut fresh = Self::new(self.around.clone()).expect("a part that assembled once assembles again");
        let slot = fresh.bus.slot_of("RCC").expect("on the bus");
        fresh.rcc.restarted(cause, flags, fresh.bus.slot_mut(slot).registers_mut());
        // Event numbers go on from the old bus's, so a stale one is never taken for a new one.
        fresh.bus.keep_added(&self.bus).expect("the same description");
        *self = fresh;
        self.follow_sensor(at);
        // The pin floats again, which no model announces.
        self.around.led.lock().expect("no panic holds it").push(LedChange { t_ns: at.0, lit: false });
    }

    /// The serial wire alone has anything outside the run.
    fn poll(&mut self, now: VirtualNanos) {
        self.call_usart(now, |usart, registers, context| {
            rigless::device::Device::poll(usart, registers, context);
        });
    }

    fn split(&mut self, slot: usize) -> (&mut Bus, Option<&mut dyn ErasedDevice>) {
        let model: Option<&mut dyn ErasedDevice> = match self.models.get(slot).copied().unwrap_or(Model::None) {
            Model::None => None,
            Model::Rcc => Some(&mut self.rcc),
            Model::Pwr => Some(&mut self.pwr),
            Model::Gpio(nth) => Some(&mut self.gpio[nth]),
            Model::PortB => Some(&mut self.port_b),
            Model::Spi(nth) => Some(&mut self.spi[nth]),
            Model::Usart(nth) => Some(&mut self.usart[nth]),
            Model::Tim(nth) => Some(&mut self.tim[nth]),
            Model::Tim1 => Some(&mut self.tim1),
            Model::Dma(nth) => Some(&mut self.dma[nth]),
            Model::Flash => Some(&mut self.flash),
            Model::Exti => Some(&mut self.exti),
            Model::Syscfg => Some(&mut self.syscfg),
            Model::Iwdg => Some(&mut self.iwdg),
            Model::Rtc => Some(&mut self.rtc),
            Model::Dbg => Some(&mut self.dbg),
            Model::Dwt => Some(&mut self.dwt),
        };
        (&mut self.bus, model)
    }
}
