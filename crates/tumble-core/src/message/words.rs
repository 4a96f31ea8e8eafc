//! Small pieces that many messages share.

use core::fmt::{self, Display, Write};

use crate::calibration::Verdict;
use crate::face::{Face, FaceSet};

/// Passes text on with everything that is not a visible ASCII character as an underscore: a value of a machine line.
pub struct Underscored<'a, W: Write>(pub &'a mut W);

impl<W: Write> Write for Underscored<'_, W> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.chars().try_for_each(|c| self.0.write_char(if c.is_ascii_graphic() { c } else { '_' }))
    }
}

/// A text as a value of a machine line: underscored, `-` if it is empty.
pub struct Plain<'a>(pub &'a str);

impl Display for Plain<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() { f.write_str("-") } else { Underscored(f).write_str(self.0) }
    }
}

/// A value that may be absent: `-` then.
pub struct Maybe<T>(pub Option<T>);

impl<T: Display> Display for Maybe<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Some(value) => value.fmt(f),
            None => f.write_str("-"),
        }
    }
}

/// Names with a separator between them and another before the last; `-` for none.
pub struct Listed<I>(pub I, pub &'static str, pub &'static str);

impl<I: Iterator<Item = Face> + Clone> Display for Listed<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.0.clone().count();
        for (i, face) in self.0.clone().enumerate() {
            let gap = if i == 0 {
                ""
            } else if i + 1 == count {
                self.2
            } else {
                self.1
            };
            write!(f, "{gap}{}", face.name())?;
        }
        if count == 0 { f.write_str("-") } else { Ok(()) }
    }
}

/// `+x,-y` for a machine line.
pub fn faces(set: FaceSet) -> impl Display {
    Listed(ordered(set), ",", ",")
}

/// `+x, -y or +z` for a person.
pub fn any_face(set: FaceSet) -> impl Display {
    Listed(ordered(set), ", ", " or ")
}

/// `+x, -y and +z` for a person.
pub fn all_faces(set: FaceSet) -> impl Display {
    Listed(ordered(set), ", ", " and ")
}

/// A set in the order of asking.
pub fn ordered(set: FaceSet) -> impl Iterator<Item = Face> + Clone {
    crate::face::ASKING_ORDER.into_iter().filter(move |face| set.contains(*face))
}

/// Where the arrow of a face points: `the x arrow up`.
pub struct Arrow(pub Face);

impl Display for Arrow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the {} arrow pointing {}", axis(self.0.axis()), if self.0.sign() > 0.0 { "up" } else { "down" })
    }
}

/// `x`, `y`, `z` for 0, 1, 2.
pub fn axis(index: usize) -> &'static str {
    ["x", "y", "z"].get(index).copied().unwrap_or("?")
}

/// `yes` or `no`.
pub fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

/// As in the contract.
pub fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Accepted => "accepted",
        Verdict::AcceptedWithWarnings => "accepted_with_warnings",
        Verdict::Rejected => "rejected",
    }
}

/// An angle for a machine line, degrees.
pub fn degrees(angle_rad: f32) -> f32 {
    angle_rad / crate::DEGREE_RAD
}
