//! What can go wrong, with the register, what was written and what was read.

use core::fmt;

use crate::identity::Refused;
use crate::register::Register;

/// A failed operation. `E` is the bus' own error.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Error<E> {
    /// The transfer itself failed.
    Bus {
        /// The first register of the transfer.
        register: Register,
        /// What the bus says.
        cause: E,
    },
    /// The part is missing or is another one.
    Identity(Refused),
    /// A register does not hold what was written to it.
    ReadBack {
        /// Which.
        register: Register,
        /// What was written.
        written: u8,
        /// What came back.
        read: u8,
    },
    /// The status byte holds bits the part never sets: what came is not a reading.
    NotAReading {
        /// `INT_STATUS` as read.
        status: u8,
    },
    /// No new reading within the time in which several should have come.
    NoData {
        /// How often the status was read.
        polls: u16,
    },
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus { register, cause } => {
                write!(f, "the SPI transfer at {register} failed: {cause:?}; check the wires and their length")
            }
            Self::Identity(refused) => refused.fmt(f),
            Self::ReadBack { register, written, read } => write!(
                f,
                "{register} was written 0x{written:02X} and reads 0x{read:02X}; check the wires and the 3.3 V"
            ),
            Self::NotAReading { status } => write!(
                f,
                "{} reads 0x{status:02X}, which no sensor sends; check MISO, NCS and the 3.3 V",
                Register::INT_STATUS
            ),
            Self::NoData { polls } => write!(
                f,
                "{} showed no new data in {polls} reads; the sensor does not sample: power it off and on",
                Register::INT_STATUS
            ),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}
