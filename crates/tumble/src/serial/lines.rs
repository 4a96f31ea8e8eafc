//! Bytes to lines, with time-outs.

use std::io::{self, ErrorKind, Read};

/// What came.
#[derive(Debug, PartialEq, Eq)]
pub enum Line {
    /// A whole line, without its end. Bytes that are no text are replaced: a damaged frame fails its checksum anyway.
    Text(String),
    /// Nothing within the port's time-out.
    Nothing,
    /// The line is closed.
    End,
}

/// Cuts a stream of bytes into lines.
pub struct Lines<R> {
    from: R,
    pending: Vec<u8>,
    ended: bool,
}

/// Longer than anything the board says; more without an end is noise (a wrong speed), and not kept.
const LONGEST: usize = 4096;

impl<R: Read> Lines<R> {
    /// From the beginning of a stream.
    pub fn new(from: R) -> Self {
        Self { from, pending: Vec::new(), ended: false }
    }

    /// Back to the stream; what was read of a line that has not ended is lost.
    pub fn into_inner(self) -> R {
        self.from
    }

    /// The next line.
    pub fn next_line(&mut self) -> io::Result<Line> {
        loop {
            if let Some(end) = self.pending.iter().position(|&byte| byte == b'\n') {
                let line: Vec<u8> = self.pending.drain(..=end).collect();
                return Ok(Line::Text(String::from_utf8_lossy(&line).trim_end().to_owned()));
            }
            if self.ended {
                return Ok(Line::End);
            }
            if self.pending.len() > LONGEST {
                self.pending.clear();
            }
            if !self.fill()? {
                return Ok(Line::Nothing);
            }
        }
    }

    /// False if nothing came in time.
    fn fill(&mut self) -> io::Result<bool> {
        let mut buffer = [0; 1024];
        match self.from.read(&mut buffer) {
            Ok(0) => self.ended = true,
            Ok(count) => self.pending.extend_from_slice(&buffer[..count]),
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => return Ok(false),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
        Ok(true)
    }
}

/// The value of `key` in a line of `@word key=value …`.
pub(crate) fn value<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.split_whitespace().skip(1).find_map(|pair| pair.strip_prefix(key)?.strip_prefix('='))
}
