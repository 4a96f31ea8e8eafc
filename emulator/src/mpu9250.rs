//! The MPU-9250 as its register map describes it (RM-MPU-9250A-00 rev 1.6), with its own oscillator.
//!
//! Times here are nanoseconds of the run since power-on; `epoch_s` makes them the world's seconds. The chip takes
//! a sample at each instant of its own sample clock, or of the world's time-stamps. What a firmware can see:
//! registers, the serial protocol, the INT pin and its latch, start-up time, and the self-test.

mod convert;
mod pin;
mod registers;
mod serial;
#[cfg(test)]
mod tests;

use crate::world::SensorWorld;
use registers as reg;

/// What can be wrong with the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensorFault {
    /// Nothing on the bus; MISO floats to this level (all ones or all zeros).
    Missing { miso_high: bool },
    /// `WHO_AM_I` answers this.
    Foreign { who_am_i: u8 },
    /// Samples are taken and INT never rises.
    DataReadyStuck,
    /// From this board time on, MISO carries noise.
    Garbage { from_s: f64 },
    /// From this board time on, the chip is as if unplugged.
    Lost { from_s: f64, miso_high: bool },
}

/// One particular chip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorOptions {
    pub who_am_i: u8,
    /// The chip's oscillator against nominal: +0.01 samples 1 % faster.
    pub clock_error: f64,
    /// Factory self-test codes: gyroscope x, y, z, accelerometer x, y, z. Zero is a part without trim.
    pub self_test_codes: [u8; 6],
    /// Self-test response over the factory's, in the same order.
    pub self_test_response: [f64; 6],
    /// How long registers answer nothing after power-on or reset: 11 ms typical, 100 ms at most (PS 3.1).
    pub start_up_ns: u64,
}

impl Default for SensorOptions {
    fn default() -> Self {
        Self {
            who_am_i: 0x71,
            clock_error: 0.0,
            self_test_codes: [0x40, 0x3E, 0x44, 0x5A, 0x58, 0x60],
            self_test_response: [1.0; 6],
            start_up_ns: 11_000_000,
        }
    }
}

pub struct Mpu9250 {
    options: SensorOptions,
    fault: Option<SensorFault>,
    world: Box<dyn SensorWorld>,
    epoch_s: f64,
    registers: [u8; reg::COUNT],
    /// What the data registers become at the next select: a burst never mixes two samples.
    fresh: Option<[u8; reg::DATA_BYTES]>,
    /// When the sample clock last started.
    clock_start_ns: u64,
    /// The newest sample taken by being read.
    seen_ns: u64,
    /// The sample instant last answered by [`Mpu9250::next_event_ns`].
    due_ns: Option<u64>,
    /// Until when registers answer nothing.
    asleep_until_ns: u64,
    pulse_until_ns: u64,
    serial: serial::Serial,
    samples: u64,
}

impl std::fmt::Debug for Mpu9250 {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Mpu9250").field("options", &self.options).finish_non_exhaustive()
    }
}

impl Mpu9250 {
    #[must_use]
    pub fn new(options: SensorOptions, fault: Option<SensorFault>, world: Box<dyn SensorWorld>) -> Self {
        let mut chip = Self {
            options,
            fault,
            world,
            epoch_s: 0.0,
            registers: [0; reg::COUNT],
            fresh: None,
            clock_start_ns: 0,
            seen_ns: 0,
            due_ns: None,
            asleep_until_ns: 0,
            pulse_until_ns: 0,
            serial: serial::Serial::default(),
            samples: 0,
        };
        chip.power_on(0.0);
        chip
    }

    /// The supply comes up at `epoch_s` of the world's time, which is nanosecond 0 of the run.
    pub fn power_on(&mut self, epoch_s: f64) {
        self.epoch_s = epoch_s;
        self.reset(0);
    }

    pub fn set_fault(&mut self, fault: Option<SensorFault>) {
        self.fault = fault;
    }

    pub fn set_world(&mut self, world: Box<dyn SensorWorld>) {
        self.world = world;
    }

    /// Samples taken since power-on.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.samples
    }

    fn seconds(&self, now_ns: u64) -> f64 {
        self.epoch_s + now_ns as f64 * 1e-9
    }

    fn reset(&mut self, now_ns: u64) {
        self.registers = reg::defaults(&self.options);
        self.fresh = None;
        self.due_ns = None;
        self.pulse_until_ns = 0;
        self.asleep_until_ns = now_ns + self.options.start_up_ns;
        self.seen_ns = 0;
        self.restart_clock(self.asleep_until_ns);
    }

    fn restart_clock(&mut self, now_ns: u64) {
        self.clock_start_ns = now_ns;
    }

    /// Whether the sample clock runs: not asleep, and not with its clock held in reset.
    fn sampling(&self) -> bool {
        let power = self.registers[reg::PWR_MGMT_1];
        power & reg::SLEEP == 0 && power & reg::CLKSEL != reg::CLOCK_STOPPED
    }

    fn period_ns(&self) -> f64 {
        let nominal_hz = reg::sample_rate_hz(&self.registers);
        1e9 / (nominal_hz * (1.0 + self.options.clock_error))
    }

    /// When the chip next has something to do of its own: take a sample that raises INT, or end a pulse.
    /// With its interrupt off it samples when it is read instead, since nothing can tell the difference and an
    /// unconfigured chip runs at 8 kHz.
    pub fn next_event_ns(&mut self, now_ns: u64) -> Option<u64> {
        let pulses = self.registers[reg::INT_PIN_CFG] & reg::LATCH == 0 && self.pulse_until_ns > now_ns;
        let pulse = pulses.then_some(self.pulse_until_ns);
        let announces = self.registers[reg::INT_ENABLE] & reg::RAW_DATA_RDY != 0;
        self.due_ns = (announces && self.sampling()).then(|| self.next_sample_ns(now_ns)).flatten();
        match (pulse, self.due_ns) {
            (Some(pulse), Some(sample)) => Some(pulse.min(sample)),
            (one, other) => one.or(other),
        }
    }

    /// The first sample instant after `now_ns`.
    fn next_sample_ns(&mut self, now_ns: u64) -> Option<u64> {
        let after = now_ns.max(self.asleep_until_ns);
        // A time-stamp is rounded to a nanosecond, so what lies within half of one has been sampled already.
        if let Some(at_s) = self.world.next_sample_time(self.seconds(after) + 0.6e-9) {
            let ns = ((at_s - self.epoch_s) * 1e9).round();
            return (ns.is_finite() && ns >= 0.0).then(|| (ns as u64).max(after + 1));
        }
        let tick = self.ticks_by(after) + 1;
        Some(self.tick_ns(tick))
    }

    fn tick_ns(&self, tick: u64) -> u64 {
        self.clock_start_ns + (tick as f64 * self.period_ns()).round() as u64
    }

    /// Sample instants that have come by `now_ns` since the clock last started.
    fn ticks_by(&self, now_ns: u64) -> u64 {
        let elapsed = now_ns.saturating_sub(self.clock_start_ns) as f64;
        let mut ticks = (elapsed / self.period_ns()).floor() as u64;
        // The rounding of `tick_ns` may put the instant half a nanosecond either side.
        while self.tick_ns(ticks + 1) <= now_ns {
            ticks += 1;
        }
        while ticks > 0 && self.tick_ns(ticks) > now_ns {
            ticks -= 1;
        }
        ticks
    }

    /// An instant from [`Mpu9250::next_event_ns`] came.
    pub fn on_event(&mut self, now_ns: u64) {
        if self.due_ns == Some(now_ns) {
            self.due_ns = None;
            self.take_sample(now_ns);
        }
    }

    /// With the interrupt off: takes the newest sample due by `now_ns`, if one is.
    fn catch_up(&mut self, now_ns: u64) {
        if !self.sampling() || now_ns < self.asleep_until_ns {
            return;
        }
        if self.registers[reg::INT_ENABLE] & reg::RAW_DATA_RDY != 0 {
            return;
        }
        if let Some(newest) = self.newest_by(now_ns) {
            self.seen_ns = newest;
            self.take_sample(newest);
        }
    }

    /// The newest sample instant up to `now_ns` that has not been taken.
    fn newest_by(&mut self, now_ns: u64) -> Option<u64> {
        let mut at = self.seen_ns.max(self.clock_start_ns);
        if self.world.next_sample_time(self.seconds(at)).is_none() {
            let newest = self.tick_ns(self.ticks_by(now_ns));
            return (newest > at).then_some(newest);
        }
        let mut newest = None;
        while let Some(next) = self.next_sample_ns(at).filter(|next| *next <= now_ns) {
            newest = Some(next);
            at = next;
        }
        newest
    }

    fn take_sample(&mut self, at_ns: u64) {
        self.samples += 1;
        let physical = self.world.sample(self.seconds(at_ns));
        self.fresh = Some(convert::counts(&physical, &self.registers, &self.options));
        self.registers[reg::INT_STATUS] |= reg::RAW_DATA_RDY;
        if self.registers[reg::INT_ENABLE] & reg::RAW_DATA_RDY != 0 {
            self.pulse_until_ns = at_ns + pin::PULSE_NS;
        }
        if !self.serial.selected() {
            self.show_fresh();
        }
    }

    fn show_fresh(&mut self) {
        if let Some(data) = self.fresh.take() {
            self.registers[reg::ACCEL_XOUT_H..reg::ACCEL_XOUT_H + reg::DATA_BYTES].copy_from_slice(&data);
        }
    }
}
