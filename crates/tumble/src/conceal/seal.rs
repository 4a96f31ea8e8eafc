//! The sealed file beside a recording: unreadable by accident, not by intent.
//!
//! Three lines: `tumble-seal 1`, the FNV-1a hash (64 bits, hexadecimal) of the recording's bytes, and the secret as
//! JSON, filled with spaces to a multiple of 8 KiB so that its length tells nothing, XORed with a keystream (splitmix64
//! begun with the hash) and written in hexadecimal. The hash is there to say whether the recording is still the one
//! that was sealed.

use std::path::{Path, PathBuf};

use serde_json::Value;
use thiserror::Error;

const FIRST_LINE: &str = "tumble-seal 1";
const BLOCK: usize = 8192;

/// A seal and the recording that it belongs to.
pub struct Seal {
    hash: u64,
    text: String,
}

/// What a seal hid.
pub struct Opened {
    /// The secret.
    pub secret: Value,
    /// Whether the recording is the one that was sealed, to the byte.
    pub recording_unchanged: bool,
}

/// Why a seal cannot be opened.
#[derive(Debug, Error)]
pub enum SealError {
    /// A file that cannot be read or written.
    #[error("{file}: {error}")]
    File {
        /// As the person named it.
        file: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// Something else, or damaged.
    #[error("{file} is no seal of this program, or damaged: {what}")]
    Damaged {
        /// As the person named it.
        file: String,
        /// Where it went wrong.
        what: &'static str,
    },
    /// The secret is not JSON, which cannot happen.
    #[error("the secret cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// Where a recording's seal lies: `REC.csv.seal`.
pub fn path_of(recording: &Path) -> PathBuf {
    let mut name = recording.as_os_str().to_owned();
    name.push(".seal");
    PathBuf::from(name)
}

impl Seal {
    /// Seals a secret for a recording of these bytes.
    pub fn new(recording: &[u8], secret: &impl serde::Serialize) -> Result<Self, SealError> {
        let mut text = serde_json::to_string(secret)?;
        let whole = text.len().div_ceil(BLOCK) * BLOCK;
        text.extend(std::iter::repeat_n(' ', whole - text.len()));
        Ok(Self { hash: fnv(recording), text })
    }

    /// Writes it beside the recording.
    pub fn write(&self, recording: &Path) -> Result<PathBuf, SealError> {
        let path = path_of(recording);
        let hidden = self.text.bytes().zip(keystream(self.hash)).map(|(byte, key)| format!("{:02x}", byte ^ key));
        let text = format!("{FIRST_LINE}\n{:016x}\n{}\n", self.hash, hidden.collect::<String>());
        std::fs::write(&path, text).map_err(|error| at(&path, error))?;
        Ok(path)
    }

    /// Opens the seal of a recording.
    pub fn open(recording: &Path) -> Result<Opened, SealError> {
        let bytes = std::fs::read(recording).map_err(|error| at(recording, error))?;
        let (hash, secret) = Self::secret(&path_of(recording))?;
        Ok(Opened { secret, recording_unchanged: fnv(&bytes) == hash })
    }

    /// Opens a seal whose recording may be gone: the recording's hash, and the secret.
    pub fn secret(path: &Path) -> Result<(u64, Value), SealError> {
        let text = std::fs::read_to_string(path).map_err(|error| at(path, error))?;
        let damaged = |what| SealError::Damaged { file: path.display().to_string(), what };
        let mut lines = text.lines();
        if lines.next() != Some(FIRST_LINE) {
            return Err(damaged("its first line"));
        }
        let hash =
            lines.next().and_then(|line| u64::from_str_radix(line, 16).ok()).ok_or(damaged("its second line"))?;
        let hidden = lines.next().and_then(unhex).ok_or(damaged("its third line"))?;
        let plain: Vec<u8> = hidden.into_iter().zip(keystream(hash)).map(|(byte, key)| byte ^ key).collect();
        let secret = serde_json::from_slice(&plain).map_err(|_| damaged("what it hides"))?;
        Ok((hash, secret))
    }
}

fn at(path: &Path, error: std::io::Error) -> SealError {
    SealError::File { file: path.display().to_string(), error }
}

/// Pairs of hexadecimal digits.
fn unhex(line: &str) -> Option<Vec<u8>> {
    let digits: Option<Vec<u8>> = line.chars().map(|c| c.to_digit(16).and_then(|d| u8::try_from(d).ok())).collect();
    let digits = digits?;
    let (pairs, rest) = digits.as_chunks::<2>();
    rest.is_empty().then(|| pairs.iter().map(|[high, low]| high << 4 | low).collect())
}

fn fnv(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3))
}

/// splitmix64, eight bytes a step.
fn keystream(seed: u64) -> impl Iterator<Item = u8> {
    let mut state = seed;
    std::iter::repeat_with(move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (mixed ^ (mixed >> 31)).to_le_bytes()
    })
    .flatten()
}
