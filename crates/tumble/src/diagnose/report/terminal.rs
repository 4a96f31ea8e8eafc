//! The story at a terminal: at most [`MOST_LINES`] lines of [`WIDTH`] columns.

use super::words;
use crate::diagnose::diagnosis::{Diagnosis, Found, Verdict};
use crate::diagnose::exhibits::Exhibits;

/// A screen's worth, with room for the command that was typed.
pub const MOST_LINES: usize = 20;
/// Columns.
pub const WIDTH: usize = 100;
/// Columns of the words before each paragraph.
const LABEL: usize = 12;
/// Effects told in full; further ones get a line each.
const IN_FULL: usize = 2;
/// Numbers of an effect that are printed: those that differ most from none.
const NUMBERS: usize = 4;

/// Lines, and a limit on those of a paragraph.
struct Story {
    lines: Vec<String>,
}

impl Story {
    /// A paragraph with its label; what does not fit in `most` lines ends in an ellipsis.
    fn say(&mut self, label: &str, text: &str, most: usize) {
        let mut lines = wrap(text, WIDTH - LABEL);
        if lines.len() > most {
            lines.truncate(most);
            if let Some(last) = lines.last_mut() {
                while last.chars().count() > WIDTH - LABEL - 4 {
                    last.pop();
                }
                last.push_str(" ...");
            }
        }
        for (k, line) in lines.iter().enumerate() {
            let label = if k == 0 { label } else { "" };
            self.lines.push(format!("{label:<LABEL$}{line}").trim_end().to_owned());
        }
    }
}

/// The whole story.
pub fn story(diagnosis: &Diagnosis, exhibits: Option<&Exhibits>) -> String {
    let mut story = Story { lines: Vec::new() };
    story.say(word(diagnosis.verdict), &words::verdict(diagnosis), 4);
    let alone = diagnosis.unknown.is_none();
    let full = if alone { IN_FULL } else { 1 };
    for (k, found) in diagnosis.effects.iter().take(full).enumerate() {
        effect(&mut story, found, exhibits, k == 0 && alone);
        // A second effect takes the line of a second recording.
        let others = if diagnosis.effects.len() == 1 { 2 } else { 1 };
        found
            .other_recordings
            .iter()
            .take(others)
            .for_each(|other| story.say("elsewhere", &words::elsewhere(other), 1));
    }
    let rest: Vec<&str> = diagnosis.effects.iter().skip(full).map(|found| found.id.as_str()).collect();
    if !rest.is_empty() {
        story.say("also", &rest.join(", "), 1);
    }
    if let Some(unknown) = &diagnosis.unknown {
        let label = if diagnosis.effects.is_empty() { "where" } else { "unknown at" };
        story.say(label, &place(&unknown.place, exhibits), 1);
        if !unknown.correlates_with.is_empty() {
            story.say("follows", &words::shapes(unknown).join("; "), 2);
        }
        story.say("like", &words::resemblance(unknown), 2);
    }
    fit(&mut story, diagnosis);
    limits(&mut story, diagnosis);
    // The verdict of a recording that cannot tell is its first reason already.
    let told = usize::from(diagnosis.verdict == Verdict::NotTestable);
    for reason in diagnosis.reasons.iter().skip(told) {
        let room = MOST_LINES.saturating_sub(story.lines.len()).min(2);
        if room > 0 {
            story.say("note", &words::sentence(reason), room);
        }
    }
    story.lines.truncate(MOST_LINES);
    story.lines.join("\n") + "\n"
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingMissing => "COMPLETE",
        Verdict::EffectFound => "FOUND",
        Verdict::UnknownEffect => "UNKNOWN",
        Verdict::NotTestable => "CANNOT TELL",
    }
}

/// Six lines at most, or four.
fn effect(story: &mut Story, found: &Found, exhibits: Option<&Exhibits>, full: bool) {
    story.say("where", &place(&found.place, exhibits), 1);
    let (lines, mut shown) = (if full { 2 } else { 1 }, NUMBERS);
    let what = |shown: usize| format!("{}: {}; {}", found.id, found.equation, numbers(found, shown));
    while shown > 1 && wrap(&what(shown), WIDTH - LABEL).len() > lines {
        shown -= 1;
    }
    story.say("what", &what(shown), lines);
    let rival = match &found.runner_up {
        Some(rival) => format!("; next best {}, {:.1} less", rival.id, rival.gap),
        None => String::new(),
    };
    let sure = format!("{} (ln Bayes factor {:.1}){rival}", words::odds(found.evidence), found.evidence);
    if full {
        story.say("how sure", &sure, 1);
        if let Some(ties) = words::ties(found) {
            story.say("tied", &ties, 2);
        }
    } else {
        let tied = if found.tied_with.is_empty() { "" } else { "; tied with " };
        story.say("how sure", &format!("{sure}{tied}{}", found.tied_with.join(", ")), 2);
    }
}

fn place(place: &crate::diagnose::diagnosis::Place, exhibits: Option<&Exhibits>) -> String {
    let channels = if place.channels.is_empty() { "all channels".into() } else { place.channels.join(", ") };
    let segments = match place.segments.as_slice() {
        [] => String::new(),
        some => format!("; segments {}", words::segments(some, exhibits)),
    };
    format!("{channels}; {:.1} to {:.1} s{segments}", place.start_s, place.end_s)
}

/// Those `shown` that stand out most, in the effect's own order.
fn numbers(found: &Found, shown: usize) -> String {
    let mut order: Vec<usize> = (0..found.parameters.len()).collect();
    let significance = |i: usize| words::significance(&found.parameters[i]);
    order.sort_by(|a, b| significance(*b).total_cmp(&significance(*a)));
    order.truncate(shown);
    order.sort_unstable();
    let texts: Vec<String> = order.into_iter().map(|i| words::parameter(&found.parameters[i])).collect();
    let more = match found.parameters.len().saturating_sub(shown) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    texts.join(", ") + &more
}

fn fit(story: &mut Story, diagnosis: &Diagnosis) {
    let (before, after) = (diagnosis.fit.before, diagnosis.fit.after);
    if before.train <= 0.0 {
        return;
    }
    let figure = words::figure;
    let text = if diagnosis.effects.is_empty() {
        // What came near explaining an unknown is not named, but what it would leave is told.
        let near = if diagnosis.unknown.is_some() && after.train < 0.98 * before.train {
            format!("; {} with the nearest of the effects I know", figure(after.train))
        } else {
            String::new()
        };
        format!("{}{near} (1 is noise alone)", figure(before.train))
    } else {
        format!(
            "{} -> {} on all data; {} -> {} on data left out of the fit (1: noise)",
            figure(before.train),
            figure(after.train),
            figure(before.held_out),
            figure(after.held_out)
        )
    };
    story.say("left over", &text, 1);
}

/// One line, two at most.
fn limits(story: &mut Story, diagnosis: &Diagnosis) {
    let limits = &diagnosis.detection_limits;
    if limits.is_empty() {
        return;
    }
    let blind: Vec<&str> = limits.iter().filter(|limit| !limit.testable).map(|limit| limit.id.as_str()).collect();
    let seen = format!("{} of {} effects would have shown at a usual size", limits.len() - blind.len(), limits.len());
    let text = if blind.is_empty() { seen + "." } else { format!("{seen}; not: {}.", blind.join(", ")) };
    story.say("limits", &text, 2);
}

/// Words into lines; a word longer than a line is cut.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let letters: Vec<char> = word.chars().collect();
        for piece in letters.chunks(width) {
            let piece: String = piece.iter().collect();
            let last = lines.len() - 1;
            let room = lines[last].chars().count() + 1 + piece.chars().count() <= width;
            if lines[last].is_empty() {
                lines[last] = piece;
            } else if room {
                lines[last] = format!("{} {piece}", lines[last]);
            } else {
                lines.push(piece);
            }
        }
    }
    lines
}
