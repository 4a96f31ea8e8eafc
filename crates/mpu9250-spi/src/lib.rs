//! An async SPI driver for the InvenSense MPU9250 and its siblings (MPU6500, MPU9255).
//!
//! It gives raw counts and says what it does: every register it writes is read back, a part that answers with another
//! name is refused with the value it answered, and an error names the register, what was written and what was read.
//! It knows no pin, no clock and no unit: time, calibration and SI belong to those above.
//!
//! ```no_run
//! # async fn example<S: embedded_hal_async::spi::SpiDevice, D: embedded_hal_async::delay::DelayNs>(
//! #     spi: S, delay: D) -> Result<(), mpu9250_spi::Error<S::Error>> {
//! use mpu9250_spi::{Configuration, Mpu9250};
//!
//! let mut sensor = Mpu9250::new(spi, delay);
//! let identity = sensor.start(&Configuration::default()).await?;
//! // wait until INT is high, then:
//! let reading = sensor.read().await?;
//! # let _ = (identity, reading); Ok(()) }
//! ```
//!
//! Sources: "MPU-9250 Register Map and Descriptions" RM-MPU-9250A-00 rev. 1.6, "MPU-9250 Product Specification"
//! PS-MPU-9250A-01 rev. 1.1, and "MPU-9250 Accelerometer, Gyroscope and Compass Self-Test Implementation"
//! AN-MPU-9250A-03 rev. 1.0.
#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod configuration;
mod device;
mod error;
mod identity;
mod reading;
mod register;
mod self_test;

pub use configuration::{AccelRange, Configuration, GyroRange};
pub use device::Mpu9250;
pub use error::Error;
pub use identity::{Identity, Refused, Standing};
pub use reading::{Reading, Status};
pub use register::Register;
pub use self_test::{AxisResult, Basis, SelfTest};
