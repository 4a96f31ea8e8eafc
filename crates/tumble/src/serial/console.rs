//! `tumble console`: a plain terminal. Lines for programs (`@…`) are left out unless asked for.

use std::io::{self, BufRead, Write};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use serialport::SerialPort;

use super::{Line, Lines, SerialError};

/// Runs until standard input or the line ends.
pub fn console(
    mut port: Box<dyn SerialPort>,
    with_machine_lines: bool,
    mut tell: impl FnMut(&str),
) -> Result<(), SerialError> {
    let reader = port.try_clone().map_err(io::Error::from)?;
    let mut lines = Lines::new(reader);
    let typed = typed_lines();
    loop {
        match typed.try_recv() {
            Ok(line) => port.write_all(format!("{}\r\n", line.trim_end()).as_bytes())?,
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return Ok(()),
        }
        match lines.next_line()? {
            Line::Text(line) if with_machine_lines || !line.starts_with('@') => tell(&line),
            Line::Text(_) | Line::Nothing => {}
            Line::End => return Ok(()),
        }
    }
}

/// Reading standard input blocks, so a thread does it; it ends with the program.
fn typed_lines() -> Receiver<String> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for line in io::stdin().lock().lines() {
            let Ok(line) = line else { return };
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}
