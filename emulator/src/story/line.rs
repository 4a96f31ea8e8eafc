//! What the board says, line by line (`docs/protocol.md`).

/// One line with the board time at which its last byte came.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    pub t_s: f64,
    pub text: String,
    /// Raw frames that came before it, where somebody counts: the board's lines and frames have one order.
    pub after_raw_frames: usize,
}

impl Line {
    /// The `@word` it begins with; empty for a sentence or a frame.
    #[must_use]
    pub fn word(&self) -> &str {
        self.text.split(' ').next().filter(|word| word.starts_with('@')).unwrap_or("")
    }

    /// Whether it begins with this `@word` and has every `key=value` of `pairs`, as in `"@accepted what=turn"`.
    #[must_use]
    pub fn says(&self, pattern: &str) -> bool {
        let mut words = pattern.split(' ');
        words.next() == Some(self.word()) && words.all(|pair| self.text.split(' ').any(|word| word == pair))
    }

    /// The value of `key`; `-` is none.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<&str> {
        let pairs = self.text.split(' ').filter_map(|word| word.split_once('='));
        pairs.filter(|(name, _)| *name == key).map(|(_, value)| value).find(|value| *value != "-")
    }

    /// The same as a number.
    #[must_use]
    pub fn number(&self, key: &str) -> Option<f64> {
        self.value(key)?.parse().ok()
    }

    /// A text value with its spaces back.
    #[must_use]
    pub fn sentence(&self, key: &str) -> String {
        self.value(key).unwrap_or("").replace('_', " ")
    }

    #[must_use]
    pub fn is_frame(&self) -> bool {
        self.text.starts_with("R,") || self.text.starts_with("C,")
    }
}

/// Makes lines of bytes.
#[derive(Debug, Clone, Default)]
pub struct Assembler(Vec<u8>);

impl Assembler {
    pub fn push(&mut self, t_s: f64, byte: u8) -> Option<Line> {
        if byte != b'\n' {
            self.0.push(byte);
            return None;
        }
        let bytes = std::mem::take(&mut self.0);
        let text = String::from_utf8_lossy(&bytes).trim_end_matches('\r').to_owned();
        Some(Line { t_s, text, after_raw_frames: 0 })
    }

    /// What has come of a line that is not whole, and is dropped.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_and_read() {
        let mut ear = Assembler::default();
        let bytes = b"@accepted what=turn face=+x angle_deg=359.82 mass=-\r\n";
        let line = bytes.iter().find_map(|byte| ear.push(1.5, *byte)).expect("a line");
        assert!(line.says("@accepted what=turn") && !line.says("@accepted what=still") && !line.says("@accept"));
        assert_eq!((line.value("face"), line.number("angle_deg")), (Some("+x"), Some(359.82)));
        assert_eq!((line.value("mass"), line.value("what"), line.t_s), (None, Some("turn"), 1.5));
    }
}
