//! What kind of person it is, and what it remembers having done.

use crate::error::SimError;

/// How a simulated person behaves.
#[derive(Debug, Clone, PartialEq)]
pub struct PersonConfig {
    /// What it types when the board says hello, or after four seconds of silence; `None` to type nothing of itself.
    pub start_words: Option<String>,
    /// From hearing to moving: uniform between these, s.
    pub reaction_s: (f64, f64),
    /// A full turn takes uniformly between these, s.
    pub turn_s: (f64, f64),
    /// A re-orientation, s.
    pub move_s: (f64, f64),
    /// After doing what was asked, it waits this long for another request before it does it again, s.
    pub patience_s: f64,
    /// What goes wrong, and how often.
    pub clumsiness: Clumsiness,
    /// Seed of its decisions.
    pub seed: u64,
}

impl PersonConfig {
    /// Careful, with a fence; pair it with [`crate::motion::Hands::fenced`].
    pub fn fenced(seed: u64) -> Self {
        Self {
            start_words: Some("calibrate fenced square".to_owned()),
            reaction_s: (0.3, 1.2),
            turn_s: (8.0, 12.0),
            move_s: (2.2, 3.8),
            patience_s: 6.0,
            clumsiness: Clumsiness::default(),
            seed,
        }
    }

    /// Careful, without a fence; pair it with [`crate::motion::Hands::by_hand`].
    pub fn by_hand(seed: u64) -> Self {
        Self { start_words: Some("calibrate by-hand square".to_owned()), ..Self::fenced(seed) }
    }

    /// Refuses times that cannot be lived.
    ///
    /// # Errors
    /// Names the first setting out of its range.
    pub fn check(&self) -> Result<(), SimError> {
        let ranges = [("reaction_s", self.reaction_s), ("turn_s", self.turn_s), ("move_s", self.move_s)];
        for (name, (low, high)) in ranges {
            SimError::check(name, low, |v| v >= 0.0, "0 or more")?;
            SimError::check(name, high, |v| v >= low && v <= 600.0, "at least its lower limit and at most 600 s")?;
        }
        SimError::check("patience_s", self.patience_s, |v| v >= 0.0, "0 or more")
    }
}

/// Probabilities of mishaps at each opportunity; all 0 by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Clumsiness {
    /// Bumps into the table during a hold.
    pub bump: f64,
    /// Turns the wrong way round.
    pub wrong_direction: f64,
    /// Stops a turn at 200–300°.
    pub short_turn: f64,
    /// Puts a face up that was not asked for.
    pub wrong_face: f64,
    /// At most this many mishaps in all, so that a session can still end; `None` for no limit.
    pub at_most: Option<u32>,
}

/// What a note is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoteKind {
    /// It heard the console.
    Heard,
    /// It saw the LED.
    Saw,
    /// It moved the box.
    Did,
    /// It typed.
    Typed,
}

/// One line of the narrative.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// s.
    pub t_s: f64,
    /// What it is about.
    pub kind: NoteKind,
    /// For a reader.
    pub text: String,
}
