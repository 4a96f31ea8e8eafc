//! A machine line, read: for the host's console and for whoever plays the person.

use crate::face::Face;

/// `@word key=value key=value`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// What stands behind the `@`.
    pub word: &'a str,
    pairs: &'a str,
}

impl<'a> Line<'a> {
    /// Reads one line, with or without its end; none if it does not begin with `@` and a word.
    pub fn parse(line: &'a str) -> Option<Self> {
        let rest = line.trim_end().strip_prefix('@')?;
        let (word, pairs) = rest.split_once(' ').unwrap_or((rest, ""));
        (!word.is_empty()).then_some(Self { word, pairs })
    }

    /// The value of a key; none if the key is not there or its value is absent (`-`).
    pub fn get(&self, key: &str) -> Option<&'a str> {
        self.pairs().find(|(found, _)| *found == key).map(|(_, value)| value).filter(|value| *value != "-")
    }

    /// A value as a number; none if it is absent or no number.
    pub fn number<T: core::str::FromStr>(&self, key: &str) -> Option<T> {
        self.get(key)?.parse().ok()
    }

    /// A value as a face; none if it is absent or no face.
    pub fn face(&self, key: &str) -> Option<Face> {
        self.get(key).and_then(Face::from_name)
    }

    /// A value as faces in the order in which they stand; what is no face is left out.
    pub fn faces(&self, key: &str) -> impl Iterator<Item = Face> + 'a {
        self.get(key).unwrap_or("").split(',').filter_map(Face::from_name)
    }

    /// All keys with their values, absent ones as `-`.
    pub fn pairs(&self) -> impl Iterator<Item = (&'a str, &'a str)> + 'a {
        self.pairs.split_ascii_whitespace().filter_map(|pair| pair.split_once('='))
    }
}
