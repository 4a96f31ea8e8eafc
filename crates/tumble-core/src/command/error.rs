//! What is said of a line that is no command.

use core::fmt;

use super::{WORDS, Word};

/// A typed word, as far as it is worth repeating: what does not fit is cut off.
pub type Typed = heapless::String<16>;

/// Why a line was not understood. [`fmt::Display`] says what was wrong and what would be right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// Longer than the editor holds; nothing of it was used.
    TooLong {
        /// How many bytes a line may have.
        limit: usize,
    },
    /// Bytes that are not text, as a wrong baud rate makes them.
    Garbled {
        /// How many.
        bytes: usize,
    },
    /// The first word is none of [`WORDS`].
    UnknownWord {
        /// What was typed.
        typed: Typed,
        /// The word that is probably meant.
        nearest: Option<&'static str>,
    },
    /// The word takes no such argument.
    UnknownArgument {
        /// The word.
        word: &'static Word,
        /// What was typed after it.
        typed: Typed,
        /// The argument that is probably meant.
        nearest: Option<&'static str>,
    },
    /// The word needs an argument.
    MissingArgument {
        /// The word.
        word: &'static Word,
    },
    /// More arguments than the word takes, or two that contradict each other.
    Surplus {
        /// The word.
        word: &'static Word,
        /// The argument that is too many.
        typed: Typed,
    },
}

pub(super) fn shorten(typed: &str) -> Typed {
    let mut short = Typed::new();
    for c in typed.chars() {
        if short.push(c.to_ascii_lowercase()).is_err() {
            break;
        }
    }
    short
}

/// The valid word that begins with what was typed, or lies within two slips of the finger of it.
pub(super) fn nearest(typed: &str, valid: impl Iterator<Item = &'static str> + Clone) -> Option<&'static str> {
    let typed = shorten(typed);
    let begun = valid.clone().find(|word| typed.len() > 1 && word.starts_with(typed.as_str()));
    let slips = |word: &&str| (distance(word.as_bytes(), typed.as_bytes()), word.len());
    begun.or_else(|| valid.min_by_key(slips).filter(|word| slips(word).0 <= 2.min(word.len() / 2)))
}

/// Levenshtein's distance of words of at most 16 bytes, in one row: insert, remove or replace a byte.
pub(super) fn distance(a: &[u8], b: &[u8]) -> usize {
    let mut row: [usize; 17] = core::array::from_fn(|i| i);
    for (i, x) in a.iter().enumerate() {
        let (mut diagonal, mut left) = (i, i + 1);
        for (cell, y) in row.iter_mut().skip(1).zip(b) {
            let best = (diagonal + usize::from(x != y)).min(left + 1).min(*cell + 1);
            diagonal = *cell;
            *cell = best;
            left = best;
        }
    }
    if b.is_empty() { a.len() } else { row.get(b.len()).copied().unwrap_or(usize::MAX) }
}

fn list(f: &mut fmt::Formatter<'_>, names: impl Iterator<Item = &'static str>) -> fmt::Result {
    names.enumerate().try_for_each(|(i, name)| write!(f, "{}{name}", if i == 0 { "" } else { ", " }))
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong { limit } => {
                write!(
                    f,
                    "That line is longer than {limit} characters, so nothing of it was used. Type one word a line."
                )
            }
            Self::Garbled { bytes } => write!(
                f,
                "That line holds {bytes} bytes that are not text. Set the terminal to 460800 baud, 8N1, and try again."
            ),
            Self::UnknownWord { typed, nearest: Some(word) } => {
                write!(f, "I do not know the word \"{typed}\". Did you mean \"{word}\"? Type \"help\" for all words.")
            }
            Self::UnknownWord { typed, nearest: None } => {
                write!(f, "I do not know the word \"{typed}\". I know: ")?;
                list(f, WORDS.iter().map(|word| word.name))?;
                f.write_str(".")
            }
            Self::UnknownArgument { word, typed, nearest } => unknown_argument(f, word, typed, *nearest),
            Self::MissingArgument { word } => {
                write!(f, "\"{}\" needs to know what to do. Type it as: {} {}.", word.name, word.name, word.usage)
            }
            Self::Surplus { word, typed } if word.arguments.is_empty() => {
                write!(f, "\"{}\" stands alone: leave out \"{typed}\".", word.name)
            }
            Self::Surplus { word, typed } => write!(
                f,
                "\"{typed}\" is too much, or contradicts what stands before it. Type it as: {} {}.",
                word.name, word.usage
            ),
        }
    }
}

fn unknown_argument(f: &mut fmt::Formatter<'_>, word: &Word, typed: &Typed, nearest: Option<&str>) -> fmt::Result {
    write!(f, "After \"{}\" I do not understand \"{typed}\". ", word.name)?;
    if let Some(near) = nearest {
        write!(f, "Did you mean \"{near}\"? ")?;
    }
    f.write_str("It can be: ")?;
    list(f, word.arguments.iter().copied())?;
    f.write_str(".")
}
