//! Messages to text to the console.

use core::fmt;

use heapless::String;
use tumble_core::message::Message;

use crate::console;

/// The longest message, both lines: 700 characters are the most the core says at once.
const LONGEST: usize = 1024;

/// A place to make a message's text in.
#[derive(Default)]
pub struct Voice {
    text: String<LONGEST>,
}

impl Voice {
    /// The machine's line and the person's.
    pub async fn say(&mut self, message: &Message) {
        self.send(|text| message.write_to(text)).await;
    }

    /// The machine's line alone.
    pub async fn remind(&mut self, message: &Message) {
        self.send(|text| message.write_machine_to(text)).await;
    }

    async fn send(&mut self, write: impl FnOnce(&mut String<LONGEST>) -> fmt::Result) {
        self.text.clear();
        if write(&mut self.text).is_err() {
            // Cut off, but still a line of its own.
            self.text.truncate(LONGEST - 2);
            let _ = self.text.push_str("\r\n");
            defmt::warn!("a message is longer than its buffer");
        }
        console::write(&self.text).await;
    }
}
