//! The board as its host sees it: power, time, the serial line, the LED, the flash, the sensor's world.

use std::num::NonZeroU64;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard};

use rigless::image::Image;
use rigless::symbols::Symbols;
use rigless::time::VirtualNanos;

use crate::exti::{LedChange, LedLog};
use crate::flash_array::{FlashArray, FlashTiming};
use crate::machine::BlackPill;
use crate::memory_map::{FLASH_BASE, FLASH_BYTES, SECTOR_BYTES, sector_start};
use crate::mpu9250::{Mpu9250, SensorFault, SensorOptions};
use crate::part::{Part, Surroundings};
use crate::run::{Run, Shared};
use crate::sensor_wires::SharedSensor;
use crate::serial_wire::SerialWire;
use crate::stall::SharedCore;
use crate::world::SensorWorld;

/// One particular board.
#[derive(Debug, Clone)]
pub struct BoardOptions {
    pub sensor: SensorOptions,
    pub sensor_fault: Option<SensorFault>,
    pub flash_timing: FlashTiming,
    /// Instructions per virtual second. At 96 MHz it makes `DWT_CYCCNT` count instructions, one a cycle; the
    /// part itself needs about half as many cycles again.
    pub instructions_per_second: u64,
    /// What the flash holds before the firmware is put in, or erased cells: a board with a history.
    pub flash: Option<Vec<u8>>,
}

impl Default for BoardOptions {
    fn default() -> Self {
        Self {
            sensor: SensorOptions::default(),
            sensor_fault: None,
            flash_timing: FlashTiming::default(),
            instructions_per_second: 96_000_000,
            flash: None,
        }
    }
}

/// Why the board cannot be, or cannot go on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BoardError(pub String);

impl std::fmt::Display for BoardError {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "the emulated board: {}", self.0)
    }
}

impl std::error::Error for BoardError {}

/// Why a stretch of running ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// At the time asked for.
    OnTime,
    /// The power failed during a flash operation, as asked for; [`Board::power_cycle`] brings it back.
    PowerCut,
    /// At a watched instruction.
    Hit,
}

pub struct Board {
    pub(crate) run: Option<Run>,
    pub(crate) shared: Shared,
    pub(crate) symbols: Symbols,
    options: BoardOptions,
    pub(crate) around: Surroundings,
    /// Board time and instructions before the present power-on.
    pub(crate) epoch_s: f64,
    epoch_instructions: u64,
    led: Vec<(f64, bool)>,
}

impl Board {
    /// A board with `elf` in its flash, powered at time 0 and stopped before its first instruction.
    pub fn new(elf: &[u8], options: BoardOptions, world: Box<dyn SensorWorld>) -> Result<Self, BoardError> {
        let flash = FlashArray::holding(options.flash.as_deref().unwrap_or_default());
        let sensor = Mpu9250::new(options.sensor, options.sensor_fault, world);
        let around = Surroundings {
            sensor: Arc::new(Mutex::new(sensor)),
            serial: SerialWire::default(),
            flash: Arc::new(Mutex::new(flash)),
            core: SharedCore::default(),
            timing: options.flash_timing,
            led: LedLog::default(),
        };
        let mut board = Self {
            run: None,
            shared: Shared::default(),
            symbols: Symbols::default(),
            options,
            around,
            epoch_s: 0.0,
            epoch_instructions: 0,
            led: Vec::new(),
        };
        board.load(elf)?;
        board.power_on()?;
        Ok(board)
    }

    /// Puts another firmware in, as a probe does: only the sectors it occupies are erased. Power-cycles.
    pub fn flash_firmware(&mut self, elf: &[u8]) -> Result<(), BoardError> {
        self.power_off();
        self.load(elf)?;
        self.power_on()
    }

    fn load(&mut self, elf: &[u8]) -> Result<(), BoardError> {
        let refused = |error: String| BoardError(error);
        let image =
            Image::new(Path::new("firmware"), elf.to_vec(), None).map_err(|error| refused(error.to_string()))?;
        self.symbols =
            Symbols::read(elf, rigless::cpu::armv7m::code_address).map_err(|error| refused(error.to_string()))?;
        let mut flash = self.flash_cells();
        let cells = flash.bytes_mut();
        let spans: Vec<(usize, &[u8])> = image
            .segments()
            .filter_map(|(address, bytes)| Some((usize::try_from(address.checked_sub(FLASH_BASE)?).ok()?, bytes)))
            .collect();
        if let Some((start, bytes)) = spans.iter().find(|(start, bytes)| start + bytes.len() > FLASH_BYTES) {
            return Err(refused(format!(
                "the firmware has {} bytes at flash offset {start:#x}, past its end",
                bytes.len()
            )));
        }
        for (sector, size) in SECTOR_BYTES.into_iter().enumerate() {
            let from = sector_start(sector).expect("a sector");
            let to = from + size;
            if spans.iter().any(|(start, bytes)| *start < to && start + bytes.len() > from) {
                cells[from..to].fill(0xFF);
            }
        }
        for (start, bytes) in spans {
            cells[start..start + bytes.len()].copy_from_slice(bytes);
        }
        Ok(())
    }

    fn power_on(&mut self) -> Result<(), BoardError> {
        self.flash_cells().power_on();
        self.sensor().power_on(self.epoch_s);
        *self.around.serial.buffers() = crate::serial_wire::Buffers::default();
        let mut part = Part::new(self.around.clone()).map_err(|error| BoardError(error.to_string()))?;
        part.follow_sensor(VirtualNanos(0));
        let instructions_per_second = NonZeroU64::new(self.options.instructions_per_second)
            .ok_or_else(|| BoardError("instructions_per_second is zero".to_owned()))?;
        let machine = BlackPill { part, instructions_per_second, core: Arc::clone(&self.around.core) };
        let run = Run::start(machine, &self.around.flash, self.shared.clone()).map_err(BoardError)?;
        self.run = Some(run);
        self.paint_stack();
        Ok(())
    }

    /// Takes the supply away: RAM, registers and the sensor's state go, the flash stays.
    pub fn power_off(&mut self) {
        self.collect_led();
        self.epoch_s = self.now_s();
        self.epoch_instructions = self.instructions();
        self.run = None;
        if self.led() {
            self.led.push((self.epoch_s, false));
        }
    }

    /// Off for `off_s`, then on again.
    pub fn power_cycle(&mut self, off_s: f64) -> Result<(), BoardError> {
        self.power_off();
        self.epoch_s += off_s;
        self.power_on()
    }

    /// Has the power fail during the flash operation after `further` more have completed: a program leaves some
    /// of its bits unwritten, an erase leaves its sector in pieces.
    pub fn power_cut_at_flash_op(&mut self, further: u64) {
        self.flash_cells().cut_after(further);
    }

    /// Virtual seconds since the board was first powered.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.epoch_s + self.run.as_ref().map_or(0.0, |run| run.standing().at_ns as f64 * 1e-9)
    }

    /// Instructions retired since the board was first powered.
    #[must_use]
    pub fn instructions(&self) -> u64 {
        self.epoch_instructions + self.run.as_ref().map_or(0, |run| run.standing().instructions)
    }

    /// Runs for `seconds` of virtual time.
    pub fn run_for(&mut self, seconds: f64) -> Result<Stopped, BoardError> {
        self.run_until(self.now_s() + seconds)
    }

    /// Runs to board time `t_s`.
    pub fn run_until(&mut self, t_s: f64) -> Result<Stopped, BoardError> {
        let until_ns = ((t_s - self.epoch_s) * 1e9).round().max(0.0) as u64;
        let run = self.run.as_mut().ok_or_else(|| BoardError("it has no power".to_owned()))?;
        if self.around.flash.lock().expect("no panic holds it").dead() {
            return Ok(Stopped::PowerCut);
        }
        let standing = run.run_until(until_ns);
        if let Some(why) = &standing.ended {
            return Err(BoardError(why.clone()));
        }
        let early = standing.at_ns < until_ns;
        self.collect_led();
        Ok(match (self.flash_cells().dead(), early) {
            (true, _) => Stopped::PowerCut,
            (false, true) => Stopped::Hit,
            (false, false) => Stopped::OnTime,
        })
    }

    /// Puts bytes on the line to the board; they arrive at 460 800 baud, or at whatever its port is set to.
    pub fn serial_write(&mut self, bytes: &[u8]) {
        self.around.serial.buffers().to_board.extend(bytes);
    }

    /// What the board has sent since the last call.
    pub fn serial_read(&mut self) -> Vec<u8> {
        self.serial_read_timed().into_iter().map(|(_, byte)| byte).collect()
    }

    /// The same, each byte with the board time its stop bit ended.
    pub fn serial_read_timed(&mut self) -> Vec<(f64, u8)> {
        let bytes = std::mem::take(&mut self.around.serial.buffers().from_board);
        bytes.into_iter().map(|(at_ns, byte)| (self.epoch_s + at_ns as f64 * 1e-9, byte)).collect()
    }

    fn collect_led(&mut self) {
        let changes: Vec<LedChange> = std::mem::take(&mut *self.around.led.lock().expect("no panic holds it"));
        let epoch_s = self.epoch_s;
        for LedChange { t_ns, lit } in changes {
            if self.led() != lit {
                self.led.push((epoch_s + t_ns as f64 * 1e-9, lit));
            }
        }
    }

    /// Whether the LED is lit.
    #[must_use]
    pub fn led(&self) -> bool {
        self.led.last().is_some_and(|(_, lit)| *lit)
    }

    /// Every change of the LED since the board was first powered: board time, lit from then on.
    #[must_use]
    pub fn led_changes(&self) -> &[(f64, bool)] {
        &self.led
    }

    fn flash_cells(&self) -> MutexGuard<'_, FlashArray> {
        self.around.flash.lock().expect("no panic holds it")
    }

    /// The flash array as it stands: 512 KB from 0x0800_0000.
    #[must_use]
    pub fn flash(&self) -> Vec<u8> {
        self.flash_cells().bytes().to_vec()
    }

    /// Replaces the flash array's contents; the board is power-cycled, since a probe halts it to do so.
    pub fn set_flash(&mut self, image: &[u8]) -> Result<(), BoardError> {
        self.power_off();
        *self.flash_cells() = FlashArray::holding(image);
        self.power_on()
    }

    /// Program and erase operations so far, and erases among them.
    #[must_use]
    pub fn flash_operations(&self) -> (u64, u64) {
        let cells = self.flash_cells();
        (cells.operations(), cells.erases())
    }

    fn sensor(&self) -> MutexGuard<'_, Mpu9250> {
        self.around.sensor.lock().expect("no panic holds it")
    }

    /// The chip, shared with the run: look at it only between stretches.
    #[must_use]
    pub fn sensor_handle(&self) -> SharedSensor {
        Arc::clone(&self.around.sensor)
    }

    /// Makes something wrong with the sensor from now on, or right again with `None`.
    pub fn inject_fault(&mut self, fault: Option<SensorFault>) {
        self.sensor().set_fault(fault);
        self.follow_sensor();
    }

    /// Puts the sensor into another world from now on.
    pub fn set_world(&mut self, world: Box<dyn SensorWorld>) {
        self.sensor().set_world(world);
        self.follow_sensor();
    }

    fn follow_sensor(&self) {
        if let Some(run) = &self.run {
            let at = VirtualNanos(run.standing().at_ns);
            run.at_stop(move |session, _| session.board_mut().part.follow_sensor(at));
        }
    }

    /// Samples the sensor has taken since it was first powered.
    #[must_use]
    pub fn sensor_samples(&self) -> u64 {
        self.sensor().samples()
    }
}
