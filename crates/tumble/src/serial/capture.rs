//! `tumble record`: from the board's frames to a recording.

use std::io::{Read, Write};
use std::time::{Duration, Instant};

use tumble_core::frame::{Frame, RawFrame};

use super::lines::value;
use super::{Line, Lines, SerialError};
use crate::recording::{Metadata, Row, RowWriter, box_faces, turns};

/// So long the board may take to send the first frame: it answers a word within 0.2 s.
const FIRST_FRAME: Duration = Duration::from_secs(3);

/// What was recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Capture {
    /// What the board says of itself.
    pub metadata: Metadata,
    /// Samples written.
    pub samples: u64,
    /// Samples that never came, by their numbers.
    pub lost: u64,
    /// Lines that were damaged on the way.
    pub damaged: u64,
    last_seq: Option<u32>,
    first_us: Option<u64>,
}

impl Capture {
    /// Takes one line of the board's; a sample, if it is one.
    pub fn take(&mut self, line: &str) -> Result<Option<Row>, SerialError> {
        if line.starts_with("@recording ") {
            self.read_metadata(line);
        } else if line.starts_with("@hello ") && self.samples > 0 {
            return Err(SerialError::Restarted);
        } else if line.starts_with("@error ") {
            return Err(SerialError::Refused(line.to_owned()));
        } else if line.starts_with("R,") {
            return match Frame::parse(line) {
                Ok(Frame::Raw(frame)) => self.sample(&frame),
                _ => {
                    self.damaged += 1;
                    Ok(None)
                }
            };
        }
        Ok(None)
    }

    fn read_metadata(&mut self, line: &str) {
        let number = |key: &str| value(line, key).and_then(|text| text.parse().ok());
        self.metadata = Metadata {
            sensor: value(line, "sensor").map(Into::into),
            gyro_range_dps: number("gyro_range_dps"),
            accel_range_g: number("accel_range_g"),
            rate_hz: number("rate_hz"),
            gravity_mps2: number("gravity_mps2"),
            latitude_deg: None,
            turns: value(line, "turns").and_then(|word| turns(word).ok()),
            box_faces: value(line, "box").and_then(|word| box_faces(word).ok()),
        };
    }

    /// None before the ranges are known: counts alone are no measurement.
    fn sample(&mut self, frame: &RawFrame) -> Result<Option<Row>, SerialError> {
        let (Some(gyro_range), Some(accel_range)) = (self.metadata.gyro_range_dps, self.metadata.accel_range_g) else {
            return Ok(None);
        };
        if let Some(last) = self.last_seq {
            let ahead = frame.seq.wrapping_sub(last);
            if ahead == 0 || ahead > u32::MAX / 2 {
                return Err(SerialError::Restarted);
            }
            self.lost += u64::from(ahead - 1);
        }
        self.last_seq = Some(frame.seq);
        self.samples += 1;
        let first_us = *self.first_us.get_or_insert(frame.t_us);
        let counts = &frame.counts;
        Ok(Some(Row {
            t_s: frame.t_us.saturating_sub(first_us) as f64 / 1e6,
            gyro_dps: counts.gyro.map(|c| f64::from(c) * gyro_range / 32768.0),
            accel_g: counts.accel.map(|c| f64::from(c) * accel_range / 32768.0),
            // The MPU-9250's register map: 333.87 counts a degree, 0 at 21 °C.
            temp_c: Some(((f64::from(counts.temperature) / 333.87 + 21.0) * 1e3).round() / 1e3),
        }))
    }
}

/// Asks the board for raw frames and writes them until `stop` says so or the line ends. `amend` may correct what the
/// board states before it is written: only the person knows the table.
pub fn record<P: Read + Write>(
    mut port: P,
    to: impl Write,
    amend: impl Fn(&mut Metadata),
    mut stop: impl FnMut(&Capture) -> bool,
) -> Result<Capture, SerialError> {
    port.write_all(b"record\r\n")?;
    let started = Instant::now();
    let mut lines = Lines::new(port);
    let mut capture = Capture::default();
    let mut target = Target { to: Some(to), writer: None };
    while !stop(&capture) {
        match lines.next_line()? {
            Line::Text(line) => {
                if let Some(row) = capture.take(&line)? {
                    target.row(&row, &capture.metadata, &amend)?;
                }
            }
            Line::Nothing if capture.samples == 0 && started.elapsed() > FIRST_FRAME => {
                return Err(SerialError::Silent { what: "no frame", seconds: FIRST_FRAME.as_secs() });
            }
            Line::Nothing => {}
            Line::End => break,
        }
    }
    lines.into_inner().write_all(b"stream off\r\n")?;
    Ok(capture)
}

/// The file, whose header waits for the board's metadata.
struct Target<W> {
    to: Option<W>,
    writer: Option<RowWriter<W>>,
}

impl<W: Write> Target<W> {
    fn row(&mut self, row: &Row, metadata: &Metadata, amend: &impl Fn(&mut Metadata)) -> std::io::Result<()> {
        if let Some(to) = self.to.take() {
            let mut metadata = metadata.clone();
            amend(&mut metadata);
            self.writer = Some(RowWriter::new(to, &metadata, true)?);
        }
        match &mut self.writer {
            Some(writer) => writer.row(row),
            None => Ok(()),
        }
    }
}
