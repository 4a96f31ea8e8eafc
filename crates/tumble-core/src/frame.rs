//! Stream frames: a sample a line, in integers, with a checksum.
//!
//! `R,seq,t_us,gx,gy,gz,ax,ay,az,temp*hh` counts, `C,…` compensated. `hh` is the exclusive-or of all bytes before the `*`, two
//! upper-case hexadecimal digits. There is one spelling of every frame and no other is read, so that one changed byte is
//! always found: it changes the exclusive-or, or is a digit of it, or spoils the form.

use core::fmt::{self, Write};
use core::str::FromStr;

use crate::sample::{Counts, Sample};

/// The longest line with its end: 2 + 10 + 20 + 6 · 11 + 11 digits and signs, 8 commas, checksum and `\r\n`.
pub const MAX_LINE: usize = 122;

/// A frame as a line.
pub type FrameLine = heapless::String<MAX_LINE>;

/// What the sensor said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawFrame {
    /// Counts samples since start: a gap is a lost sample. It wraps.
    pub seq: u32,
    /// By the microcontroller's crystal, µs since start.
    pub t_us: u64,
    /// In the sensor's units.
    pub counts: Counts,
}

/// The same, compensated, in integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompensatedFrame {
    /// As in [`RawFrame`].
    pub seq: u32,
    /// As in [`RawFrame`].
    pub t_us: u64,
    /// µrad/s.
    pub angular_rate_urad_s: [i32; 3],
    /// µm/s².
    pub specific_force_um_s2: [i32; 3],
    /// Hundredths of a degree Celsius.
    pub temperature_cdegc: i32,
}

/// Either kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// `R`.
    Raw(RawFrame),
    /// `C`.
    Compensated(CompensatedFrame),
}

/// Why a line is no frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// It begins with neither `R,` nor `C,`: something else was said.
    NotAFrame,
    /// No `*` with two upper-case hexadecimal digits at its end.
    NoChecksum,
    /// Damaged on the way.
    Checksum {
        /// Of the bytes that came.
        computed: u8,
        /// As written behind them.
        written: u8,
    },
    /// Not nine fields behind the letter.
    Fields {
        /// How many there are.
        found: usize,
    },
    /// A field is no number in its range, or not written as one is.
    Field {
        /// Its name.
        name: &'static str,
    },
}

const FIELDS: [&str; 9] = ["seq", "t_us", "gx", "gy", "gz", "ax", "ay", "az", "temp"];

impl RawFrame {
    /// The frame as a line with its `\r\n`.
    pub fn line(&self) -> FrameLine {
        let Counts { gyro, accel, temperature } = self.counts;
        line('R', self.seq, self.t_us, gyro, accel, temperature)
    }
}

impl CompensatedFrame {
    /// Rounds a compensated sample to integers; none if it holds what is no number or does not fit. A temperature that the
    /// source does not have is such.
    pub fn new(seq: u32, sample: &Sample) -> Option<Self> {
        let rates = sample.angular_rate_rad_s.map(|v| integer(v * 1e6));
        let forces = sample.specific_force_mps2.map(|v| integer(v * 1e6));
        Some(Self {
            seq,
            t_us: sample.t_us,
            angular_rate_urad_s: [rates.x?, rates.y?, rates.z?],
            specific_force_um_s2: [forces.x?, forces.y?, forces.z?],
            temperature_cdegc: integer(sample.temperature_degc * 100.0)?,
        })
    }

    /// The frame as a line with its `\r\n`.
    pub fn line(&self) -> FrameLine {
        let Self { angular_rate_urad_s, specific_force_um_s2, .. } = *self;
        line('C', self.seq, self.t_us, angular_rate_urad_s, specific_force_um_s2, self.temperature_cdegc)
    }
}

impl Frame {
    /// Reads a line, with or without its end.
    ///
    /// # Errors
    /// [`FrameError`] says what is wrong with it.
    pub fn parse(text: &str) -> Result<Self, FrameError> {
        let text = text.strip_suffix('\n').map_or(text, |t| t.strip_suffix('\r').unwrap_or(t));
        let raw = match text.as_bytes() {
            [b'R', b',', ..] => true,
            [b'C', b',', ..] => false,
            _ => return Err(FrameError::NotAFrame),
        };
        let (body, written) = text.split_once('*').ok_or(FrameError::NoChecksum)?;
        let written = checksum_digits(written.as_bytes()).ok_or(FrameError::NoChecksum)?;
        let computed = body.bytes().fold(0, |sum, byte| sum ^ byte);
        if computed != written {
            return Err(FrameError::Checksum { computed, written });
        }
        let found = body.split(',').count() - 1;
        if found != FIELDS.len() {
            return Err(FrameError::Fields { found });
        }
        let mut fields = Fields(body.split(',').skip(1).zip(FIELDS));
        let (seq, t_us) = (fields.next()?, fields.next()?);
        Ok(if raw {
            let counts = Counts { gyro: fields.triple()?, accel: fields.triple()?, temperature: fields.next()? };
            Self::Raw(RawFrame { seq, t_us, counts })
        } else {
            Self::Compensated(CompensatedFrame {
                seq,
                t_us,
                angular_rate_urad_s: fields.triple()?,
                specific_force_um_s2: fields.triple()?,
                temperature_cdegc: fields.next()?,
            })
        })
    }
}

struct Fields<I>(I);

impl<'a, I: Iterator<Item = (&'a str, &'static str)>> Fields<I> {
    /// `from_str` takes `+5` and `007` too; a frame has one spelling only.
    fn next<T: FromStr>(&mut self) -> Result<T, FrameError> {
        let (text, name) = self.0.next().ok_or(FrameError::Fields { found: 0 })?;
        let digits = text.strip_prefix('-').unwrap_or(text);
        let plain = digits.bytes().all(|b| b.is_ascii_digit()) && (text == "0" || !digits.starts_with('0'));
        text.parse().ok().filter(|_| plain).ok_or(FrameError::Field { name })
    }

    fn triple<T: FromStr>(&mut self) -> Result<[T; 3], FrameError> {
        Ok([self.next()?, self.next()?, self.next()?])
    }
}

/// Writes through and keeps the exclusive-or of what was written.
struct Summed<'a> {
    line: &'a mut FrameLine,
    sum: u8,
}

impl Write for Summed<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.sum = text.bytes().fold(self.sum, |sum, byte| sum ^ byte);
        self.line.write_str(text)
    }
}

fn line<T: fmt::Display>(kind: char, seq: u32, t_us: u64, gyro: [T; 3], accel: [T; 3], temperature: T) -> FrameLine {
    let mut line = FrameLine::new();
    let ([gx, gy, gz], [ax, ay, az]) = (gyro, accel);
    let mut summed = Summed { line: &mut line, sum: 0 };
    // The longest line fits, so that neither write can fail (a test writes it).
    let _ = write!(summed, "{kind},{seq},{t_us},{gx},{gy},{gz},{ax},{ay},{az},{temperature}");
    let sum = summed.sum;
    let _ = write!(line, "*{sum:02X}\r\n");
    line
}

fn integer(value: f32) -> Option<i32> {
    let rounded = libm::roundf(value);
    // 2³¹ is a number of f32, the largest i32 is not.
    (rounded.abs() < 2_147_483_648.0).then_some(rounded as i32)
}

fn checksum_digits(digits: &[u8]) -> Option<u8> {
    let [high, low] = digits else { return None };
    let digit = |b: &u8| (!b.is_ascii_lowercase()).then(|| char::from(*b).to_digit(16)).flatten();
    u8::try_from(digit(high)? << 4 | digit(low)?).ok()
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAFrame => f.write_str("the line is no frame: it begins with neither R nor C"),
            Self::NoChecksum => f.write_str("the frame is cut short: its checksum is missing"),
            Self::Checksum { computed, written } => {
                write!(f, "the frame is damaged: its checksum is {written:02X} but its bytes give {computed:02X}")
            }
            Self::Fields { found } => write!(f, "the frame has {found} fields in place of {}", FIELDS.len()),
            Self::Field { name } => write!(f, "the frame's field {name} is no number that fits"),
        }
    }
}

impl core::error::Error for FrameError {}

#[cfg(test)]
mod tests;
