//! From the console's bytes to what they mean to a person: `docs/protocol.md`, the `@` lines only.

use crate::face::Face;
use crate::motion::Direction;

/// Longer lines are not for a person.
const LONGEST_LINE: usize = 512;

/// What the board asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum Ask {
    /// Put one of these faces up.
    Place(Vec<Face>),
    /// Do not touch.
    Hold(Option<Face>),
    /// One full turn; `None` either way round.
    Turn(Option<Face>, Option<Direction>),
    /// Lay it down and let go.
    Still,
    /// A fresh pose; how many are done.
    Pose(u32),
}

/// A line that means something.
#[derive(Debug, Clone, PartialEq)]
pub enum Heard {
    /// The board has started.
    Hello(String),
    /// A request.
    Ask(Ask),
    /// What was done is judged: accepted, refused, or measured during `verify`.
    Verdict(String),
    /// Any other line for programs: the board has answered.
    Answer,
    /// Something that a person reads and remembers: result, storage, verification, error.
    News(String),
}

/// Collects bytes into lines.
#[derive(Debug, Clone, Default)]
pub(super) struct Ear {
    line: Vec<u8>,
    too_long: bool,
}

impl Ear {
    /// What the bytes complete, in order. Anything that is not understood is passed over.
    pub(super) fn listen(&mut self, bytes: &[u8]) -> Vec<Heard> {
        let mut heard = Vec::new();
        for &byte in bytes {
            match byte {
                b'\n' => {
                    let line = core::mem::take(&mut self.line);
                    let whole = !core::mem::take(&mut self.too_long);
                    heard.extend(String::from_utf8(line).ok().filter(|_| whole).as_deref().and_then(understand));
                }
                _ if self.line.len() < LONGEST_LINE => self.line.push(byte),
                _ => self.too_long = true,
            }
        }
        heard
    }
}

/// The value of `key` in a line of `key=value`.
fn value<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.split_whitespace().find_map(|word| word.split_once('=').filter(|(k, _)| *k == key).map(|(_, v)| v))
}

/// What a line means, if anything.
fn understand(line: &str) -> Option<Heard> {
    let line = line.trim();
    let rest = || line.split_once(' ').map_or("", |(_, rest)| rest).to_owned();
    match line.split_whitespace().next()? {
        "@hello" => Some(Heard::Hello(rest())),
        "@ask" => ask(line).map(Heard::Ask),
        "@accepted" | "@refused" | "@verify" => Some(Heard::Verdict(line[1..].to_owned())),
        "@result" | "@reason" | "@stored" | "@verified" | "@error" => Some(Heard::News(line.to_owned())),
        word => word.starts_with('@').then_some(Heard::Answer),
    }
}

/// The request in an `@ask` line.
fn ask(line: &str) -> Option<Ask> {
    let face = || value(line, "face").and_then(Face::parse);
    match value(line, "want")? {
        "place" => {
            let faces: Vec<Face> = value(line, "faces")?.split(',').filter_map(Face::parse).collect();
            (!faces.is_empty()).then_some(Ask::Place(faces))
        }
        "hold" => Some(Ask::Hold(face())),
        "turn" => {
            let direction = match value(line, "direction") {
                Some("ccw") => Some(Direction::Ccw),
                Some("cw") => Some(Direction::Cw),
                _ => None,
            };
            Some(Ask::Turn(face(), direction))
        }
        "still" => Some(Ask::Still),
        "pose" => Some(Ask::Pose(value(line, "done").and_then(|done| done.parse().ok()).unwrap_or(0))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_understood_in_any_pieces() {
        let text = b"Put it down.\r\n@ask want=place faces=+x,-y\r\nR,1,2*00\r\n@ask want=turn face=-z direction=cw\r\n\
            @ask want=turn face=-z direction=either\r\n@ask want=pose done=2 of=6\r\n@ask want=hold face=+x seconds=2.4\r\n";
        let expected = vec![
            Heard::Ask(Ask::Place(vec![Face::PlusX, Face::MinusY])),
            Heard::Ask(Ask::Turn(Some(Face::MinusZ), Some(Direction::Cw))),
            Heard::Ask(Ask::Turn(Some(Face::MinusZ), None)),
            Heard::Ask(Ask::Pose(2)),
            Heard::Ask(Ask::Hold(Some(Face::PlusX))),
        ];
        for piece in [1, 7, 1000] {
            let mut ear = Ear::default();
            let heard: Vec<Heard> = text.chunks(piece).flat_map(|bytes| ear.listen(bytes)).collect();
            assert_eq!(heard, expected);
        }
    }

    #[test]
    fn noise_is_passed_over() {
        let mut ear = Ear::default();
        assert!(
            ear.listen(b"\xff\xfe@ask\r\n@ask want=dance\n@ask want=place faces=up\n@ask want=place\n\n").is_empty()
        );
        assert!(ear.listen(&vec![b'@'; 100_000]).is_empty());
        assert_eq!(ear.listen(b"\nC,1\n@ok command=info\n"), vec![Heard::Answer]);
        assert_eq!(ear.listen(b"@ask want=still\n"), vec![Heard::Ask(Ask::Still)]);
    }
}
