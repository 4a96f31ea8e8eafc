//! Board, world and person together, in steps of 5 ms. The person gets the serial line's bytes and the LED's changes and
//! nothing else, and gives bytes to type and moves of the box.

use std::mem::take;

use tumble_sim::person::Note;
use tumble_sim::sensor::Sheet;
use tumble_sim::{Person, PersonConfig, SensorTruth, World, WorldConfig, motion::Hands};

use super::Failure;
use super::frames::Frames;
use super::line::{Assembler, Line};
use super::narrator::{Narrator, Telling};
use super::theatre::Theatre;
use crate::{Board, BoardOptions, SensorOptions, Stopped};

/// A person notices nothing shorter, and it is 1200 steps a virtual minute.
const STEP_S: f64 = 0.005;
/// The sensor's oscillator runs 1 % fast: the sheet's limit.
const CLOCK_ERROR: f64 = 0.01;

/// Who plays.
#[derive(Debug, Clone)]
pub struct Cast {
    /// Of sensor, hands and noise.
    pub seed: u64,
    /// Turns end by eye and not against a fence.
    pub by_hand: bool,
    /// Pace, mishaps, decisions, and what it types of itself.
    pub person: PersonConfig,
    pub telling: Telling,
    pub options: BoardOptions,
}

impl Cast {
    #[must_use]
    pub fn new(seed: u64, by_hand: bool) -> Self {
        let person = if by_hand { PersonConfig::by_hand(seed) } else { PersonConfig::fenced(seed) };
        let sensor = SensorOptions { clock_error: CLOCK_ERROR, ..SensorOptions::default() };
        let options = BoardOptions { sensor, ..BoardOptions::default() };
        Self { seed, by_hand, person, telling: Telling::Nothing, options }
    }

    /// Sheet errors, noise, delays and warming of the sensor, a table tilted by 1.5°, the sensor (3, 2, 1) cm off the axis. Its sheet does
    /// not say what the gyroscope feels of force; that of a sibling (MPU-6000) says 0.1 °/s a g.
    fn world(&self) -> Result<World, Failure> {
        let mut config = WorldConfig::mpu9250(self.seed);
        let sheet = Sheet { g_sensitivity_dps_per_g: 0.1, ..Sheet::MPU9250 };
        config.sensor.truth = SensorTruth::draw(&sheet, self.seed);
        config.sensor.rate_hz *= 1.0 + self.options.sensor.clock_error;
        if self.by_hand {
            config.motion.hands = Hands::by_hand();
        }
        Ok(World::new(&config)?)
    }
}

pub struct Stage {
    pub board: Board,
    pub theatre: Theatre,
    pub person: Person,
    pub narrator: Narrator,
    /// Everything the board has said but frames.
    pub lines: Vec<Line>,
    pub frames: Frames,
    /// Everything the person has noted.
    pub notes: Vec<Note>,
    ear: Assembler,
    led_seen: usize,
}

impl Stage {
    pub fn new(elf: &[u8], cast: &Cast) -> Result<Self, Failure> {
        let theatre = Theatre::new(cast.world()?);
        let board = Board::new(elf, cast.options.clone(), Box::new(theatre.clone()))?;
        Ok(Self {
            board,
            theatre,
            person: Person::new(cast.person.clone())?,
            narrator: Narrator::new(cast.telling),
            lines: Vec::new(),
            frames: Frames::default(),
            notes: Vec::new(),
            ear: Assembler::default(),
            led_seen: 0,
        })
    }

    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.board.now_s()
    }

    /// One step of everything.
    pub fn step(&mut self) -> Result<Stopped, Failure> {
        let stopped = self.board.run_for(STEP_S)?;
        let now_s = self.board.now_s();
        for (t_s, lit) in &self.board.led_changes()[self.led_seen..] {
            self.person.see_led(*t_s, *lit);
        }
        self.led_seen = self.board.led_changes().len();
        let timed = self.board.serial_read_timed();
        let bytes: Vec<u8> = timed.iter().map(|(_, byte)| *byte).collect();
        self.person.hear(now_s, &bytes);
        for (t_s, byte) in timed {
            if let Some(line) = self.ear.push(t_s, byte) {
                self.take_in(line);
            }
        }
        let person = &mut self.person;
        let typed = self.theatre.with(|world| person.act(now_s, world));
        self.board.serial_write(&typed);
        self.tell_notes();
        Ok(stopped)
    }

    fn take_in(&mut self, mut line: Line) {
        line.after_raw_frames = self.frames.raw.len();
        if line.is_frame() {
            self.frames.take_in(&line);
        } else {
            self.narrator.board(&line);
            self.lines.push(line);
        }
    }

    fn tell_notes(&mut self) {
        for note in self.person.take_notes() {
            self.narrator.person(&note);
            self.notes.push(note);
        }
    }

    pub fn run_for(&mut self, seconds: f64) -> Result<(), Failure> {
        let end_s = self.now_s() + seconds;
        while self.now_s() < end_s {
            self.step()?;
        }
        Ok(())
    }

    /// Runs until one of the lines from the `from`th on [`Line::says`] one of `patterns`; answers its index.
    pub fn until(&mut self, from: usize, patterns: &[&str], at_most_s: f64) -> Result<usize, Failure> {
        let end_s = self.now_s() + at_most_s;
        let mut next = from;
        while self.now_s() < end_s {
            while let Some(line) = self.lines.get(next) {
                if patterns.iter().any(|pattern| line.says(pattern)) {
                    return Ok(next);
                }
                next += 1;
            }
            self.step()?;
        }
        let last = self.lines.iter().rev().find(|line| !line.word().is_empty());
        let last = last.map_or("nothing".to_owned(), |line| format!("{:.1} s: {}", line.t_s, line.text));
        Err(Failure(format!(
            "the board did not say {} within {at_most_s:.0} s; the last it said was {last}",
            patterns.join(" or ")
        )))
    }

    /// Has the person type `word` and waits for its answer; the index of the first line after the typing.
    pub fn ask(&mut self, word: &str, patterns: &[&str], at_most_s: f64) -> Result<usize, Failure> {
        let from = self.lines.len();
        let now_s = self.now_s();
        self.person.instruct(now_s, word);
        self.until(from, patterns, at_most_s)?;
        Ok(from)
    }

    /// The power goes and comes back.
    pub fn power_cycle(&mut self, off_s: f64) -> Result<(), Failure> {
        self.board.power_cycle(off_s)?;
        self.ear.clear();
        Ok(())
    }

    /// The frames since the last call.
    pub fn take_frames(&mut self) -> Frames {
        take(&mut self.frames)
    }
}
