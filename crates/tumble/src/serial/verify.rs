//! `tumble verify`: the board judges its calibration on fresh poses; here its sentences are passed on.

use std::io::{Read, Write};
use std::time::{Duration, Instant};

use super::lines::value;
use super::{Line, Lines, SerialError};

/// The board repeats its request every second; so long without a line it is not there.
const SILENCE: Duration = Duration::from_secs(5);

/// What came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verified {
    /// Did the calibration hold?
    pub passed: bool,
    /// The board's line.
    pub line: String,
}

/// Starts `verify` and tells each sentence for the person until the verdict.
pub fn verify<P: Read + Write>(mut port: P, mut tell: impl FnMut(&str)) -> Result<Verified, SerialError> {
    port.write_all(b"verify\r\n")?;
    let mut lines = Lines::new(port);
    let mut heard = Instant::now();
    loop {
        match lines.next_line()? {
            Line::Text(line) => {
                heard = Instant::now();
                if line.starts_with("@verified ") {
                    return Ok(Verified { passed: value(&line, "verdict") == Some("pass"), line });
                }
                if line.starts_with("@error ") {
                    return Err(SerialError::Refused(line));
                }
                if !line.starts_with('@') && !line.is_empty() {
                    tell(&line);
                }
            }
            Line::Nothing if heard.elapsed() < SILENCE => {}
            Line::Nothing | Line::End => {
                return Err(SerialError::Silent { what: "nothing", seconds: SILENCE.as_secs() });
            }
        }
    }
}
