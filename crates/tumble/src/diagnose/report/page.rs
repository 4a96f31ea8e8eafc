//! The page: sections in the order in which a person asks.

use super::html::{escape, paragraph};
use super::{Source, sections, words};
use crate::diagnose::diagnosis::{Diagnosis, Verdict};
use crate::diagnose::exhibits::Exhibits;

const STYLE: &str = include_str!("style.css");

/// One file without a reference to any other.
pub fn page(source: &Source, diagnosis: &Diagnosis, exhibits: Option<&Exhibits>) -> String {
    let mut body = String::new();
    body += &sections::place(diagnosis, exhibits);
    body += &sections::what(diagnosis, exhibits);
    body += &sections::fit(diagnosis);
    body += &sections::regressions(diagnosis, exhibits);
    body += &sections::evidence(diagnosis, exhibits);
    body += &sections::isolability(exhibits);
    body += &sections::unknown(diagnosis);
    body += &sections::limits(diagnosis);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <title>Diagnosis of {file}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>What this recording contains that the model leaves out</h1>\n{about}</header>\n<main>\n{verdict}{body}</main>\n\
         <footer>\n<p>Made by tumble diagnose. Everything on this page is in this one file; the numbers are in \
         diagnosis.json beside it.</p>\n</footer>\n</body>\n</html>\n",
        file = escape(&source.file),
        about = about(source),
        verdict = verdict(diagnosis),
    )
}

fn about(source: &Source) -> String {
    let sensor = source.sensor.as_deref().unwrap_or("sensor not stated");
    let text = format!("{}: {sensor}, {} samples, {:.1} s", source.file, source.samples, source.length_s);
    format!("<p class=\"source\">{}</p>\n", escape(&text))
}

fn verdict(diagnosis: &Diagnosis) -> String {
    let class = match diagnosis.verdict {
        Verdict::NothingMissing | Verdict::EffectFound => "verdict",
        Verdict::UnknownEffect | Verdict::NotTestable => "verdict warn",
    };
    let mut text =
        format!("<section id=\"verdict\">\n<p class=\"{class}\">{}</p>\n", escape(&words::verdict(diagnosis)));
    // The verdict of a recording that cannot tell is its first reason already.
    let told = usize::from(diagnosis.verdict == Verdict::NotTestable);
    for reason in diagnosis.reasons.iter().skip(told) {
        text += &paragraph(&words::sentence(reason));
    }
    text + "</section>\n"
}
