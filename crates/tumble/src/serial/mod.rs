//! The board at the other end of a serial line (`docs/protocol.md`).

mod capture;
mod console;
mod lines;
mod verify;

use std::time::Duration;

use serialport::SerialPort;
use thiserror::Error;

pub use capture::{Capture, record};
pub use console::console;
pub(crate) use lines::value;
pub use lines::{Line, Lines};
pub use verify::{Verified, verify};

/// The board's speed: text at 200 Hz does not fit 115 200.
pub const BAUD: u32 = 460_800;
/// How long a read waits; short, so that a person who wants to end it does not wait.
const READ_TIMEOUT: Duration = Duration::from_millis(50);

/// What can go wrong with a board.
#[derive(Debug, Error)]
pub enum SerialError {
    /// The port does not open.
    #[error("{port}: {error}. Remedy: check the cable, the name (ls /dev/tty*) and the permission (group dialout)")]
    Open {
        /// As the person named it.
        port: String,
        /// What the system says.
        error: serialport::Error,
    },
    /// It broke off.
    #[error("the line to the board broke off: {0}. Remedy: check cable and power")]
    Broken(#[from] std::io::Error),
    /// Nothing that was expected came.
    #[error(
        "the board sent {what} within {seconds} s. Remedy: check power, wiring (TX to RX) and that it runs Tumble's firmware"
    )]
    Silent {
        /// What was waited for, as `no frame`.
        what: &'static str,
        /// How long.
        seconds: u64,
    },
    /// It started again while something went on.
    #[error("the board started again while it was recorded. Remedy: check its power; record again")]
    Restarted,
    /// The board itself refused.
    #[error("the board answered: {0}")]
    Refused(String),
}

/// Opens a port at the board's speed.
pub fn open(port: &str) -> Result<Box<dyn SerialPort>, SerialError> {
    serialport::new(port, BAUD)
        .timeout(READ_TIMEOUT)
        .open()
        .map_err(|error| SerialError::Open { port: port.into(), error })
}
