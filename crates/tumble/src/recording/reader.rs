//! From text to rows, refusing with a place and a remedy.

use std::path::Path;

use csv::StringRecord;

use super::error::{Problem, RecordingError};
use super::{Metadata, Recording, Row, time_us, units};

/// The columns of the contract that must be there.
const NEEDED: [&str; 7] = ["t_s", "gx_dps", "gy_dps", "gz_dps", "ax_g", "ay_g", "az_g"];
const TEMPERATURE: &str = "temp_c";
/// From a stamp to the next where that one is not later, s: told apart at 1 µs whatever the rounding.
const APART_S: f64 = 2e-6;

impl Recording {
    /// Reads and checks a file.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        Self::read_file(path, Stamps::Increase)
    }

    /// The same for a diagnosis, to which stamps that repeat or run back by less than half a second are something to be found: each
    /// is set 2 µs after the one before, and a notice says how many.
    pub fn read_with_its_stamps(path: &Path) -> Result<Self, RecordingError> {
        Self::read_file(path, Stamps::Repeat)
    }

    /// [`Self::read`] from memory; `file` is what messages call it.
    pub fn from_bytes(bytes: &[u8], file: &str) -> Result<Self, RecordingError> {
        Self::parse(bytes, file, Stamps::Increase)
    }

    fn read_file(path: &Path, stamps: Stamps) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        match std::fs::read(path) {
            Ok(bytes) => Self::parse(&bytes, &file, stamps),
            Err(error) => Err(whole_file(&file, Problem::Unreadable(error))),
        }
    }

    fn parse(bytes: &[u8], file: &str, stamps: Stamps) -> Result<Self, RecordingError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes); // a spreadsheet's mark of UTF-8
        let text = std::str::from_utf8(bytes).map_err(|error| not_utf8(bytes, error.valid_up_to(), file))?;
        let (metadata, head_lines, table) = split_head(text, file)?;
        Table { file, head_lines, text: table, stamps }.read(metadata)
    }
}

fn whole_file(file: &str, problem: Problem) -> RecordingError {
    RecordingError { file: file.into(), line: None, column: None, problem }
}

fn not_utf8(bytes: &[u8], offset: usize, file: &str) -> RecordingError {
    let line = 1 + bytes[..offset].iter().filter(|&&b| b == b'\n').count() as u64;
    let problem = Problem::NotUtf8 { offset, byte: bytes[offset] };
    RecordingError { line: Some(line), ..whole_file(file, problem) }
}

/// True for lines that carry no sample.
fn is_skipped(line: &str) -> bool {
    line.trim().is_empty() || line.starts_with('#')
}

/// The metadata, how many lines they take, and the text from the header on.
fn split_head<'a>(text: &'a str, file: &str) -> Result<(Metadata, u64, &'a str), RecordingError> {
    let mut metadata = Metadata::default();
    let mut rest = text;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        if !is_skipped(line) {
            return Ok((metadata, index as u64, rest));
        }
        metadata
            .read_line(line.trim())
            .map_err(|problem| RecordingError { line: Some(index as u64 + 1), ..whole_file(file, problem) })?;
        rest = &rest[line.len()..];
    }
    Err(whole_file(file, Problem::Empty))
}

/// Where each needed column stands in a line.
struct Columns {
    needed: [usize; 7],
    temperature: Option<usize>,
    count: usize,
}

/// What stamps may do.
#[derive(Clone, Copy, PartialEq)]
enum Stamps {
    Increase,
    /// And run back a little.
    Repeat,
}

/// The part of the file from the header on.
struct Table<'a> {
    file: &'a str,
    head_lines: u64,
    text: &'a str,
    stamps: Stamps,
}

impl Table<'_> {
    fn read(&self, metadata: Metadata) -> Result<Recording, RecordingError> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true) // a wrong number of fields is ours to report, with its remedy
            .has_headers(false)
            .from_reader(self.text.as_bytes());
        let mut record = StringRecord::new();
        self.next(&mut reader, &mut record)?;
        let columns = self.columns(&record)?;
        let (mut rows, mut stamps_s, mut moved): (Vec<Row>, Vec<f64>, u32) = (Vec::new(), Vec::new(), 0);
        while self.next(&mut reader, &mut record)? {
            let is_last = reader.position().byte() as usize >= self.text.len();
            let mut row = self.row(&record, &columns, is_last)?;
            stamps_s.push(row.t_s);
            if let Err(problem) = in_time(&rows, &row) {
                let before_s = rows.last().map_or(0.0, |row| row.t_s);
                if self.stamps == Stamps::Increase || row.t_s < before_s - Problem::LATEST_S {
                    return Err(self.at(&record, Some("t_s"), problem));
                }
                row.t_s = before_s + APART_S;
                moved += 1;
            }
            rows.push(row);
        }
        let mut notices = self.drop_unfinished(&mut rows);
        if moved > 0 {
            notices.push(format!("{moved} of {} stamps are not later than the one before", rows.len()));
        } else {
            stamps_s.clear();
        }
        stamps_s.truncate(rows.len());
        if rows.is_empty() {
            return Err(whole_file(self.file, Problem::NoSamples));
        }
        units::check(&rows).map_err(|problem| whole_file(self.file, problem))?;
        Ok(Recording { metadata, rows, notices, stamps_s })
    }

    /// The only error left to the `csv` crate here is one of reading from memory, which cannot happen.
    fn next(&self, reader: &mut csv::Reader<&[u8]>, record: &mut StringRecord) -> Result<bool, RecordingError> {
        reader
            .read_record(record)
            .map_err(|error| whole_file(self.file, Problem::Unreadable(std::io::Error::other(error))))
    }

    fn columns(&self, header: &StringRecord) -> Result<Columns, RecordingError> {
        let names: Vec<&str> = header.iter().collect();
        let place = |problem| self.at(header, None, problem);
        let find = |name: &str| {
            let mut hits = names.iter().enumerate().filter(|(_, n)| **n == name).map(|(index, _)| index);
            match (hits.next(), hits.next()) {
                (Some(_), Some(_)) => Err(place(Problem::DuplicateColumn { name: name.into() })),
                (hit, _) => Ok(hit),
            }
        };
        let mut needed = [0; 7];
        for (slot, name) in needed.iter_mut().zip(NEEDED) {
            *slot = find(name)?
                .ok_or_else(|| place(Problem::MissingColumn { name, found: shortened(&names.join(", ")) }))?;
        }
        Ok(Columns { needed, temperature: find(TEMPERATURE)?, count: names.len() })
    }

    fn row(&self, record: &StringRecord, columns: &Columns, is_last: bool) -> Result<Row, RecordingError> {
        let (found, expected) = (record.len(), columns.count);
        if found != expected {
            let cut = is_last && found < expected;
            let problem =
                if cut { Problem::Truncated { found, expected } } else { Problem::FieldCount { found, expected } };
            return Err(self.at(record, None, problem));
        }
        let mut values = [0.0; 7];
        for ((value, &index), name) in values.iter_mut().zip(&columns.needed).zip(NEEDED) {
            *value = number(&record[index]).and_then(finite).map_err(|problem| self.at(record, Some(name), problem))?;
        }
        let temp_c = match columns.temperature.map(|index| &record[index]) {
            None | Some("") => None,
            Some(field) => {
                let value = number(field).map_err(|problem| self.at(record, Some(TEMPERATURE), problem))?;
                finite(value).ok()
            }
        };
        let [t_s, gx, gy, gz, ax, ay, az] = values;
        Ok(Row { t_s, gyro_dps: [gx, gy, gz], accel_g: [ax, ay, az], temp_c })
    }

    /// Without a line end, a last line of the right number of fields may still be cut within its last number, which
    /// nobody could tell (`-0.98` of `-0.981`): one sample is a small price for never taking such a value.
    fn drop_unfinished(&self, rows: &mut Vec<Row>) -> Vec<String> {
        if self.text.ends_with('\n') || rows.len() < 2 {
            return Vec::new();
        }
        rows.pop();
        vec!["the last line has no line end and may be cut: its sample was left out".into()]
    }

    fn at(&self, record: &StringRecord, column: Option<&str>, problem: Problem) -> RecordingError {
        RecordingError {
            file: self.file.into(),
            line: Some(self.line_of(record)),
            column: column.map(Into::into),
            problem,
        }
    }

    /// The `csv` crate's position is where it began to look for a record, before comments and empty lines.
    fn line_of(&self, record: &StringRecord) -> u64 {
        let Some(position) = record.position() else { return self.head_lines + 1 };
        let before = &self.text[..position.byte() as usize];
        let skipped = self.text[before.len()..].split_inclusive('\n').take_while(|line| is_skipped(line)).count();
        self.head_lines + 1 + (before.matches('\n').count() + skipped) as u64
    }
}

/// Is a row later than those before?
fn in_time(rows: &[Row], row: &Row) -> Result<(), Problem> {
    let (Some(first), Some(previous)) = (rows.first(), rows.last()) else { return Ok(()) };
    let us = |r: &Row| time_us(r.t_s, first.t_s);
    if row.t_s > previous.t_s && us(row) > us(previous) {
        return Ok(());
    }
    Err(Problem::TimeNotIncreasing { time_s: row.t_s, previous_s: previous.t_s })
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 120;
    if text.chars().count() <= LONGEST {
        text.into()
    } else {
        text.chars().take(LONGEST).chain("…".chars()).collect()
    }
}

/// The number and its text, which the next check may have to quote.
fn number(field: &str) -> Result<(f64, &str), Problem> {
    field.parse().map(|value| (value, field)).map_err(|_| Problem::NotANumber { value: shortened(field) })
}

fn finite((value, field): (f64, &str)) -> Result<f64, Problem> {
    if value.is_finite() { Ok(value) } else { Err(Problem::NotFinite { value: field.into() }) }
}
