//! Why a recording is refused: the thing, the place, and what to do about it.

use std::fmt;

use thiserror::Error;

/// A refusal: one sentence that names file, line and column as far as they are known, and one with the remedy.
#[derive(Debug)]
pub struct RecordingError {
    /// The file as the person named it.
    pub file: String,
    /// Counted from 1, metadata and header lines included, as an editor shows it.
    pub line: Option<u64>,
    /// Name of the column.
    pub column: Option<String>,
    /// What is wrong.
    pub problem: Problem,
}

/// What can be wrong with a recording.
#[derive(Debug, Error)]
pub enum Problem {
    /// It could not be opened or read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// It could not be written.
    #[error("cannot be written: {0}")]
    Unwritable(std::io::Error),
    /// Bytes that are no text.
    #[error("is not UTF-8 text (byte 0x{byte:02x} at offset {offset})")]
    NotUtf8 {
        /// Where the text ends, bytes from the start.
        offset: usize,
        /// The first byte that does not fit.
        byte: u8,
    },
    /// Not one line that is not metadata.
    #[error("is empty: it has no header line")]
    Empty,
    /// A header and nothing below it.
    #[error("has a header but no samples")]
    NoSamples,
    /// A column of the contract is not there.
    #[error("column {name} is missing; the header has: {found}")]
    MissingColumn {
        /// The first that is missing.
        name: &'static str,
        /// What is there instead.
        found: String,
    },
    /// The same name twice, so that either could be meant.
    #[error("column {name} appears twice in the header")]
    DuplicateColumn {
        /// The name.
        name: String,
    },
    /// Too few or too many fields.
    #[error("has {found} fields where the header names {expected}")]
    FieldCount {
        /// Fields in this line.
        found: usize,
        /// Fields in the header.
        expected: usize,
    },
    /// The last line stops early.
    #[error("the file ends in the middle of this line: {found} of {expected} fields")]
    Truncated {
        /// Fields in this line.
        found: usize,
        /// Fields in the header.
        expected: usize,
    },
    /// A field that is no number.
    #[error("'{value}' is not a number")]
    NotANumber {
        /// The field as it stands.
        value: String,
    },
    /// NaN or an infinity where a measurement is needed.
    #[error("'{value}' is no measurement")]
    NotFinite {
        /// The field as it stands.
        value: String,
    },
    /// Time stands still or runs backwards.
    #[error("time does not increase: {time_s} s after {previous_s} s")]
    TimeNotIncreasing {
        /// This line's.
        time_s: f64,
        /// The line's before.
        previous_s: f64,
    },
    /// The specific force is not in g.
    #[error(
        "the specific force has a median length of {median:.3}, where a recording in g has 1: it looks like {unit}"
    )]
    AccelUnit {
        /// Median length over the file.
        median: f64,
        /// What it may be.
        unit: &'static str,
    },
    /// The angular rate is not in °/s.
    #[error(
        "the angular rate adds up to {gyro_deg:.1} degrees while the specific force turned by {accel_deg:.0}: it looks like rad/s"
    )]
    GyroUnit {
        /// Integral of the rate's length where the specific force turned.
        gyro_deg: f64,
        /// Angle by which the specific force turned.
        accel_deg: f64,
    },
    /// A metadata value that does not mean anything.
    #[error("metadata '{key}' has the value '{value}'")]
    Metadata {
        /// Key.
        key: &'static str,
        /// Value as it stands.
        value: String,
        /// What it may be.
        allowed: &'static str,
    },
}

impl Problem {
    /// A host that stamps what arrives is late by up to 0.4 s (docs/diagnosis.md §8), and its next stamp is not. What runs back by more, s,
    /// is a clock that wraps, another recording, or lines out of order, and no diagnosis takes it.
    pub const LATEST_S: f64 = 0.5;

    /// What the person can do.
    pub fn remedy(&self) -> String {
        match self {
            Self::Unreadable(_) => "check the path and the permission to read it".into(),
            Self::Unwritable(_) => "check the folder, the space and the permission to write there".into(),
            Self::NotUtf8 { .. } => "save it as plain CSV text in UTF-8".into(),
            Self::Empty | Self::NoSamples => "record again, or check that the right file was named".into(),
            Self::MissingColumn { name, .. } => missing_column_remedy(name),
            Self::DuplicateColumn { .. } => "rename or remove one of the two".into(),
            Self::FieldCount { .. } => "repair or delete the line".into(),
            Self::Truncated { .. } => "delete this last line, or copy the file again if more is missing".into(),
            Self::NotANumber { .. } => "repair or delete the line; numbers use a decimal point".into(),
            Self::NotFinite { .. } => "delete the line: a gap in time is allowed, an invalid reading is not".into(),
            Self::TimeNotIncreasing { time_s, previous_s } if *time_s < previous_s - Self::LATEST_S => {
                "if the clock wraps or starts anew here, add to every stamp from this line on what it lost; if this is another recording,                  give it a file of its own; else sort by time"
                    .into()
            }
            Self::TimeNotIncreasing { .. } => {
                "delete repeated lines or sort by time, stamps at least 1 µs apart; `tumble diagnose` takes such a file and says what \
                 ails its stamps"
                    .into()
            }
            Self::AccelUnit { .. } => "divide ax_g, ay_g and az_g by what one g is in that unit (9.80665 m/s²)".into(),
            Self::GyroUnit { .. } => "multiply gx_dps, gy_dps and gz_dps by 57.29578".into(),
            Self::Metadata { allowed, .. } => format!("write {allowed}, or remove the line"),
        }
    }
}

fn missing_column_remedy(name: &str) -> String {
    let unit = match name.rsplit('_').next() {
        Some("dps") => "angular rate in degrees per second",
        Some("g") => "specific force in g, +1 on the axis that points up",
        _ => "time in seconds",
    };
    format!("add a comma-separated column named exactly {name}: {unit}")
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some(column) = &self.column {
            write!(f, ", column {column}")?;
        }
        write!(f, ": {}. Remedy: {}.", self.problem, self.problem.remedy())
    }
}

impl std::error::Error for RecordingError {}
