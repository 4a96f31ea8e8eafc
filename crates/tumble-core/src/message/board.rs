//! What the board says of itself, and what stands in front of frames.

use core::fmt::{self, Write};

use super::words::Plain;
use crate::STANDARD_GRAVITY_MPS2;
use crate::command::StreamKind;
use crate::sample::Ranges;
use crate::setup::Setup;

/// What the flash holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationState {
    /// No record.
    None,
    /// A record, which is in force.
    Stored,
    /// A record that this firmware cannot use, and leaves alone.
    Unreadable,
    /// A record of a sensor with another WHO_AM_I: left alone and not in force.
    OtherSensor,
}

/// What the board says after start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hello {
    /// Version, as `0.1.0`.
    pub firmware: &'static str,
    /// Name of the microcontroller board.
    pub board: &'static str,
    /// Name of the sensor.
    pub sensor: &'static str,
    /// The sensor's WHO_AM_I.
    pub whoami: u8,
    /// Why it started.
    pub reset: &'static str,
    /// What the flash holds.
    pub calibration: CalibrationState,
}

/// The answer to `info`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Info {
    /// As after start.
    pub hello: Hello,
    /// The sensor's ranges.
    pub ranges: Ranges,
    /// Measured by the microcontroller's crystal, Hz.
    pub rate_hz: f32,
    /// Samples since start.
    pub samples: u32,
    /// Samples that the sensor overwrote before they were read.
    pub overruns: u32,
    /// Samples that could not be read.
    pub sample_errors: u32,
    /// Since start, µs.
    pub uptime_us: u64,
}

/// What stands in front of frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Streaming {
    /// Which frames.
    pub kind: StreamKind,
    /// How many a second.
    pub rate_hz: f32,
    /// What a count is worth.
    pub ranges: Ranges,
}

/// The metadata of a recording, under the contract's keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recording {
    /// Name of the sensor.
    pub sensor: &'static str,
    /// How many samples a second.
    pub rate_hz: f32,
    /// The sensor's ranges.
    pub ranges: Ranges,
    /// How turns end and what the box is.
    pub setup: Setup,
}

impl CalibrationState {
    fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Stored => "stored",
            Self::Unreadable => "unreadable",
            Self::OtherSensor => "other_sensor",
        }
    }
}

impl Hello {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        w.write_str("@hello")?;
        self.pairs(w)
    }

    fn pairs(&self, w: &mut impl Write) -> fmt::Result {
        let (firmware, board, sensor) = (Plain(self.firmware), Plain(self.board), Plain(self.sensor));
        write!(w, " firmware={firmware} board={board} sensor={sensor} whoami={:#04x}", self.whoami)?;
        write!(w, " reset={} calibration={}", Plain(self.reset), self.calibration.name())
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        let Self { firmware, board, sensor, whoami, reset, .. } = self;
        write!(
            w,
            "Hello, this is Tumble {firmware} on a {board} with an {sensor} (identity {whoami:#04x}), started by {reset}. "
        )?;
        w.write_str(match self.calibration {
            CalibrationState::None => "It is not calibrated yet: type \"calibrate\".",
            CalibrationState::Stored => "Its calibration is in force. Type \"help\" for the words.",
            CalibrationState::Unreadable => {
                "The calibration in flash cannot be used by this firmware and is left untouched: install the newer firmware \
                 again, or type \"calibrate\"."
            }
            CalibrationState::OtherSensor => {
                "The calibration in flash belongs to a sensor with another identity: it is kept and not used. Type \"calibrate\" \
                 for this sensor, or put the old one back."
            }
        })
    }
}

impl Info {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        w.write_str("@info")?;
        self.hello.pairs(w)?;
        let Self { samples, overruns, sample_errors, uptime_us, .. } = self;
        write!(w, " samples={samples} overruns={overruns} sample_errors={sample_errors}")?;
        write!(w, " rate_hz={:.2} {} uptime_us={uptime_us}", self.rate_hz, Lsb(&self.ranges))
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        let Hello { firmware, board, sensor, whoami, .. } = self.hello;
        let Self { samples, overruns, sample_errors, rate_hz, .. } = self;
        let (gyro, accel) = (self.ranges.gyro_full_scale_dps, self.ranges.accel_full_scale_g);
        write!(w, "Tumble {firmware} on {board}; {sensor} (identity {whoami:#04x}) at {rate_hz:.2} Hz, ")?;
        write!(w, "+-{gyro} degrees per second, +-{accel} g; up for {} s, ", self.uptime_us / 1_000_000)?;
        write!(w, "{samples} samples, {overruns} overwritten unread, {sample_errors} unreadable.")
    }
}

impl Streaming {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        write!(w, "@stream kind={} rate_hz={:.2} {}", self.kind.name(), self.rate_hz, Lsb(&self.ranges))
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        w.write_str(match self.kind {
            StreamKind::Raw => "Raw frames follow, in the sensor's counts. Type \"stream off\" to stop.",
            StreamKind::Cal => {
                "Compensated frames follow, in urad/s, um/s^2 and centidegrees C. Type \"stream off\" to stop."
            }
            StreamKind::Off => "No more frames.",
        })
    }
}

impl Recording {
    pub(super) fn machine(&self, w: &mut impl Write) -> fmt::Result {
        let Ranges { gyro_full_scale_dps, accel_full_scale_g } = self.ranges;
        write!(w, "@recording sensor={} rate_hz={:.2}", Plain(self.sensor), self.rate_hz)?;
        write!(w, " gyro_range_dps={gyro_full_scale_dps} accel_range_g={accel_full_scale_g}")?;
        write!(w, " gravity_mps2={STANDARD_GRAVITY_MPS2}")?;
        write!(w, " turns={} box={}", self.setup.stops.name(), self.setup.box_faces.name())
    }

    pub(super) fn human(&self, w: &mut impl Write) -> fmt::Result {
        w.write_str("Recording: raw frames follow for as long as it lasts. Type \"stream off\" to end it.")
    }
}

/// `gyro_lsb_dps=… accel_lsb_g=…`, digits that read back exactly.
struct Lsb<'a>(&'a Ranges);

impl fmt::Display for Lsb<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Ranges { gyro_full_scale_dps, accel_full_scale_g } = self.0;
        write!(f, "gyro_lsb_dps={} accel_lsb_g={}", gyro_full_scale_dps / 32768.0, accel_full_scale_g / 32768.0)
    }
}
