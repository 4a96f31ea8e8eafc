//! `tumble reveal`.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use tumble_sim::Effect;

use super::{Refusal, output};
use crate::conceal::{Opened, Seal};

/// Tells what a recording of `tumble simulate --conceal` hides. Decide first.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The recording; its seal lies beside it as REC.csv.seal
    #[arg(value_name = "REC.csv")]
    recording: PathBuf,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    let opened = Seal::open(&arguments.recording)?;
    let text = if arguments.json { as_json(&opened) } else { in_words(&opened) };
    Ok(output::print(&text)?)
}

fn as_json(opened: &Opened) -> String {
    let Opened { secret, recording_unchanged } = opened;
    let object = json!({
        "format": "tumble-revealed",
        "version": 1,
        "hidden": secret["hidden"],
        "effects": secret["truth"]["effects"],
        "recording_unchanged": recording_unchanged,
        "truth": secret["truth"],
    });
    format!("{object}\n")
}

fn in_words(opened: &Opened) -> String {
    let mut text = String::new();
    if !opened.recording_unchanged {
        text += "The recording is not the one that was sealed: somebody changed it since.\n";
    }
    match opened.secret["truth"]["effects"].as_array() {
        Some(effects) if !effects.is_empty() => effects.iter().for_each(|effect| tell(&mut text, effect)),
        _ => text += "Hidden: nothing. The recording is clean.\n",
    }
    text
}

fn tell(text: &mut String, effect: &Value) {
    let word = |value: &Value| value.as_str().unwrap_or("?").to_owned();
    let number = |value: &Value| value.as_f64().map_or("?".to_owned(), |v| significant(v).to_string());
    let id = word(&effect["id"]);
    let kind = Effect::kinds().find(|kind| kind.id == id);
    let _ = writeln!(text, "Hidden: {id}, {}.", kind.map_or("an effect of another version", |kind| kind.name));
    let meaning = kind.map_or("its magnitude", |kind| kind.meaning);
    let _ = writeln!(text, "Magnitude: {} {} ({meaning}).", number(&effect["magnitude"]), word(&effect["unit"]));
    for one in effect["parameters"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {} = {} {}", word(&one["name"]), number(&one["value"]), word(&one["unit"]));
    }
}

/// To five digits, as many as a person reads.
fn significant(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.4e}").parse().unwrap_or(value)
}
