//! The answer for people: one page with its pictures, the same story for a terminal, and the contract's object.

pub mod channels;
pub mod evidence;
pub mod heat;
pub mod html;
pub mod isolable;
mod page;
pub mod scatter;
mod sections;
pub mod svg;
pub mod terminal;
pub mod words;

use std::io;
use std::path::{Path, PathBuf};

use super::diagnosis::Diagnosis;
use super::exhibits::Exhibits;

pub use page::page;
pub use terminal::story;

/// Whose diagnosis it is.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// As it was named.
    pub file: String,
    /// As it says itself, if it does.
    pub sensor: Option<String>,
    /// Samples.
    pub samples: usize,
    /// From first to last.
    pub length_s: f64,
}

/// Writes `report.html` and `diagnosis.json` into a folder, which is made; the page's path.
///
/// # Errors
/// If the folder or a file cannot be written.
pub fn write(
    folder: &Path,
    source: &Source,
    diagnosis: &Diagnosis,
    exhibits: Option<&Exhibits>,
) -> io::Result<PathBuf> {
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("diagnosis.json"), serde_json::to_string_pretty(diagnosis)? + "\n")?;
    let path = folder.join("report.html");
    std::fs::write(&path, page(source, diagnosis, exhibits))?;
    Ok(path)
}
