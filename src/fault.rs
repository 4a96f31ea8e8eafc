//! What can be wrong with the sensor and its wires, and how it is told.

use embedded_hal_async::spi::ErrorType;
use mpu9250_spi::Error;
use tumble_core::message::Trouble;

use crate::board::SensorBus;

/// The driver's error on our bus.
pub type SensorError = Error<<SensorBus as ErrorType>::Error>;

/// Why there are no samples.
#[derive(Clone, Copy)]
pub enum Fault {
    /// The driver says it.
    Sensor(SensorError),
    /// A burst did not end.
    TransferHangs,
    /// INT stays low although data are ready.
    DataReadyLow,
    /// INT stays high although no data are ready.
    DataReadyHigh,
    /// INT stays low, and rightly: the sensor takes no readings.
    Silent,
}

impl Fault {
    /// As it is told, with its remedy.
    pub fn trouble(&self) -> Trouble {
        match *self {
            Self::Sensor(Error::Identity(refused)) if refused.is_absent() => {
                Trouble::SensorMissing { whoami: refused.who_am_i }
            }
            Self::Sensor(Error::Identity(refused)) => Trouble::SensorForeign { whoami: refused.who_am_i },
            Self::Sensor(Error::ReadBack { register, written, read }) => {
                Trouble::Register { address: register.0, wrote: written, read }
            }
            Self::Sensor(Error::Bus { .. }) => Trouble::Bus { doing: "moving bytes" },
            Self::Sensor(Error::NotAReading { .. }) => Trouble::Bus { doing: "reading a sample" },
            Self::TransferHangs => Trouble::Bus { doing: "waiting for a transfer to end" },
            Self::Sensor(Error::NoData { .. }) | Self::DataReadyLow | Self::DataReadyHigh | Self::Silent => {
                Trouble::DataReadyStuck { waited_ms: 100 }
            }
        }
    }

    /// In one word or more for the log, where no person reads it.
    pub fn log(&self) {
        match self {
            Self::Sensor(error) => defmt::warn!("sensor: {}", defmt::Display2Format(error)),
            Self::TransferHangs => defmt::warn!("a transfer did not end"),
            Self::DataReadyLow => defmt::warn!("INT stays low although a reading waits"),
            Self::DataReadyHigh => defmt::warn!("INT stays high although no reading waits"),
            Self::Silent => defmt::warn!("INT stays low and no reading waits"),
        }
    }
}
