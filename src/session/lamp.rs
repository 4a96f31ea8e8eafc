//! Which pattern the LED shows: the session's, unless the sensor is in trouble.

use tumble_core::led::Pattern;

use crate::led::PATTERN;

/// What is shown and what would be.
#[derive(Default)]
pub struct Lamp {
    session: Pattern,
    error: Option<u8>,
}

impl Lamp {
    /// The session wants this.
    pub fn session(&mut self, pattern: Pattern) {
        self.session = pattern;
        if self.error.is_none() {
            PATTERN.signal(pattern);
        }
    }

    /// The sensor has failed.
    pub fn ill(&mut self, code: u8) {
        self.error = Some(code);
        PATTERN.signal(Pattern::Error(code));
    }

    /// The sensor runs.
    pub fn well(&mut self) {
        self.error = None;
        PATTERN.signal(self.session);
    }
}
