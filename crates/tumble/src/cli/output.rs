//! Standard output and error. A reader that went away (`| head`) is no error of ours, and must not be a panic.

use std::io::{self, IsTerminal, Write};

/// Prints to standard output.
pub(super) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// A line on standard error; if even that cannot be written there is nobody left to tell.
pub(super) fn error(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// How far long work is, on standard error, only where a person watches.
pub(super) struct Progress {
    watched: bool,
    shown: Option<u64>,
}

impl Progress {
    pub(super) fn new() -> Self {
        Self { watched: io::stderr().is_terminal(), shown: None }
    }

    /// Shows a share of 0 to 1 in whole percents.
    pub(super) fn share(&mut self, what: &str, share: f32) {
        let percent = (share * 100.0) as u64;
        self.line(percent, &format!("{what}: {percent} %"));
    }

    /// Shows how many there are, every hundredth.
    pub(super) fn count(&mut self, what: &str, count: u64) {
        let hundreds = count / 100;
        self.line(hundreds, &format!("{} {what}", hundreds * 100));
    }

    /// Each state once.
    fn line(&mut self, state: u64, text: &str) {
        if self.watched && self.shown != Some(state) {
            self.shown = Some(state);
            let _ = write!(io::stderr(), "\r{text}\x1b[K");
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
