//! A person who calibrates a board: hears only the serial console, sees only the LED, and has hands.
//!
//! A pure state machine: time comes in with every call, and what leaves are moves of the box and words to type. It knows
//! nothing of the truth, and nothing of the firmware beyond `docs/protocol.md`.
//!
//! It does what was asked last, after a reaction time, once, and then waits for the verdict; if it still hears the same
//! request after its patience has run out, it does it again. While its hands are on the box it finishes what it does.

mod config;
mod deed;
mod ear;
mod eye;

pub use config::{Clumsiness, Note, NoteKind, PersonConfig};
pub use ear::{Ask, Heard};

use crate::error::SimError;
use crate::face::Face;
use crate::rng::{Purpose, Rng};
use crate::world::World;
use ear::Ear;
use eye::{Eye, Sight};

/// A request older than this is over: the board repeats each one every second.
const REQUEST_LIVES_S: f64 = 2.5;
/// So long it gives the board to judge what it has just done, s.
const VERDICT_S: f64 = 2.0;
/// It types its first words after this long without a hello, s.
const SILENCE_S: f64 = 4.0;
/// It types again what was not answered after this long, s.
const ANSWER_S: f64 = 3.0;
/// How often it tries, and how long it lets a steady LED keep it from doing what it was asked, s.
const TRIES: u32 = 3;
const LED_PATIENCE_S: f64 = 3.0;

/// A request as it was heard.
#[derive(Debug, Clone, PartialEq)]
struct Request {
    ask: Ask,
    first_s: f64,
    last_s: f64,
}

/// Words that are to be typed, or that wait for an answer.
#[derive(Debug, Clone, PartialEq)]
struct Words {
    text: String,
    due_s: f64,
    tries: u32,
}

/// The simulated person.
#[derive(Debug, Clone)]
pub struct Person {
    config: PersonConfig,
    rng: Rng,
    ear: Ear,
    eye: Eye,
    favourites: [Face; 6],
    up: Option<Face>,
    request: Option<Request>,
    due_s: Option<f64>,
    done: Option<(Ask, f64)>,
    busy_until_s: f64,
    bump_due_s: Option<f64>,
    mishaps: u32,
    words: Vec<Words>,
    unanswered: Option<Words>,
    first_act_s: Option<f64>,
    started: bool,
    notes: Vec<Note>,
}

impl Person {
    /// Someone who sits before a box with `+z` up.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(config: PersonConfig) -> Result<Self, SimError> {
        config.check()?;
        let mut rng = Rng::new(config.seed, Purpose::Person);
        let mut favourites = Face::ALL;
        rng.shuffle(&mut favourites);
        Ok(Self {
            config,
            rng,
            ear: Ear::default(),
            eye: Eye::default(),
            favourites,
            up: Some(Face::PlusZ),
            request: None,
            due_s: None,
            done: None,
            busy_until_s: f64::NEG_INFINITY,
            bump_due_s: None,
            mishaps: 0,
            words: Vec::new(),
            unanswered: None,
            first_act_s: None,
            started: false,
            notes: Vec::new(),
        })
    }

    /// Bytes from the serial console.
    pub fn hear(&mut self, now_s: f64, bytes: &[u8]) {
        for heard in self.ear.listen(bytes) {
            self.take_in(now_s, heard);
        }
    }

    /// The LED is lit or dark; call it whenever it changes, or as often as you like.
    pub fn see_led(&mut self, now_s: f64, lit: bool) {
        self.eye.see(now_s, lit);
    }

    /// Time passes: moves the box if it is time to, and returns what is typed now. Call it every few milliseconds.
    pub fn act(&mut self, now_s: f64, world: &mut World) -> Vec<u8> {
        self.look(now_s);
        self.start_in_silence(now_s);
        self.move_box(now_s, world);
        self.type_words(now_s)
    }

    /// Someone tells the person to type this next; it does so after its reaction time.
    pub fn instruct(&mut self, now_s: f64, text: &str) {
        let due_s = now_s + self.reaction_s();
        self.words.push(Words { text: text.to_owned(), due_s, tries: 0 });
    }

    /// Someone tells the person to tumble the box in its hands. Returns when it is back on the table.
    pub fn tumble(&mut self, now_s: f64, world: &mut World, duration_s: f64, violence: f64) -> f64 {
        let start_s = now_s.max(self.busy_until_s) + self.reaction_s();
        self.note(start_s, NoteKind::Did, format!("tumbles the box in the hands for {duration_s:.0} s"));
        self.busy_until_s = world.motion.push(start_s, crate::Primitive::Tumble { duration_s, violence });
        self.busy_until_s
    }

    /// The narrative since the last call.
    pub fn take_notes(&mut self) -> Vec<Note> {
        core::mem::take(&mut self.notes)
    }

    /// Until when its hands are on the box, s.
    pub fn busy_until_s(&self) -> f64 {
        self.busy_until_s
    }

    /// How often it was clumsy.
    pub fn mishaps(&self) -> u32 {
        self.mishaps
    }

    fn note(&mut self, t_s: f64, kind: NoteKind, text: String) {
        self.notes.push(Note { t_s, kind, text });
    }

    fn reaction_s(&mut self) -> f64 {
        let (low, high) = self.config.reaction_s;
        self.rng.uniform(low, high)
    }

    /// What a line does to the person.
    fn take_in(&mut self, now_s: f64, heard: Heard) {
        match heard {
            Heard::Hello(text) => {
                self.note(now_s, NoteKind::Heard, format!("hello {text}"));
                self.forget();
                self.start(now_s);
            }
            Heard::Ask(ask) => {
                self.unanswered = None;
                self.take_request(now_s, ask);
            }
            // What was asked before is settled: the next request is a new one.
            Heard::Verdict(text) => {
                self.forget();
                self.note(now_s, NoteKind::Heard, text);
            }
            Heard::Answer => self.unanswered = None,
            Heard::News(line) => {
                self.unanswered = None;
                self.note(now_s, NoteKind::Heard, line);
            }
        }
    }

    fn forget(&mut self) {
        (self.request, self.due_s, self.done) = (None, None, None);
    }

    fn take_request(&mut self, now_s: f64, ask: Ask) {
        if let Some(request) = self.request.as_mut().filter(|request| request.ask == ask) {
            // The same after a long silence is a new request, for which patience begins anew.
            if now_s - request.last_s > REQUEST_LIVES_S {
                request.first_s = now_s;
            }
            request.last_s = now_s;
            return;
        }
        if matches!(ask, Ask::Hold(_)) {
            self.perhaps_bump(now_s);
        }
        self.due_s = None;
        self.request = Some(Request { ask, first_s: now_s, last_s: now_s });
    }

    /// Types the first words, once.
    fn start(&mut self, now_s: f64) {
        if let Some(text) = self.config.start_words.clone().filter(|_| !self.started) {
            self.started = true;
            self.instruct(now_s, &text);
        }
    }

    fn start_in_silence(&mut self, now_s: f64) {
        let first_s = *self.first_act_s.get_or_insert(now_s);
        if now_s - first_s > SILENCE_S {
            self.start(now_s);
        }
    }

    fn look(&mut self, now_s: f64) {
        let text = match self.eye.news(now_s) {
            Some(Sight::Steady) => "the LED stays on: hands off".to_owned(),
            Some(Sight::Blinks(count)) => format!("the LED blinks {count} times"),
            None => return,
        };
        self.note(now_s, NoteKind::Saw, text);
    }

    /// What is due to be typed, and what was not answered.
    fn type_words(&mut self, now_s: f64) -> Vec<u8> {
        if self.unanswered.as_ref().is_some_and(|words| words.due_s <= now_s) {
            self.words.extend(self.unanswered.take().filter(|words| words.tries < TRIES));
        }
        let (due, later): (Vec<Words>, Vec<Words>) = self.words.drain(..).partition(|words| words.due_s <= now_s);
        self.words = later;
        let mut bytes = Vec::new();
        for words in due {
            bytes.extend_from_slice(words.text.as_bytes());
            bytes.extend_from_slice(b"\r\n");
            let again = if words.tries > 0 { " again" } else { "" };
            self.note(now_s, NoteKind::Typed, format!("types `{}`{again}", words.text));
            self.unanswered = Some(Words { due_s: now_s + ANSWER_S, tries: words.tries + 1, ..words });
        }
        bytes
    }
}
