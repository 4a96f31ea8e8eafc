//! The STM32F411CE's memory map and bus, described with rigless's register tables of the STM32F427.
//!
//! The two parts share their register layouts where the firmware goes (RM0383 against RM0090); what the F411
//! lacks is left out, so that a firmware reaching it takes the bus fault the real part gives.

use std::num::{NonZeroU32, NonZeroU64};

use rigless::cpu::armv7m;
use rigless::soc::stm32f427::generated as table;
use rigless::soc::stm32f427::peripherals::tim::Counter;
use rigless::soc::{Builder, Bus, Clock, Cpu, Endian, EraseBlocks, Error, Gate, Peripheral, Region, WriteModify};

pub const FLASH_BASE: u64 = 0x0800_0000;
pub const FLASH_BYTES: usize = 512 << 10;
pub const RAM_BASE: u64 = 0x2000_0000;
pub const RAM_BYTES: usize = 128 << 10;
pub const SYSTEM_BASE: u64 = 0x1FFF_0000;

/// The F411's sectors: 4 of 16 KB, one of 64 KB, 3 of 128 KB (RM0383 table 5).
pub const SECTOR_BYTES: [usize; 8] =
    [16 << 10, 16 << 10, 16 << 10, 16 << 10, 64 << 10, 128 << 10, 128 << 10, 128 << 10];

static ERASE_BLOCKS: [EraseBlocks; 3] = [blocks(16 << 10, 4), blocks(64 << 10, 1), blocks(128 << 10, 3)];

const fn blocks(bytes: u64, count: u32) -> EraseBlocks {
    match (NonZeroU64::new(bytes), NonZeroU32::new(count)) {
        (Some(size), Some(count)) => EraseBlocks { size, count },
        _ => panic!("a sector has bytes"),
    }
}

static MEMORY: [Region; 3] = [
    Region::flash("flash", FLASH_BASE, FLASH_BYTES as u64)
        .erased_in(&ERASE_BLOCKS)
        .erased_to(0xFF)
        .programmed_by("FLASH"),
    Region::system("system", SYSTEM_BASE, 32 << 10),
    Region::ram("sram", RAM_BASE, RAM_BYTES as u64),
];

/// RM0383 table 37 ends at line 85 (SPI5).
pub const INTERRUPT_LINES: u16 = 86;
static CPU: Cpu = Cpu::new("CM4", true, INTERRUPT_LINES, Endian::Little);

pub const PORTS: [&str; 6] = ["GPIOA", "GPIOB", "GPIOC", "GPIOD", "GPIOE", "GPIOH"];
pub const SPIS: [&str; 5] = ["SPI1", "SPI2", "SPI3", "SPI4", "SPI5"];
pub const USARTS: [&str; 3] = ["USART1", "USART2", "USART6"];
pub const TIMERS: [(&str, Counter); 4] =
    [("TIM2", Counter::Wide), ("TIM3", Counter::Narrow), ("TIM4", Counter::Narrow), ("TIM5", Counter::Wide)];

/// Instances that answer from their registers alone: present on the part, and not used by the product.
const STORED_ONLY: [&str; 10] = ["WWDG", "I2C1", "I2C2", "I2C3", "SDIO", "TIM9", "TIM10", "TIM11", "CRC", "RTC"];

/// Every instance with a model behind it besides the ports, serial interfaces, serial ports and timers above.
const MODELLED: [&str; 10] = ["RCC", "PWR", "FLASH", "EXTI", "SYSCFG", "DMA1", "DMA2", "IWDG", "TIM1", "DBG"];

/// Clock enables (RM0383 6.3.9 to 6.3.12): an instance whose bit is clear does not answer.
const GATES: [(&str, &str, &str); 26] = [
    ("GPIOA", "AHB1ENR", "GPIOAEN"),
    ("GPIOB", "AHB1ENR", "GPIOBEN"),
    ("GPIOC", "AHB1ENR", "GPIOCEN"),
    ("GPIOD", "AHB1ENR", "GPIODEN"),
    ("GPIOE", "AHB1ENR", "GPIOEEN"),
    ("GPIOH", "AHB1ENR", "GPIOHEN"),
    ("DMA1", "AHB1ENR", "DMA1EN"),
    ("DMA2", "AHB1ENR", "DMA2EN"),
    ("TIM2", "APB1ENR", "TIM2EN"),
    ("TIM3", "APB1ENR", "TIM3EN"),
    ("TIM4", "APB1ENR", "TIM4EN"),
    ("TIM5", "APB1ENR", "TIM5EN"),
    ("SPI2", "APB1ENR", "SPI2EN"),
    ("SPI3", "APB1ENR", "SPI3EN"),
    ("USART2", "APB1ENR", "USART2EN"),
    ("PWR", "APB1ENR", "PWREN"),
    ("TIM1", "APB2ENR", "TIM1EN"),
    ("USART1", "APB2ENR", "USART1EN"),
    ("USART6", "APB2ENR", "USART6EN"),
    ("SPI1", "APB2ENR", "SPI1EN"),
    ("SPI4", "APB2ENR", "SPI4EN"),
    ("SPI5", "APB2ENR", "SPI5EN"),
    ("SYSCFG", "APB2ENR", "SYSCFGEN"),
    ("I2C1", "APB1ENR", "I2C1EN"),
    ("I2C2", "APB1ENR", "I2C2EN"),
    ("I2C3", "APB1ENR", "I2C3EN"),
];

/// Where an instance's reset bit is spelled otherwise than its enable with RST for EN.
const RESET_SPELLING: [(&str, &str); 1] = [("USART2", "UART2RST")];

fn instances() -> Vec<Peripheral> {
    let wanted = |name: &str| {
        PORTS.contains(&name)
            || SPIS.contains(&name)
            || USARTS.contains(&name)
            || TIMERS.iter().any(|(timer, _)| *timer == name)
            || MODELLED.contains(&name)
            || STORED_ONLY.contains(&name)
    };
    let mut instances: Vec<Peripheral> =
        table::PERIPHERALS.iter().copied().filter(|instance| wanted(instance.name)).collect();
    for instance in &mut instances {
        // ST's file splits one port layout in three and gives each timer its own; the models want theirs.
        if PORTS.contains(&instance.name) {
            instance.registers = &table::gpioa::REGISTERS;
        }
        if let Some((_, counter)) = TIMERS.iter().find(|(timer, _)| *timer == instance.name) {
            instance.registers = counter.layout();
        }
    }
    instances.push(armv7m::PERIPHERAL);
    instances
}

/// The bus of a part fresh out of reset.
pub fn bus() -> Result<Bus, Error> {
    let builder = corrections(Bus::builder(CPU, &MEMORY, instances()));
    let builder = wires(gates(builder));
    clocks(builder)?.build()
}

/// Reset values and write rules where ST's file is wrong (design.md section 4, traps).
fn corrections(mut builder: Builder) -> Builder {
    for port in USARTS {
        builder = builder.reset(port, "SR", 0xC0);
    }
    for interface in SPIS {
        builder = builder.reset(interface, "I2SPR", 0x2);
    }
    for (timer, counter) in TIMERS {
        builder = builder.reset(timer, "ARR", counter.mask());
        builder = builder.write_modify(timer, "SR", WriteModify::ZeroToClear);
    }
    builder
        .reset("TIM1", "ARR", 0xFFFF)
        .write_modify("TIM1", "SR", WriteModify::ZeroToClear)
        .write_modify("EXTI", "PR", WriteModify::OneToClear)
        // The STM32F411's device id, revision A (RM0383 23.6.1).
        .reset("DBG", "DBGMCU_IDCODE", 0x1000_6431)
        .reset("GPIOA", "MODER", 0xA800_0000)
        .reset("GPIOA", "OSPEEDR", 0x0C00_0000)
        .reset("GPIOA", "PUPDR", 0x6400_0000)
        .reset("GPIOB", "MODER", 0x0000_0280)
        .reset("GPIOB", "OSPEEDR", 0x0000_00C0)
        .reset("GPIOB", "PUPDR", 0x0000_0100)
}

fn gates(mut builder: Builder) -> Builder {
    for (instance, register, enable) in GATES {
        builder = builder.gate(instance, Gate::by("RCC", register, enable));
        let reset_register = match register {
            "AHB1ENR" => "AHB1RSTR",
            "APB1ENR" => "APB1RSTR",
            _ => "APB2RSTR",
        };
        let reset = RESET_SPELLING.iter().find(|(name, _)| *name == instance).map_or_else(
            || -> &'static str { format!("{}RST", &enable[..enable.len() - 2]).leak() },
            |(_, spelled)| spelled,
        );
        builder = builder.reset_by(instance, Gate::by("RCC", reset_register, reset));
    }
    builder.gate_writes("RCC", &["BDCR"], Gate::by("PWR", "CR", "DBP"))
}

/// Who hears the levels others drive: pin levels, DMA requests, and the watchdog's call for the LSI.
fn wires(mut builder: Builder) -> Builder {
    for sink in SPIS.into_iter().chain(["DMA1", "DMA2", "RCC", "TIM1", "EXTI", "GPIOB", "RTC"]) {
        builder = builder.reads_requests(sink);
    }
    builder
}

/// Every modelled instance runs on the output of the clock tree it runs on in rigless's own F427: the numbers
/// of those outputs are private to it, so they are read back from a bus it builds.
fn clocks(mut builder: Builder) -> Result<Builder, Error> {
    let reference = rigless::soc::stm32f427::builder().build()?;
    let timers = TIMERS.iter().map(|(name, _)| *name);
    let timed = SPIS.into_iter().chain(USARTS).chain(timers).chain(["TIM1", "IWDG", armv7m::PERIPHERAL.name]);
    for instance in timed {
        let clock: Clock = reference.clock_of(instance).ok_or(Error::UnknownInstance { instance })?;
        builder = builder.clocked_by(instance, clock);
    }
    Ok(builder)
}

/// The sector holding `offset` into flash, with where it starts.
#[must_use]
pub fn sector_start(sector: usize) -> Option<usize> {
    (sector < SECTOR_BYTES.len()).then(|| SECTOR_BYTES[..sector].iter().sum())
}
