//! The firmware calibrates from a recording: its sensor is fed from a file, and nobody guides or is guided.

use std::path::Path;

use serde_json::json;
use tumble::calibrate::conditions;
use tumble::recording::Recording;
use tumble_core::estimate::Conditions;

use super::Failure;
use super::frames::Frames;
use super::host_path;
use super::line::{Assembler, Line};
use super::narrator::{Narrator, Telling};
use super::parameters::{Parameter, Parameters};
use super::replay_world::ReplayWorld;
use crate::{Board, BoardOptions};

const STEP_S: f64 = 0.005;
/// While no samples come, which the firmware bears for 100 ms.
const SHORT_STEP_S: f64 = 0.0005;
const ANSWER_S: f64 = 2.0;
const ESTIMATE_S: f64 = 120.0;
/// So long the board stands before the recording begins.
const BOOT_S: f64 = 1.0;

/// What the board made of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Replayed {
    pub verdict: String,
    pub reasons: Vec<String>,
    pub parameters: Parameters,
    /// Samples played, of how many there are: the board ends the session itself once it has all it asks for.
    pub played: (usize, usize),
    pub virtual_s: f64,
    pub estimate_s: f64,
    /// Whether the host's tool makes the same numbers, to the last bit, of the samples that the board had; none where a frame of
    /// them was dropped.
    pub same_on_host: Option<bool>,
}

struct Player {
    board: Board,
    world: ReplayWorld,
    narrator: Narrator,
    ear: Assembler,
    lines: Vec<Line>,
    frames: Frames,
}

impl Player {
    fn step(&mut self, seconds: f64) -> Result<(), Failure> {
        self.board.run_for(seconds)?;
        for (t_s, byte) in self.board.serial_read_timed() {
            let Some(mut line) = self.ear.push(t_s, byte) else { continue };
            line.after_raw_frames = self.frames.raw.len();
            if line.is_frame() {
                self.frames.take_in(&line);
            } else {
                self.narrator.board(&line);
                self.lines.push(line);
            }
        }
        Ok(())
    }

    fn find(&self, from: usize, patterns: &[&str]) -> Option<&Line> {
        self.lines.get(from..)?.iter().find(|line| patterns.iter().any(|pattern| line.says(pattern)))
    }

    /// Runs until a line says one of the patterns, or to `end_s`.
    fn until(&mut self, from: usize, patterns: &[&str], end_s: f64, step_s: f64) -> Result<Option<Line>, Failure> {
        loop {
            if let Some(line) = self.find(from, patterns) {
                return Ok(Some(line.clone()));
            }
            let left_s = end_s - self.board.now_s();
            if left_s <= 0.0 {
                return Ok(None);
            }
            self.step(step_s.min(left_s))?;
        }
    }

    /// Types a word and waits for what answers it.
    fn say(&mut self, word: &str, answers: &[&str], at_most_s: f64) -> Result<Option<Line>, Failure> {
        let from = self.lines.len();
        self.board.serial_write(format!("{word}\r\n").as_bytes());
        let end_s = self.board.now_s() + at_most_s;
        self.until(from, answers, end_s, SHORT_STEP_S)
    }

    fn follow(&mut self) {
        // The chip asks anew when its next sample is due.
        self.board.set_world(Box::new(self.world.clone()));
    }
}

/// Reads the recording and plays it to the firmware.
pub fn replay(elf: &[u8], file: &Path, telling: Telling) -> Result<Replayed, Failure> {
    let recording = Recording::read(file).map_err(|error| Failure(error.to_string()))?;
    let mut player = boot(elf, &recording, telling)?;
    let from = player.lines.len();
    let end_s = start(&mut player, &recording)?;
    // Either the board has all that it asks for before the recording ends, or it is told to finish.
    let itself = player.until(from, &["@busy what=estimate", "@result"], end_s + 1e-5, STEP_S)?;
    let left_s = end_s - player.board.now_s();
    player.world.be_silent();
    player.follow();
    if itself.is_none() {
        finish(&mut player)?;
    }
    player.world.stay_at_the_end();
    player.follow();
    let begun_s = player.board.now_s();
    let result = player.until(from, &["@result"], begun_s + ESTIMATE_S, STEP_S)?;
    let result = result.ok_or_else(|| hung(&player.lines))?;
    let estimate_s = player.board.now_s() - begun_s;
    player.until(player.lines.len(), &["@stored", "@ask"], player.board.now_s() + ANSWER_S, STEP_S)?;
    let lines = &player.lines[from..];
    let parameters = Parameters::read(lines);
    let last_s = recording.rows.last().map_or(0.0, |row| row.t_s) - left_s;
    Ok(Replayed {
        verdict: result.value("verdict").unwrap_or("none").to_owned(),
        reasons: lines.iter().filter(|line| line.says("@reason")).map(|line| line.sentence("text")).collect(),
        played: (recording.rows.iter().filter(|row| row.t_s <= last_s).count(), recording.rows.len()),
        virtual_s: player.board.now_s(),
        estimate_s,
        same_on_host: same_on_host(lines, &player.frames, &recording, &parameters),
        parameters,
    })
}

/// The board, started, and streaming what its sensor says so that the host can check it.
fn boot(elf: &[u8], recording: &Recording, telling: Telling) -> Result<Player, Failure> {
    let world = ReplayWorld::new(recording);
    let board = Board::new(elf, BoardOptions::default(), Box::new(world.clone()))?;
    let (narrator, ear) = (Narrator::new(telling), Assembler::default());
    let mut player = Player { board, world, narrator, ear, lines: Vec::new(), frames: Frames::default() };
    let hello = player.until(0, &["@hello"], BOOT_S, STEP_S)?;
    hello.ok_or_else(|| Failure("the board did not say hello within a second".to_owned()))?;
    let streams = player.say("stream raw", &["@stream kind=raw"], ANSWER_S)?;
    streams.ok_or_else(|| hung(&player.lines))?;
    Ok(player)
}

fn same_on_host(lines: &[Line], frames: &Frames, recording: &Recording, said: &Parameters) -> Option<bool> {
    // The board knows standard gravity only.
    let stated = conditions(&recording.metadata);
    let conditions = Conditions { gravity_mps2: Conditions::CAUTIOUS.gravity_mps2, ..stated };
    let frames = host_path::session_frames(lines, frames)?;
    Some(host_path::compute(&frames, conditions).is_some_and(|computed| computed == *said))
}

/// Types `calibrate` as the recording says, and plays: the session's first sample is the recording's. Answers when its
/// last comes.
fn start(player: &mut Player, recording: &Recording) -> Result<f64, Failure> {
    let metadata = &recording.metadata;
    let turns = metadata.turns.unwrap_or_default().name();
    let faces = metadata.box_faces.unwrap_or_default().name();
    player.world.be_silent();
    player.follow();
    let word = format!("calibrate {turns} {faces}");
    player.narrator.host(player.board.now_s(), &format!("types `{word}` and plays the recording"));
    let answer = player.say(&word, &["@ok command=calibrate", "@error"], ANSWER_S)?;
    match answer {
        Some(line) if line.says("@ok") => {}
        Some(line) => return Err(Failure(line.sentence("detail"))),
        None => return Err(hung(&player.lines)),
    }
    let start_s = player.board.now_s() + SHORT_STEP_S;
    let end_s = player.world.play(start_s);
    player.follow();
    Ok(end_s)
}

fn finish(player: &mut Player) -> Result<(), Failure> {
    let answers = ["@busy what=estimate", "@result", "@refused what=finish", "@error"];
    let answer = player.say("finish", &answers, ANSWER_S)?.ok_or_else(|| hung(&player.lines))?;
    if answer.says("@refused") {
        let missing = |what, key| answer.value(key).map(|list| format!("{what} {list}"));
        let missing: Vec<String> = [missing("no rest with these up:", "faces"), missing("no full turn about:", "axes")]
            .into_iter()
            .flatten()
            .collect();
        return Err(Failure(format!(
            "the recording lacks what nothing can be computed without: {}",
            missing.join("; ")
        )));
    }
    if answer.says("@error") {
        return Err(Failure(format!("{}: {}", answer.value("thing").unwrap_or(""), answer.sentence("detail"))));
    }
    Ok(())
}

fn hung(lines: &[Line]) -> Failure {
    let last = lines.iter().rev().find(|line| !line.word().is_empty());
    let last = last.map_or("nothing", |line| line.text.as_str());
    Failure(format!("the board gave no answer; the last it said was {last}"))
}

impl Replayed {
    #[must_use]
    pub fn is_accepted(&self) -> bool {
        self.verdict.starts_with("accepted")
    }

    pub fn print(&self) {
        let (played, all) = self.played;
        if played < all {
            println!("\nthe board had all it asks for after {played} of {all} samples and ended the session itself");
        }
        println!("\nverdict: {}", self.verdict.replace('_', " "));
        for reason in &self.reasons {
            println!("  - {reason}");
        }
        println!("\n{:<24} {:>5} {:>15} {:>13}", "parameter", "unit", "estimate", "one sigma");
        for Parameter { name, value, sigma, unit, observable } in &self.parameters.0 {
            let number = |value: &Option<f32>| value.map_or("-".to_owned(), |value| format!("{value:.7}"));
            let value = if *observable { number(value) } else { "not seen".to_owned() };
            println!("{name:<24} {unit:>5} {value:>15} {:>13}", number(sigma));
        }
        let same = match self.same_on_host {
            Some(true) => "the host's tool computes the same numbers from the board's samples, bit for bit",
            Some(false) => "THE HOST'S TOOL COMPUTES OTHER NUMBERS from the board's samples",
            None => "not every sample was streamed, so the host's tool could not be compared",
        };
        println!("\n{same}");
        println!("{:.1} virtual seconds, {:.2} s of them for the estimate", self.virtual_s, self.estimate_s);
    }

    #[must_use]
    pub fn json(&self) -> String {
        let parameters = self.parameters.0.iter().map(|p| {
            json!({ "name": p.name, "value": p.value, "sigma": p.sigma, "unit": p.unit, "observable": p.observable })
        });
        let parameters: Vec<_> = parameters.collect();
        json!({ "params": parameters, "verdict": self.verdict, "reasons": self.reasons,
            "same_on_host": self.same_on_host })
        .to_string()
    }
}
