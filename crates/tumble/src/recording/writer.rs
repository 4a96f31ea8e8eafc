//! From rows to text.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use super::{Metadata, Problem, Recording, RecordingError, Row};

/// Writes the contract's format row by row. Numbers are Rust's shortest decimals that read back as the same `f64`, so
/// reading what was written gives exactly the same rows.
pub struct RowWriter<W> {
    to: W,
    with_temperature: bool,
}

impl<W: Write> RowWriter<W> {
    /// Begins with metadata and header.
    pub fn new(mut to: W, metadata: &Metadata, with_temperature: bool) -> io::Result<Self> {
        for line in metadata.lines() {
            writeln!(to, "{line}")?;
        }
        let temperature = if with_temperature { ",temp_c" } else { "" };
        writeln!(to, "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g{temperature}")?;
        Ok(Self { to, with_temperature })
    }

    /// One whole line in one write, so that a program that is ended leaves no half of one in an unbuffered file.
    pub fn row(&mut self, row: &Row) -> io::Result<()> {
        let mut line = row.t_s.to_string();
        for value in row.channels() {
            let _ = write!(line, ",{value}"); // a String takes everything
        }
        match row.temp_c {
            Some(value) => {
                let _ = write!(line, ",{value}");
            }
            None if self.with_temperature => line.push(','),
            None => {}
        }
        line.push('\n');
        self.to.write_all(line.as_bytes())
    }

    /// Hands everything to the system.
    pub fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

impl Recording {
    /// Writes all of it.
    pub fn write(&self, to: impl Write) -> io::Result<()> {
        let with_temperature = self.rows.iter().any(|row| row.temp_c.is_some());
        let mut writer = RowWriter::new(to, &self.metadata, with_temperature)?;
        for row in &self.rows {
            writer.row(row)?;
        }
        writer.flush()
    }

    /// The same into a file, which is replaced if it is there.
    pub fn write_file(&self, path: &Path) -> Result<(), RecordingError> {
        let write = || self.write(io::BufWriter::new(std::fs::File::create(path)?));
        write().map_err(|error| RecordingError {
            file: path.display().to_string(),
            line: None,
            column: None,
            problem: Problem::Unwritable(error),
        })
    }
}
