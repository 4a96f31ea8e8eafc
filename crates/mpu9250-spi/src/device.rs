//! Start-up, read-back and the burst.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::SpiDevice;

use crate::configuration::{Configuration, RESET};
use crate::error::Error;
use crate::identity::Identity;
use crate::reading::Reading;
use crate::register::{READ, Register};

/// From power-on to the first register access: 11 ms typical, 100 ms at most (product specification, table 3,
/// "Start-up time for register read/write").
const POWER_ON_MS: u32 = 100;
/// After a reset (register map, 4.35: wait before touching it again).
const RESET_MS: u32 = 100;
/// After the signal paths' reset and the change of clock: the gyroscope's start-up is 35 ms (table 1).
const SETTLE_MS: u32 = 50;

/// The part on its bus.
pub struct Mpu9250<S, D> {
    spi: S,
    delay: D,
}

impl<S: SpiDevice, D: DelayNs> Mpu9250<S, D> {
    /// Nothing is sent yet. Mode 0 or 3, at most 1 MHz (configuration registers; 20 MHz only for readings).
    pub fn new(spi: S, delay: D) -> Self {
        Self { spi, delay }
    }

    /// The bus and the delay back.
    pub fn release(self) -> (S, D) {
        (self.spi, self.delay)
    }

    /// Wait, reset, identity, signal path reset, configuration with read-back. May be called again at any time, to
    /// bring back a part that lost power.
    pub async fn start(&mut self, configuration: &Configuration) -> Result<Identity, Error<S::Error>> {
        self.delay.delay_ms(POWER_ON_MS).await;
        self.write(Register::PWR_MGMT_1, RESET).await?;
        self.delay.delay_ms(RESET_MS).await;
        let identity = self.identity().await?;
        // Before the configuration, because it may clear registers besides the paths; it clears itself, and so is
        // the one write that is not read back.
        self.write(Register::SIGNAL_PATH_RESET, 0x07).await?;
        self.delay.delay_ms(RESET_MS).await;
        self.configure(configuration).await?;
        self.delay.delay_ms(SETTLE_MS).await;
        Ok(identity)
    }

    /// Reads and judges `WHO_AM_I`.
    pub async fn identity(&mut self) -> Result<Identity, Error<S::Error>> {
        let who_am_i = self.read_register(Register::WHO_AM_I).await?;
        Identity::judge(who_am_i).map_err(Error::Identity)
    }

    /// Writes every register of `configuration` and reads each back.
    pub async fn configure(&mut self, configuration: &Configuration) -> Result<(), Error<S::Error>> {
        for (register, value) in configuration.writes() {
            self.write_checked(register, value).await?;
        }
        Ok(())
    }

    /// Reads every register of `configuration` without writing: a part whose supply dipped has forgotten them.
    pub async fn check(&mut self, configuration: &Configuration) -> Result<(), Error<S::Error>> {
        for (register, written) in configuration.writes() {
            self.expect(register, written).await?;
        }
        Ok(())
    }

    /// Status, accelerometer, temperature and gyroscope in one burst, which also lowers the latched INT. The caller
    /// looks at [`crate::Status::is_fresh`].
    pub async fn read(&mut self) -> Result<Reading, Error<S::Error>> {
        let register = Register::INT_STATUS;
        let mut bytes = [0; 1 + Reading::LENGTH];
        bytes[0] = register.0 | READ;
        self.spi.transfer_in_place(&mut bytes).await.map_err(|cause| Error::Bus { register, cause })?;
        let [_, reading @ ..] = bytes;
        let reading = Reading::decode(&reading);
        if !reading.status.is_possible() {
            return Err(Error::NotAReading { status: reading.status.0 });
        }
        Ok(reading)
    }

    pub(crate) async fn write_checked(&mut self, register: Register, value: u8) -> Result<(), Error<S::Error>> {
        self.write(register, value).await?;
        self.expect(register, value).await
    }

    async fn expect(&mut self, register: Register, written: u8) -> Result<(), Error<S::Error>> {
        let read = self.read_register(register).await?;
        if read == written { Ok(()) } else { Err(Error::ReadBack { register, written, read }) }
    }

    async fn write(&mut self, register: Register, value: u8) -> Result<(), Error<S::Error>> {
        self.spi.write(&[register.0, value]).await.map_err(|cause| Error::Bus { register, cause })
    }

    pub(crate) async fn read_register(&mut self, register: Register) -> Result<u8, Error<S::Error>> {
        let mut bytes = [register.0 | READ, 0];
        self.spi.transfer_in_place(&mut bytes).await.map_err(|cause| Error::Bus { register, cause })?;
        Ok(bytes[1])
    }

    pub(crate) async fn delay_ms(&mut self, ms: u32) {
        self.delay.delay_ms(ms).await;
    }
}
