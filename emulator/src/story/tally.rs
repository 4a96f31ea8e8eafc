//! What the whole story left, and what of it must hold.

use super::acts::{Session, Tumbling};
use super::checks::Checks;
use super::inertial::LevelError;
use super::levelling::{Alignment, Levels};
use super::parameters::Parameters;
use super::score::Score;

/// Beyond this many sigmas an error is no chance.
pub const SIGMAS: f64 = 5.0;
/// Compensated data must keep level to this over the tumbling; the paper's board reached 0.67°.
const LEVEL_DEG: f64 = 0.67;
/// A stamp may be late by an interrupt's latency.
const STAMP_US: f64 = 100.0;

/// Counters of `info` in which a lost sample would show.
const LOSSES: [&str; 4] = ["overruns", "sample_errors", "queue_overflows", "frames_dropped"];

/// A part of the story, judged for itself.
pub fn judge_session(checks: &mut Checks, session: &Session, score: &Score) {
    let (rests, turns) = (session.count("@accepted what=still"), session.count("@accepted what=turn"));
    checks.note(
        "all six rests and all twelve turns were accepted",
        rests >= 6 && turns >= 12 && session.missing() == Some(0.0),
        format!("{rests} rests, {turns} turns, {} refusals", session.count("@refused")),
    );
    let reasons = if session.reasons.is_empty() { String::new() } else { format!(": {}", session.reasons.join("; ")) };
    checks.note(
        "the verdict is accepted",
        session.is_accepted(),
        format!("{}{reasons}", session.verdict.replace('_', " ")),
    );
    checks.note("it was stored in flash", session.stored, "");
    if session.parameters.0.is_empty() {
        checks.note("every error is within 5 sigma", false, "the board gave no parameters");
    } else {
        let beyond = score.beyond(SIGMAS);
        let detail = if beyond.is_empty() { format!("all {}", score.0.len()) } else { beyond.join(", ") };
        checks.note("every error is within 5 sigma", beyond.is_empty(), detail);
    }
    let errors = session.errors();
    checks.note("the board reported no error", errors.is_empty(), errors.join("; "));
}

/// Nothing lost, by the board's own counters.
pub fn judge_counters(checks: &mut Checks, when: &str, info: &[(String, String)]) {
    let value = |key: &str| info.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str());
    let missing: Vec<String> = LOSSES
        .into_iter()
        .filter(|key| value(key) != Some("0"))
        .map(|key| format!("{key}={}", value(key).unwrap_or("-")))
        .collect();
    let samples = value("samples").unwrap_or("-");
    let detail = format!("{samples} samples, {} lost", if missing.is_empty() { "0" } else { "some" });
    let detail = if missing.is_empty() { detail } else { format!("{detail}: {}", missing.join(" ")) };
    checks.note(&format!("no sample was lost {when}"), missing.is_empty(), detail);
}

/// What was said when it was stored, against what is read back after the power cycle.
pub fn judge_record(checks: &mut Checks, hello: &str, said: &Parameters, read_back: &Parameters) {
    checks.note("the record is found after the power cycle", hello == "stored", format!("calibration={hello}"));
    let same = said == read_back && !said.0.is_empty();
    let differing = said.0.iter().filter(|parameter| read_back.get(&parameter.name) != Some(parameter)).count();
    let detail = format!("{} parameters, {differing} differ", read_back.0.len());
    checks.note("what is read back is what was said", same, detail);
}

/// The streams of both tumblings.
pub fn judge_streams(checks: &mut Checks, raw: &Tumbling, cal: &Tumbling, alignment: &Alignment, digit: Option<i32>) {
    let count = raw.frames.raw.len() + cal.frames.compensated.len();
    let lost = raw.frames.lost() + cal.frames.lost();
    let damaged = raw.frames.damaged.len() + cal.frames.damaged.len();
    checks.note(
        "no frame was lost or damaged",
        lost + damaged as u64 == 0 && count > 0,
        format!("{count} frames, {lost} lost, {damaged} damaged"),
    );
    checks.note(
        "raw frames are what the registers held",
        alignment.different == 0 && alignment.stamp_error_us < STAMP_US,
        format!("{} differ; stamps true to {:.1} µs", alignment.different, alignment.stamp_error_us),
    );
    let detail = digit.map_or("they are none of the sensor's samples".to_owned(), |digit| {
        format!("largest difference {digit} in the last digit (1 µrad/s, 1 µm/s²)")
    });
    checks.note("compensated frames are raw ones compensated", digit.is_some_and(|digit| digit <= 1), detail);
}

/// The level errors of both tumblings.
pub fn judge_levels(checks: &mut Checks, levels: &Levels, delivered: &LevelError) {
    for (what, level) in [("computed from raw frames", &levels.compensated), ("of delivered frames", delivered)] {
        let better = level.max_deg < levels.raw_less_bias.max_deg && level.max_deg <= LEVEL_DEG;
        checks.note(
            &format!("compensated data keep level, {what}"),
            better,
            format!("{:.3}° at most, {LEVEL_DEG}° allowed", level.max_deg),
        );
    }
}

/// The table of level errors.
pub fn print_levels(seconds: f64, levels: &Levels, delivered: &LevelError) {
    println!("\nlevel error over {seconds:.0} s of tumbling, degrees     mean      max    final");
    let rows = [
        ("raw", &levels.raw),
        ("raw less its resting bias", &levels.raw_less_bias),
        ("compensated (from the raw frames)", &levels.compensated),
        ("with the true parameters: noise alone", &levels.perfect),
        ("compensated as the board streams it (2nd tumbling)", delivered),
    ];
    for (name, LevelError { mean_deg, max_deg, final_deg }) in rows {
        println!("  {name:<50}{mean_deg:>8.3} {max_deg:>8.3} {final_deg:>8.3}");
    }
}
