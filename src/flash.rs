//! The parameter sectors as an async flash that never erases under a running stream.

use embassy_stm32::flash::Error;
use embassy_time::{Duration, Timer, with_timeout};
use embedded_storage_async::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

use crate::board::{PARAMETER_RANGE, ParameterFlash};
use crate::shared::{PAUSED, RESUME, SENSOR_REQUEST, SESSION_ALIVE, SensorRequest};

/// Time for sampling to stop: it may be within its start-up (0.4 s).
const STOP_TIMEOUT: Duration = Duration::from_millis(1000);
/// Between two sectors, for the supervisor to feed the watchdog.
const BREATH: Duration = Duration::from_millis(600);

/// Addresses count from the start of the first parameter sector.
pub struct SafeFlash(pub ParameterFlash);

impl ErrorType for SafeFlash {
    type Error = Error;
}

impl ReadNorFlash for SafeFlash {
    const READ_SIZE: usize = <ParameterFlash as embedded_storage::nor_flash::ReadNorFlash>::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Error> {
        self.0.blocking_read(PARAMETER_RANGE.start + offset, bytes)
    }

    fn capacity(&self) -> usize {
        PARAMETER_RANGE.len()
    }
}

impl NorFlash for SafeFlash {
    const WRITE_SIZE: usize = <ParameterFlash as embedded_storage::nor_flash::NorFlash>::WRITE_SIZE;
    const ERASE_SIZE: usize = <ParameterFlash as embedded_storage::nor_flash::NorFlash>::ERASE_SIZE;

    /// The core stands still for 2 to 4 s a sector and the clock loses that time, so sampling is stopped before and
    /// resumed after.
    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Error> {
        PAUSED.reset();
        SENSOR_REQUEST.signal(SensorRequest::Pause);
        if with_timeout(STOP_TIMEOUT, PAUSED.wait()).await.is_err() {
            defmt::warn!("sampling did not stop for an erase; samples will be lost");
        }
        let mut result = Ok(());
        for sector in (from..to).step_by(Self::ERASE_SIZE) {
            SESSION_ALIVE.show();
            Timer::after(BREATH).await;
            let start = PARAMETER_RANGE.start + sector;
            result = self.0.blocking_erase(start, start + Self::ERASE_SIZE as u32);
            if result.is_err() {
                break;
            }
        }
        RESUME.signal(());
        result
    }

    /// 16 µs a word: a record takes some 3 ms.
    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Error> {
        self.0.blocking_write(PARAMETER_RANGE.start + offset, bytes)
    }
}
