//! The calibration in force, and its way into and out of flash.

use tumble_core::calibration::AcceptedCalibration;
use tumble_core::message::{CalibrationState, Trouble};
use tumble_core::procedure::Stored;
use tumble_core::record::{self, FirmwareVersion, Origin, Record, RecordError};

use crate::board::ParameterFlash;
use crate::flash::SafeFlash;
use crate::store::{Failure, Store};

/// Keeps it.
pub struct Keeper {
    store: Store<SafeFlash>,
    record: Option<Record>,
    readable: bool,
    /// WHO_AM_I of the sensor that answers; none until it has.
    fitted: Option<u8>,
}

impl Keeper {
    /// Nothing is read yet.
    pub fn new(flash: ParameterFlash) -> Self {
        Self { store: Store::new(SafeFlash(flash)), record: None, readable: true, fitted: None }
    }

    /// A sensor has answered: from now on a calibration of another kind of sensor is not in force.
    pub fn fit(&mut self, whoami: u8) {
        self.fitted = Some(whoami);
    }

    /// Reads what is in flash; it is in force from now on. What cannot be read is left there.
    pub async fn load(&mut self) -> Result<(), Trouble> {
        self.record = None;
        self.readable = false;
        let bytes = self.store.load().await.map_err(|failure| trouble(failure, "reading the calibration"))?;
        self.record = bytes.map(record::decode).transpose().map_err(Trouble::Record)?;
        self.readable = true;
        Ok(())
    }

    /// Writes a calibration, reads it back and puts it in force. If that fails, the one before stays in force.
    pub async fn store(&mut self, origin: Origin, calibration: &AcceptedCalibration) -> Result<Stored, Trouble> {
        let origin = Origin { generation: self.generation().saturating_add(1), ..origin };
        let bytes = record::encode(&origin, calibration).map_err(Trouble::Record)?;
        self.store.save(&bytes).await.map_err(|failure| trouble(failure, "writing the calibration"))?;
        self.load().await?;
        Ok(Stored { generation: self.generation(), bytes: u16::try_from(bytes.len()).unwrap_or(u16::MAX) })
    }

    /// Forgets it.
    pub async fn forget(&mut self) -> Result<(), Trouble> {
        self.store.forget().await.map_err(|failure| trouble(failure, "erasing the calibration"))?;
        self.record = None;
        self.readable = true;
        Ok(())
    }

    /// What compensates.
    pub fn in_force(&self) -> Option<&Record> {
        self.record.as_ref().filter(|record| self.fitted.is_none_or(|whoami| whoami == record.origin.whoami))
    }

    /// As in `@hello`.
    pub fn state(&self) -> CalibrationState {
        match (self.readable, &self.record) {
            (false, _) => CalibrationState::Unreadable,
            (true, None) => CalibrationState::None,
            (true, Some(_)) if self.in_force().is_none() => CalibrationState::OtherSensor,
            (true, Some(_)) => CalibrationState::Stored,
        }
    }

    fn generation(&self) -> u32 {
        self.record.map_or(0, |record| record.origin.generation)
    }
}

/// This firmware's version.
pub fn firmware_version() -> FirmwareVersion {
    FirmwareVersion::parse(env!("CARGO_PKG_VERSION"))
}

fn trouble(failure: Failure, doing: &'static str) -> Trouble {
    match failure {
        Failure::Flash => Trouble::Flash { doing },
        Failure::ReadBack => Trouble::Flash { doing: "reading back what it wrote" },
        Failure::Foreign => Trouble::Record(RecordError::NotARecord),
        Failure::TooLarge => Trouble::Record(RecordError::TooLarge),
    }
}
