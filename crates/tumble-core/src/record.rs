//! A calibration as bytes for the flash. These bytes are an API: a newer firmware reads what an older one wrote.
//!
//! | offset | bytes | what |
//! |---|---|---|
//! | 0 | 4 | `TMBL` |
//! | 4 | 2 | format version, little-endian |
//! | 6 | 2 | length n of the payload, little-endian |
//! | 8 | n | payload, `postcard` |
//! | 8 + n | 4 | CRC-32 (IEEE 802.3) of all before it, little-endian |
//!
//! This frame is the same in every version; only the payload changes. The payloads are in `v1.rs` and `v2.rs`, pinned byte by
//! byte by tests, and stay as they are for ever: a version 3 is a `v3.rs` and one more arm in [`decode`]. [`encode`] writes the lowest
//! version that holds the calibration, so that an older firmware reads all that it can. A newer version than [`VERSION`] is intact but
//! unknown: [`RecordError::Newer`], to be left in flash.

#[cfg(test)]
mod tests;
mod v1;
mod v2;

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::Vec;
use serde::{Deserialize, Serialize};

use crate::calibration::{AcceptedCalibration, Calibration};
use crate::sample::Ranges;
use crate::setup::Setup;

/// The newest format that is known, and that [`encode`] writes where the calibration needs it.
pub const VERSION: u16 = 2;
/// No record is longer, in this version or a later one.
pub const MAX_BYTES: usize = 384;

const MAGIC: [u8; 4] = *b"TMBL";
const HEADER: usize = 8;
const CHECKSUM: usize = 4;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The record's bytes.
pub type Bytes = Vec<u8, MAX_BYTES>;

/// The firmware that made a record.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FirmwareVersion {
    /// Changes of meaning.
    pub major: u16,
    /// Additions.
    pub minor: u16,
    /// Repairs.
    pub patch: u16,
}

impl FirmwareVersion {
    /// Reads `0.1.0`, as `CARGO_PKG_VERSION` has it; what is missing or no number is 0.
    pub fn parse(text: &str) -> Self {
        let mut numbers = text.split(['.', '-', '+']).map(|part| part.parse().unwrap_or(0));
        let mut next = || numbers.next().unwrap_or(0);
        Self { major: next(), minor: next(), patch: next() }
    }
}

impl fmt::Display for FirmwareVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// Where and how a calibration was made. It has no date, because the board has no calendar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// Counts the calibrations stored on this board, from 1.
    pub generation: u32,
    /// The firmware that made it.
    pub firmware: FirmwareVersion,
    /// The sensor's WHO_AM_I: a calibration belongs to one sensor.
    pub whoami: u8,
    /// The ranges in force.
    pub ranges: Ranges,
    /// What the person stated.
    pub setup: Setup,
}

/// What the flash holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Where and how it was made.
    pub origin: Origin,
    /// The calibration.
    pub calibration: AcceptedCalibration,
}

/// Why bytes are no usable record, or a calibration cannot become one. None of these is a reason to erase anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordError {
    /// They do not begin as a record does.
    NotARecord,
    /// They end too early.
    Truncated {
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// The checksum does not fit: a bit has flipped, or it was never written completely.
    Damaged {
        /// Of the bytes found.
        computed: u32,
        /// As written behind them.
        written: u32,
    },
    /// Intact, but made by a newer firmware.
    Newer {
        /// Its format version.
        version: u16,
    },
    /// Intact, but its payload is not what its version says: made by a firmware with a fault.
    Malformed {
        /// Its format version.
        version: u16,
    },
    /// A value is not a finite number.
    NotFinite {
        /// Its name as in `docs/protocol.md`, with `_sigma` left out, or what else it is.
        name: &'static str,
    },
    /// It does not fit [`MAX_BYTES`].
    TooLarge,
}

/// Makes the bytes.
///
/// # Errors
/// [`RecordError::NotFinite`] for a calibration that holds what is no finite number, [`RecordError::TooLarge`] never up to version 2.
pub fn encode(origin: &Origin, calibration: &AcceptedCalibration) -> Result<Bytes, RecordError> {
    check_finite(origin, calibration.calibration())?;
    let calibration = calibration.calibration();
    let mut buffer = [0; MAX_BYTES - HEADER - CHECKSUM];
    let first = postcard::to_slice(&v1::Payload::new(origin, calibration), &mut buffer);
    let mut used = first.map_err(|_| RecordError::TooLarge)?.len();
    let mut version = 1u16;
    if let (Some(felt), Some(rest)) = (&calibration.g_sensitivity, buffer.get_mut(used..)) {
        used += postcard::to_slice(&v2::pack(felt), rest).map_err(|_| RecordError::TooLarge)?.len();
        version = 2;
    }
    let payload = buffer.get(..used).ok_or(RecordError::TooLarge)?;
    let length = u16::try_from(payload.len()).map_err(|_| RecordError::TooLarge)?;
    let mut bytes = Bytes::new();
    for part in [&MAGIC, &version.to_le_bytes(), &length.to_le_bytes(), payload] as [&[u8]; 4] {
        bytes.extend_from_slice(part).map_err(|_| RecordError::TooLarge)?;
    }
    let checksum = CRC.checksum(&bytes).to_le_bytes();
    bytes.extend_from_slice(&checksum).map_err(|_| RecordError::TooLarge)?;
    Ok(bytes)
}

/// Reads the bytes; what stands behind the record (an erased rest of a page) does not matter.
///
/// # Errors
/// [`RecordError`] says what is wrong with them.
pub fn decode(bytes: &[u8]) -> Result<Record, RecordError> {
    let (version, payload) = unwrap(bytes)?;
    let malformed = RecordError::Malformed { version };
    match version {
        0 => return Err(malformed),
        1..=VERSION => {}
        _ => return Err(RecordError::Newer { version }),
    }
    let (first, rest) = postcard::take_from_bytes::<v1::Payload>(payload).map_err(|_| malformed)?;
    let (origin, mut calibration) = first.unpack();
    if version > 1 {
        let felt = postcard::from_bytes(rest).map_err(|_| malformed)?;
        calibration.g_sensitivity = Some(v2::unpack(&felt));
    }
    check_finite(&origin, &calibration)?;
    Ok(Record { origin, calibration: AcceptedCalibration::new(calibration) })
}

/// The version and the payload of an intact record of any version.
fn unwrap(bytes: &[u8]) -> Result<(u16, &[u8]), RecordError> {
    let truncated = |expected| RecordError::Truncated { expected, found: bytes.len() };
    if !bytes.starts_with(&MAGIC) {
        return Err(RecordError::NotARecord);
    }
    let least = truncated(HEADER + CHECKSUM);
    let (version, rest) = bytes.get(MAGIC.len()..).and_then(<[u8]>::split_first_chunk).ok_or(least)?;
    let (length, _) = rest.split_first_chunk().ok_or(least)?;
    let end = HEADER + usize::from(u16::from_le_bytes(*length));
    let body = bytes.get(..end).ok_or(truncated(end + CHECKSUM))?;
    let written = bytes.get(end..).and_then(<[u8]>::first_chunk).ok_or(truncated(end + CHECKSUM))?;
    let (computed, written) = (CRC.checksum(body), u32::from_le_bytes(*written));
    if computed != written {
        return Err(RecordError::Damaged { computed, written });
    }
    Ok((u16::from_le_bytes(*version), body.get(HEADER..).unwrap_or(&[])))
}

/// A number that is none must neither be stored nor come into force: it would silence the compensated stream for good.
fn check_finite(origin: &Origin, calibration: &Calibration) -> Result<(), RecordError> {
    let parameters =
        calibration.parameters().map(|p| (p.name, p.value.is_finite() && p.sigma.is_none_or(f32::is_finite)));
    let fit = &calibration.fit;
    let others = [
        ("gyro_full_scale_dps", origin.ranges.gyro_full_scale_dps),
        ("accel_full_scale_g", origin.ranges.accel_full_scale_g),
        ("nis_per_dof", fit.nis_per_dof),
        ("gravity_rms", fit.gravity_rms_mps2),
        ("gravity_max", fit.gravity_max_mps2),
        ("turn_closure_rms", fit.turn_closure_rms_rad),
    ];
    let mut all = parameters.chain(others.into_iter().map(|(name, value)| (name, value.is_finite())));
    match all.find(|(_, finite)| !finite) {
        Some((name, _)) => Err(RecordError::NotFinite { name }),
        None => Ok(()),
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotARecord => f.write_str("what is there is no calibration record. Calibrate again to write one."),
            Self::Truncated { expected, found } => {
                write!(f, "the record ends after {found} of {expected} bytes. Calibrate again to write a new one.")
            }
            Self::Damaged { computed, written } => write!(
                f,
                "the record is damaged (checksum {written:#010x}, its bytes give {computed:#010x}). Calibrate again to write a new one."
            ),
            Self::Newer { version } => write!(
                f,
                "the record has format {version}, and this firmware knows formats up to {VERSION}. Install the newer firmware that wrote it."
            ),
            Self::Malformed { version } => {
                write!(
                    f,
                    "the record is intact but not what its format {version} says. Calibrate again to write a new one."
                )
            }
            Self::NotFinite { name } => write!(f, "its {name} is not a number. Calibrate again to write a new one."),
            Self::TooLarge => write!(f, "it does not fit {MAX_BYTES} bytes. Report this fault of the firmware."),
        }
    }
}

impl core::error::Error for RecordError {}
