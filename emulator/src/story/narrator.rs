//! Tells what happens, as it happens.

use tumble_sim::person::{Note, NoteKind};

use super::line::Line;

/// How much is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Telling {
    #[default]
    Nothing,
    Story,
    /// Every line of the console too, and what the LED shows.
    Everything,
}

#[derive(Debug, Clone, Default)]
pub struct Narrator {
    telling: Telling,
    last_ask: String,
    /// An acceptance that waits for the progress line behind it.
    accepted: Option<(f64, String)>,
    /// What it is busy with, and how far in quarters.
    busy: Option<(String, u32)>,
}

impl Narrator {
    #[must_use]
    pub fn new(telling: Telling) -> Self {
        Self { telling, ..Self::default() }
    }

    /// A heading between two acts.
    pub fn act(&self, text: &str) {
        if self.telling != Telling::Nothing {
            println!("\n{text}");
        }
    }

    /// Something the host does or measures.
    pub fn host(&self, t_s: f64, text: &str) {
        self.tell(t_s, "", text);
    }

    fn tell(&self, t_s: f64, who: &str, text: &str) {
        if self.telling != Telling::Nothing {
            println!("{t_s:8.2} s  {who:<7} {text}");
        }
    }

    pub fn person(&self, note: &Note) {
        match note.kind {
            NoteKind::Did | NoteKind::Typed => self.tell(note.t_s, "person", &note.text),
            NoteKind::Saw if self.telling == Telling::Everything => self.tell(note.t_s, "person", &note.text),
            NoteKind::Saw | NoteKind::Heard => {}
        }
    }

    /// A line of the console that is no frame.
    pub fn board(&mut self, line: &Line) {
        if self.telling == Telling::Everything {
            return self.tell(line.t_s, "board", &line.text);
        }
        if line.word().is_empty() {
            return;
        }
        if let Some((t_s, accepted)) = self.accepted.take() {
            let to_go = line.value("missing").map_or(String::new(), |missing| format!("; {missing} steps to go"));
            self.tell(t_s, "board", &format!("{accepted}{to_go}"));
        }
        if line.says("@accepted") {
            self.accepted = Some((line.t_s, format!("ACCEPTED {}", accepted(line))));
        } else if let Some(text) = self.in_short(line) {
            self.tell(line.t_s, "board", &text);
        }
    }

    fn in_short(&mut self, line: &Line) -> Option<String> {
        let text = |key| line.value(key).unwrap_or("-");
        Some(match line.word() {
            "@hello" => format!(
                "hello: firmware {}, sensor {}, reset by {}, calibration {}",
                text("firmware"),
                text("sensor"),
                text("reset"),
                text("calibration")
            ),
            "@ask" => return self.ask(line),
            "@refused" => {
                let angle = line.value("angle_deg").map_or(String::new(), |angle| format!(" of {angle}°"));
                format!("refused {} {}{angle}: {}", text("what"), line.value("face").unwrap_or(""), text("why"))
            }
            "@busy" => return self.busy(line),
            "@result" => format!("RESULT {}", line.sentence("verdict")),
            "@reason" => format!("  because {}", line.sentence("text")),
            "@stored" => format!("STORED in flash, {} bytes, generation {}", text("bytes"), text("generation")),
            "@error" => format!("error {}: {} {}", text("code"), text("thing"), line.sentence("detail")),
            "@note" if line.says("@note about=started") => {
                format!("session: turns {}, box {}, scheme {}", text("turns"), text("box"), text("scheme"))
            }
            "@note" if line.says("@note about=minimum") => "the minimum is there".to_owned(),
            "@stream" => format!("streams {}", text("kind")),
            "@verify" => format!(
                "pose {}: gravity off {} mg of {} allowed, level off {}° of {}: {}",
                text("pose"),
                text("gravity_error_mg"),
                text("gravity_limit_mg"),
                text("level_error_deg"),
                text("level_limit_deg"),
                if line.says("@verify ok=yes") { "good" } else { "TOO MUCH" }
            ),
            "@verified" => format!("VERIFIED {}", text("verdict")),
            _ => return None,
        })
    }

    /// A request once, however often it repeats.
    fn ask(&mut self, line: &Line) -> Option<String> {
        let what = |key| line.value(key).unwrap_or("");
        let text = match what("want") {
            "place" => format!("asks: put one of {} up", what("faces")),
            "hold" => format!("asks: leave {} alone", line.value("face").unwrap_or("it")),
            "turn" => format!("asks: turn {} once round, {}", what("face"), what("direction")),
            "still" => format!("asks: lay it down ({})", what("why")),
            "pose" => format!("asks: a fresh pose, {} of {} done", line.value("done").unwrap_or("0"), what("of")),
            _ => format!("asks for a word: {}", what("words")),
        };
        if text == self.last_ask {
            return None;
        }
        self.last_ask.clone_from(&text);
        Some(text)
    }

    fn busy(&mut self, line: &Line) -> Option<String> {
        let percent = line.number("percent").unwrap_or(0.0) as u32;
        let now = (line.value("what").unwrap_or("").to_owned(), percent / 25);
        let is_news = self.busy.as_ref().is_none_or(|told| *told != now);
        let text = format!("busy: {} {percent} %", now.0);
        self.busy = Some(now);
        is_news.then_some(text)
    }
}

fn accepted(line: &Line) -> String {
    let face = line.value("face").unwrap_or("");
    match (line.value("angle_deg"), line.value("held_s")) {
        (Some(angle), _) => format!("turn on {face}, {}, {angle}°", line.value("direction").unwrap_or("")),
        (None, Some(held)) => format!("rest on {face}, {held} s"),
        (None, None) => face.to_owned(),
    }
}
