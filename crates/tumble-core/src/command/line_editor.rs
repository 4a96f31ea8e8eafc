//! Bytes from the serial line to commands.

use super::{Command, CommandError};

/// Collects the bytes of one line of at most `N` characters. `\r`, `\n` and `\r\n` end it; backspace (8 or 127) takes the
/// last character back; Ctrl-C and Ctrl-U take all of it back; a tab is a space; NUL, which a break on the line makes, is nothing.
/// Any other byte that is not printable ASCII spoils the line, which is then reported and not guessed at.
#[derive(Clone, Debug, Default)]
pub struct LineEditor<const N: usize> {
    text: heapless::String<N>,
    surplus: usize,
    garbled: usize,
}

impl<const N: usize> LineEditor<N> {
    /// An empty line.
    pub const fn new() -> Self {
        Self { text: heapless::String::new(), surplus: 0, garbled: 0 }
    }

    /// Takes a byte; when it ends a line that is not empty, says what that line means.
    pub fn push(&mut self, byte: u8) -> Option<Result<Command, CommandError>> {
        match byte {
            b'\r' | b'\n' => return self.finish(),
            0 => {}
            8 | 127 => self.backspace(),
            3 | 21 => *self = Self::new(),
            b'\t' => self.append(' '),
            b' '..=b'~' => self.append(char::from(byte)),
            _ => self.garbled = self.garbled.saturating_add(1),
        }
        None
    }

    fn append(&mut self, c: char) {
        if self.surplus > 0 || self.text.push(c).is_err() {
            self.surplus = self.surplus.saturating_add(1);
        }
    }

    fn backspace(&mut self) {
        if self.surplus > 0 {
            self.surplus -= 1;
        } else {
            self.text.pop();
        }
    }

    fn finish(&mut self) -> Option<Result<Command, CommandError>> {
        let line = core::mem::take(self);
        if line.garbled > 0 {
            Some(Err(CommandError::Garbled { bytes: line.garbled }))
        } else if line.surplus > 0 {
            Some(Err(CommandError::TooLong { limit: N }))
        } else {
            Command::parse(&line.text)
        }
    }
}
