//! The INT pin, which follows the registers.

use super::registers as reg;
use super::{Mpu9250, SensorFault};

/// An unlatched interrupt is a pulse of 50 µs (RM, `INT_PIN_CFG`).
pub(super) const PULSE_NS: u64 = 50_000;

impl Mpu9250 {
    /// Whether the INT pin is at its high level.
    #[must_use]
    pub fn int_high(&self, now_ns: u64) -> bool {
        let absent = matches!(self.fault, Some(SensorFault::Missing { .. } | SensorFault::DataReadyStuck));
        if absent || self.lost(now_ns) {
            return false;
        }
        let config = self.registers[reg::INT_PIN_CFG];
        let flagged = self.registers[reg::INT_STATUS] & self.registers[reg::INT_ENABLE] & reg::RAW_DATA_RDY != 0;
        let latched = config & reg::LATCH != 0;
        let active = flagged && (latched || now_ns < self.pulse_until_ns);
        active != (config & reg::ACTIVE_LOW != 0)
    }

    pub(super) fn lost(&self, now_ns: u64) -> bool {
        matches!(self.fault, Some(SensorFault::Lost { from_s, .. }) if self.seconds(now_ns) >= from_s)
    }
}
