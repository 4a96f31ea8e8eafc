//! The acts of the story, each with what it leaves for the score.

use super::Failure;
use super::frames::Frames;
use super::line::Line;
use super::parameters::Parameters;
use super::stage::Stage;

/// The most virtual time a guided session may take; a careful person takes four minutes.
const SESSION_S: f64 = 1800.0;
/// The same for `verify`, computing (10 s at most on the part) and a plain answer.
const VERIFY_S: f64 = 400.0;
const ESTIMATE_S: f64 = 120.0;
pub const ANSWER_S: f64 = 15.0;
/// Rest before a tumbling, of which the middle gives the resting bias, and after it.
const REST_S: f64 = 6.0;
const REST_AFTER_S: f64 = 2.0;

/// What a guided session came to.
#[derive(Debug, Clone)]
pub struct Session {
    pub lines: Vec<Line>,
    /// Between these the data were taken.
    pub from_s: f64,
    pub to_s: f64,
    pub verdict: String,
    pub reasons: Vec<String>,
    pub parameters: Parameters,
    pub stored: bool,
    pub estimate: Estimate,
}

/// What the estimate took on the microcontroller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    pub seconds: f64,
    pub instructions: u64,
}

impl Session {
    #[must_use]
    pub fn count(&self, pattern: &str) -> usize {
        self.lines.iter().filter(|line| line.says(pattern)).count()
    }

    #[must_use]
    pub fn is_accepted(&self) -> bool {
        self.verdict.starts_with("accepted")
    }

    /// Steps that were still missing when it ended.
    #[must_use]
    pub fn missing(&self) -> Option<f64> {
        self.lines.iter().rev().find(|line| line.says("@progress"))?.number("missing")
    }

    /// Everything the board called an error.
    #[must_use]
    pub fn errors(&self) -> Vec<String> {
        self.lines.iter().filter(|line| line.says("@error")).map(|line| line.text.clone()).collect()
    }
}

/// The board starts and says hello.
pub fn boot(stage: &mut Stage) -> Result<Line, Failure> {
    let from = stage.lines.len();
    let at = stage.until(from, &["@hello"], ANSWER_S)?;
    Ok(stage.lines[at].clone())
}

/// From the person's word to a stored calibration, or to a verdict against it. The person has been told, or tells itself,
/// to type `calibrate`, and the answer is to come after line `from`.
pub fn calibrate(stage: &mut Stage, from: usize) -> Result<Session, Failure> {
    let from = stage.until(from, &["@ok command=calibrate"], ANSWER_S)?;
    let from_s = stage.lines[from].t_s;
    let busy = stage.until(from, &["@busy what=estimate", "@result", "@ask want=word"], SESSION_S)?;
    let begun = (stage.now_s(), stage.board.instructions());
    let result = stage.until(busy, &["@result", "@ask want=word"], ESTIMATE_S)?;
    let estimate = Estimate { seconds: stage.now_s() - begun.0, instructions: stage.board.instructions() - begun.1 };
    let verdict = stage.lines[result].value("verdict").unwrap_or("none").to_owned();
    let end = if verdict.starts_with("accepted") { &["@stored", "@error", "@ask want=word"][..] } else { &["@ask"] };
    let end = stage.until(result, end, ANSWER_S)?;
    stage.run_for(0.2)?;
    let lines = stage.lines[from..].to_vec();
    let accepted = lines.iter().rev().find(|line| line.says("@accepted"));
    Ok(Session {
        from_s,
        to_s: accepted.map_or(stage.now_s(), |line| line.t_s),
        verdict,
        reasons: lines.iter().filter(|line| line.says("@reason")).map(|line| line.sentence("text")).collect(),
        parameters: Parameters::read(&lines),
        stored: stage.lines[end].says("@stored"),
        estimate,
        lines,
    })
}

/// The calibration in flash, as the board exports it.
pub fn export(stage: &mut Stage) -> Result<Parameters, Failure> {
    let from = stage.ask("cal export", &["@ok command=cal", "@error"], ANSWER_S)?;
    Ok(Parameters::read(&stage.lines[from..]))
}

/// The board's counters, as `key=value` of its `@info` lines.
pub fn info(stage: &mut Stage) -> Result<Vec<(String, String)>, Failure> {
    let from = stage.ask("info", &["@ok command=info"], ANSWER_S)?;
    let lines = stage.lines[from..].iter().filter(|line| line.says("@info"));
    let pairs = lines.flat_map(|line| line.text.split(' ').filter_map(|word| word.split_once('=')));
    Ok(pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).collect())
}

/// A tumbling with the frames the board streamed of it.
#[derive(Debug, Clone)]
pub struct Tumbling {
    pub frames: Frames,
    /// The rest before it.
    pub rest_s: (f64, f64),
    pub end_s: f64,
}

/// The person tumbles the box in the hands while the board streams `kind`.
pub fn tumble(stage: &mut Stage, kind: &str, seconds: f64) -> Result<Tumbling, Failure> {
    stage.take_frames();
    stage.ask(&format!("stream {kind}"), &["@stream"], ANSWER_S)?;
    let rest_from_s = stage.now_s() + 0.5;
    stage.run_for(REST_S)?;
    let now_s = stage.now_s();
    let person = &mut stage.person;
    let end_s = stage.theatre.with(|world| person.tumble(now_s, world, seconds, 1.0));
    stage.run_for(end_s - now_s + REST_AFTER_S)?;
    stage.ask("stream off", &["@stream"], ANSWER_S)?;
    stage.run_for(0.1)?;
    Ok(Tumbling { frames: stage.take_frames(), rest_s: (rest_from_s, now_s), end_s })
}

/// Six fresh poses; the board's `@verified` line.
pub fn verify(stage: &mut Stage) -> Result<Line, Failure> {
    let from = stage.ask("verify", &["@ok command=verify", "@error"], ANSWER_S)?;
    let at = stage.until(from, &["@verified", "@error"], VERIFY_S)?;
    Ok(stage.lines[at].clone())
}
