//! The serial protocol: an address with its direction bit, then bytes at consecutive addresses.

use super::registers as reg;
use super::{Mpu9250, SensorFault};

const READ: u8 = 0x80;

/// Where a transaction stands.
#[derive(Debug, Default)]
pub(super) struct Serial {
    selected: bool,
    /// The direction and the next address, once the first byte has come.
    command: Option<(bool, usize)>,
    noise: u32,
}

impl Serial {
    pub(super) fn selected(&self) -> bool {
        self.selected
    }

    /// A byte of noise: a 32-bit xorshift, so that a run repeats.
    fn garbage(&mut self) -> u8 {
        let mut state = if self.noise == 0 { 0x2545_F491 } else { self.noise };
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        self.noise = state;
        (state >> 24) as u8
    }
}

impl Mpu9250 {
    /// NCS fell.
    pub fn select(&mut self, now_ns: u64) {
        self.catch_up(now_ns);
        self.show_fresh();
        self.serial.selected = true;
        self.serial.command = None;
    }

    /// NCS rose.
    pub fn deselect(&mut self) {
        self.serial.selected = false;
        self.serial.command = None;
        self.show_fresh();
    }

    /// One byte each way.
    pub fn transfer(&mut self, mosi: u8, now_ns: u64) -> u8 {
        if let Some(silent) = self.silent(now_ns) {
            return silent;
        }
        let answer = match self.serial.command {
            None => {
                self.serial.command = Some((mosi & READ != 0, usize::from(mosi & !READ)));
                0
            }
            Some((read, address)) => {
                // The FIFO's port does not advance: every byte of a burst comes from it.
                let next = if address == reg::FIFO_R_W { address } else { (address + 1) % reg::COUNT };
                self.serial.command = Some((read, next));
                if read {
                    self.read_register(address)
                } else {
                    self.write_register(address, mosi, now_ns);
                    0
                }
            }
        };
        match self.fault {
            Some(SensorFault::Garbage { from_s }) if self.seconds(now_ns) >= from_s => self.serial.garbage(),
            _ => answer,
        }
    }

    /// What MISO carries while nothing drives it, or `None` when the chip does.
    fn silent(&self, now_ns: u64) -> Option<u8> {
        match self.fault {
            Some(SensorFault::Missing { miso_high }) => Some(if miso_high { 0xFF } else { 0 }),
            Some(SensorFault::Lost { miso_high, .. }) if self.lost(now_ns) => Some(if miso_high { 0xFF } else { 0 }),
            _ if now_ns < self.asleep_until_ns => Some(0),
            _ => None,
        }
    }

    fn read_register(&mut self, address: usize) -> u8 {
        let value = match self.fault {
            Some(SensorFault::Foreign { who_am_i }) if address == reg::WHO_AM_I => who_am_i,
            _ => self.registers[address],
        };
        if address == reg::INT_STATUS || self.registers[reg::INT_PIN_CFG] & reg::ANY_READ_CLEARS != 0 {
            self.registers[reg::INT_STATUS] = 0;
        }
        value
    }

    fn write_register(&mut self, address: usize, value: u8, now_ns: u64) {
        if address == reg::PWR_MGMT_1 && value & reg::H_RESET != 0 {
            return self.reset(now_ns);
        }
        let Some(stored) = reg::stored(address, value) else {
            return;
        };
        let rate = reg::sample_rate_hz(&self.registers);
        let was_sampling = self.sampling();
        self.registers[address] = stored;
        if address == reg::USER_CTRL && value & reg::SIG_COND_RST != 0 {
            self.registers[reg::ACCEL_XOUT_H..reg::ACCEL_XOUT_H + reg::DATA_BYTES].fill(0);
        }
        // The divider restarts when the rate or the clock does.
        if rate != reg::sample_rate_hz(&self.registers) || was_sampling != self.sampling() {
            self.restart_clock(now_ns);
        }
    }
}
