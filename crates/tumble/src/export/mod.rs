//! A calibration in the forms that other programs read.
//!
//! Where a program has no place for a number (most autopilots take a bias and a scale an axis), the file says in a remark
//! what is left out and how large it is.

mod autopilot;
mod kalibr;
mod parameters;
mod plain;

use clap::ValueEnum;
use thiserror::Error;

pub use parameters::{Parameters, Triad};

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Kalibr's IMU intrinsics, model scale-misalignment (YAML)
    Kalibr,
    /// The ROS package imu_calib (YAML)
    Ros,
    /// PX4 parameters as QGroundControl loads them
    Px4,
    /// ArduPilot parameters as ground stations load them
    Ardupilot,
    /// Words for INAV's command line
    Inav,
    /// Numbers alone, SI
    Json,
    /// A C header with the numbers and the function that applies them
    C,
}

/// Why nothing is written.
#[derive(Debug, Error, PartialEq)]
pub enum ExportError {
    /// Neither form of input.
    #[error("this is neither the JSON of `tumble calibrate --json` nor the `@param` lines of the board's `cal export`")]
    NotParameters,
    /// A rejected calibration has no numbers.
    #[error("this calibration was rejected, it has no numbers: {0}")]
    Rejected(String),
    /// Something is missing or is no number.
    #[error("{0} is missing or is no number")]
    Missing(String),
    /// The format needs what the recording does not determine.
    #[error(
        "{0} is not determined by the recording, and this format cannot say so: record with the turns that are missing"
    )]
    NotObservable(String),
    /// No triad has such a matrix.
    #[error("the {0}'s correction cannot be inverted")]
    Singular(&'static str),
}

/// The file's text.
pub fn export(parameters: &Parameters, format: Format) -> Result<String, ExportError> {
    match format {
        Format::Kalibr => kalibr::text(parameters),
        Format::Ros => plain::ros(parameters),
        Format::Px4 => autopilot::px4(parameters),
        Format::Ardupilot => autopilot::ardupilot(parameters),
        Format::Inav => autopilot::inav(parameters),
        Format::Json => plain::json(parameters),
        Format::C => plain::c(parameters),
    }
}
