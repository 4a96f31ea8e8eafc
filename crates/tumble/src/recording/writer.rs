//! From rows to text.

use std::io::{self, Write};
use std::path::Path;

use super::{Recording, RecordingError, Row};
use crate::recording::Problem;

impl Recording {
    /// Writes the contract's format. Numbers are Rust's shortest decimals that read back as the same `f64`, so reading
    /// what was written gives exactly the same rows.
    pub fn write(&self, to: &mut impl Write) -> io::Result<()> {
        for line in self.metadata.lines() {
            writeln!(to, "{line}")?;
        }
        let with_temperature = self.rows.iter().any(|row| row.temp_c.is_some());
        let temperature = if with_temperature { ",temp_c" } else { "" };
        writeln!(to, "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g{temperature}")?;
        for row in &self.rows {
            write_row(to, row, with_temperature)?;
        }
        to.flush()
    }

    /// The same into a file, which is replaced if it is there.
    pub fn write_file(&self, path: &Path) -> Result<(), RecordingError> {
        let write = || self.write(&mut io::BufWriter::new(std::fs::File::create(path)?));
        write().map_err(|error| RecordingError {
            file: path.display().to_string(),
            line: None,
            column: None,
            problem: Problem::Unwritable(error),
        })
    }
}

fn write_row(to: &mut impl Write, row: &Row, with_temperature: bool) -> io::Result<()> {
    write!(to, "{}", row.t_s)?;
    for value in row.channels() {
        write!(to, ",{value}")?;
    }
    match row.temp_c {
        Some(value) => writeln!(to, ",{value}"),
        None if with_temperature => writeln!(to, ","),
        None => writeln!(to),
    }
}
