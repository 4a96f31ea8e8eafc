//! What can go wrong, where, and what to do about it.

use core::fmt::{self, Write};

use super::words::Underscored;
use crate::command::{Command, CommandError};
use crate::record::RecordError;

/// Something failed. [`Self::code`] is also the LED's blink count; 0 is a word that cannot be followed, which the LED does
/// not show.
#[derive(Clone, Debug, PartialEq)]
pub enum Trouble {
    /// A line that is no command.
    Word(CommandError),
    /// A command that makes no sense at the moment.
    NotNow {
        /// Which.
        command: Command,
        /// Why, as a sentence with its remedy.
        why: &'static str,
    },
    /// No calibration is in force.
    NoCalibration,
    /// Nothing answers on the bus.
    SensorMissing {
        /// What was read in place of an identity.
        whoami: u8,
    },
    /// Something answers that is no sensor of the family.
    SensorForeign {
        /// Its identity.
        whoami: u8,
    },
    /// No data-ready edge came.
    DataReadyStuck {
        /// How long was waited, ms.
        waited_ms: u32,
    },
    /// The bus failed.
    Bus {
        /// What was being done.
        doing: &'static str,
    },
    /// A register does not read back as it was written.
    Register {
        /// Its address.
        address: u8,
        /// What was written.
        wrote: u8,
        /// What was read.
        read: u8,
    },
    /// The flash failed.
    Flash {
        /// What was being done.
        doing: &'static str,
    },
    /// The record in flash cannot be used.
    Record(RecordError),
    /// The session's memory is full.
    MemoryFull,
}

impl Trouble {
    /// The LED's blink count, 0 for none.
    pub fn code(&self) -> u8 {
        match self {
            Self::Word(_) | Self::NotNow { .. } | Self::NoCalibration => 0,
            Self::SensorMissing { .. } => 1,
            Self::SensorForeign { .. } => 2,
            Self::DataReadyStuck { .. } => 3,
            Self::Bus { .. } | Self::Register { .. } => 4,
            Self::Flash { .. } | Self::Record(_) => 5,
            Self::MemoryFull => 6,
        }
    }

    fn thing(&self) -> &'static str {
        match self {
            Self::Word(_) | Self::NotNow { .. } => "command",
            Self::NoCalibration => "calibration",
            Self::SensorMissing { .. } | Self::SensorForeign { .. } => "sensor",
            Self::DataReadyStuck { .. } => "data_ready",
            Self::Bus { .. } => "bus",
            Self::Register { .. } => "register",
            Self::Flash { .. } => "flash",
            Self::Record(_) => "record",
            Self::MemoryFull => "memory",
        }
    }

    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        write!(w, "@error code={} thing={} detail=", self.code(), self.thing())?;
        let mut w = Underscored(w);
        match self {
            Self::NotNow { command, .. } => write!(w, "{}_not_now", command.name()),
            Self::SensorMissing { whoami } | Self::SensorForeign { whoami } => write!(w, "whoami_{whoami:#04x}"),
            Self::DataReadyStuck { waited_ms } => write!(w, "none_for_{waited_ms}_ms"),
            Self::Register { address, wrote, read } => {
                write!(w, "{address:#04x}_wrote_{wrote:#04x}_read_{read:#04x}")
            }
            Self::Bus { doing } | Self::Flash { doing } => w.write_str(doing),
            Self::Word(error) => write!(w, "{error}"),
            Self::Record(error) => write!(w, "{error}"),
            Self::NoCalibration => w.write_str("none_in_force"),
            Self::MemoryFull => w.write_str("session_memory_full"),
        }
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        match self {
            Self::Word(error) => write!(w, "{error}"),
            Self::NotNow { command, why } => write!(w, "\"{}\" cannot be done now. {why}", command.name()),
            Self::NoCalibration => w.write_str("There is no calibration in force. Type \"calibrate\" to make one."),
            Self::SensorMissing { whoami } => write!(
                w,
                "No sensor answers (its identity reads {whoami:#04x}). Check the power of the sensor board and the wires NCS to \
                 PA4, SCL to PA5, AD0 to PA6 and SDA to PA7, then press reset."
            ),
            Self::SensorForeign { whoami } => write!(
                w,
                "A sensor answers with identity {whoami:#04x}, which is none I know (0x70 MPU6500, 0x71 MPU9250, 0x73 MPU9255). \
                 Use one of these."
            ),
            Self::DataReadyStuck { waited_ms } => write!(
                w,
                "The sensor answers but has reported no new sample for {waited_ms} ms. Check the wire from its INT to PB0, then \
                 press reset."
            ),
            Self::Bus { doing } => write!(
                w,
                "The wires to the sensor failed while {doing}. Check that they are short and firm, then press reset."
            ),
            Self::Register { address, wrote, read } => write!(
                w,
                "The sensor's register {address:#04x} was set to {wrote:#04x} but reads {read:#04x}. Check the wires and the \
                 sensor's power, then press reset; if it stays so, replace the sensor."
            ),
            Self::Flash { doing } => write!(
                w,
                "The flash failed while {doing}. Keep the power steady and try again; if it stays so, the chip's flash is worn out."
            ),
            Self::Record(error) => write!(w, "The calibration in flash cannot be used, and is left untouched: {error}"),
            Self::MemoryFull => w.write_str("The session's memory is full; from here on nothing more is recorded."),
        }
    }
}
