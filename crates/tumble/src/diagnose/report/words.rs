//! The sentences: one source for the page and the terminal.

use crate::diagnose::diagnosis::{Diagnosis, Found, OtherRecording, Unknown, Value, Verdict};
use crate::diagnose::exhibits::Exhibits;

/// The verdict in a sentence that a person understands.
pub fn verdict(diagnosis: &Diagnosis) -> String {
    match diagnosis.verdict {
        Verdict::NothingMissing => format!(
            "Nothing is missing: the ordinary sensor model explains this recording ({}).",
            left(diagnosis.fit.before.train)
        ),
        Verdict::EffectFound => format!("{}{}", capital(&names(&diagnosis.effects)), fall(diagnosis)),
        Verdict::UnknownEffect => unknown(diagnosis),
        Verdict::NotTestable => match diagnosis.reasons.first() {
            Some(reason) => format!("This recording cannot tell: {}", sentence(reason)),
            None => "This recording cannot tell.".into(),
        },
    }
}

fn names(effects: &[Found]) -> String {
    let names: Vec<&str> = effects.iter().map(|found| found.name.as_str()).collect();
    match names.as_slice() {
        [] => "an effect was found".into(),
        [one] => (*one).into(),
        [some @ .., last] => format!("{}, and {last}", some.join(", ")),
    }
}

/// What modelling it did to data that it was not fitted to.
fn fall(diagnosis: &Diagnosis) -> String {
    let (before, after) = (diagnosis.fit.before.held_out, diagnosis.fit.after.held_out);
    if before <= 0.0 {
        return ".".into(); // nothing was fitted: the samples themselves show it
    }
    let which = if diagnosis.effects.len() > 1 { "these" } else { "that" };
    let (from, to) = (figure(before), figure(after));
    if after > 1.02 * before {
        return format!(
            "; but with {which} modelled, more was left over than before in data it had not seen ({from}, then {to}): do not \
             trust the name."
        );
    }
    let verb = if after < 0.98 * before { "fell" } else { "went" };
    format!(
        "; with {which} modelled, what was left over in data it had not seen {verb} from {from} to {to} (1 is noise alone)."
    )
}

fn unknown(diagnosis: &Diagnosis) -> String {
    let known = match diagnosis.effects.as_slice() {
        [] => String::new(),
        found => format!(" Beside it: {}.", names(found)),
    };
    let follows = match diagnosis.unknown.as_ref().and_then(|unknown| unknown.correlates_with.first()) {
        Some(shape) => format!("; it follows {shape}."),
        None => ".".into(),
    };
    format!("Something is missing, and it is none of the effects I know{follows}{known}")
}

fn left(mean_square: f64) -> String {
    format!("left over {}, noise alone leaves up to 1", figure(mean_square))
}

/// What an unknown is like, and how sure it is that there is one.
pub fn resemblance(unknown: &Unknown) -> String {
    let alike = match unknown.resembles.as_slice() {
        [] => "None of the effects I know is like it.".into(),
        ids => format!("It resembles {}, but they do not explain it all.", ids.join(", ")),
    };
    format!("{alike} Chance leaves as much {}.", rarely(unknown.p_value))
}

/// A probability of chance, in words.
pub fn rarely(p: f64) -> String {
    if p >= 0.05 {
        format!("in {} of 100 recordings", figure(100.0 * p))
    } else {
        format!("in fewer than one of {} recordings", large(1.0 / p.max(1e-300)))
    }
}

/// ln of a Bayes factor as odds.
pub fn odds(evidence: f64) -> String {
    let side = if evidence < 0.0 { "against" } else { "for" };
    if !evidence.is_finite() {
        return "odds beyond reckoning".into();
    }
    let size = evidence.abs();
    // exp overflows at 709; from 10^9 on only the power is told.
    let odds =
        if size < 20.0 { large(size.exp()) } else { format!("10^{:.0}", (size / std::f64::consts::LN_10).floor()) };
    format!("odds {odds} to 1 {side} it")
}

/// A large number for reading: `120`, `45 000`, `3 million`, `10^52`.
fn large(value: f64) -> String {
    if value < 100.0 {
        figure(value)
    } else if value < 1e4 {
        format!("{:.0}", two_digits(value))
    } else if value < 1e6 {
        format!("{:.0} 000", two_digits(value) / 1e3)
    } else if value < 1e9 {
        format!("{:.0} million", two_digits(value) / 1e6)
    } else {
        format!("10^{:.0}", value.log10().floor())
    }
}

fn two_digits(value: f64) -> f64 {
    let unit = 10_f64.powf(value.abs().max(f64::MIN_POSITIVE).log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// A number to three figures, never in 20 digits.
pub fn figure(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        "?".into()
    } else if size >= 1e5 || (size < 1e-3 && size > 0.0) {
        format!("{value:.1e}")
    } else if size >= 100.0 {
        format!("{value:.0}")
    } else if size >= 9.995 {
        format!("{value:.1}")
    } else if size >= 0.0995 || size == 0.0 {
        format!("{value:.2}")
    } else {
        format!("{value:.4}")
    }
}

/// `x = 0.0981 ± 0.0032 dps/g`, as many decimals as the sigma deserves: its two leading digits.
pub fn parameter(value: &Value) -> String {
    let [size, sigma] = size_and_sigma(value);
    format!("{} = {size} ± {sigma} {}", value.name, value.unit)
}

/// A value and its sigma to the same decimals, `?` where there is no number.
pub fn size_and_sigma(value: &Value) -> [String; 2] {
    let decimals = decimals(value.sigma);
    [value.value, value.sigma]
        .map(|number| if number.abs() < 1e7 { format!("{number:.decimals$}") } else { figure(number) })
}

/// Decimals that show two digits of a sigma.
fn decimals(sigma: f64) -> usize {
    if sigma <= 0.0 || !sigma.is_finite() {
        return 3;
    }
    (1.0 - sigma.log10().floor()).clamp(0.0, 9.0) as usize
}

/// By how many sigmas it differs from none.
pub fn significance(value: &Value) -> f64 {
    if value.sigma > 0.0 { (value.value / value.sigma).abs() } else { 0.0 }
}

/// Halves of the recording against each other.
pub fn constancy(found: &Found) -> Option<String> {
    let p = found.held_out?.constancy_p;
    Some(if p > 0.05 {
        "Both halves of the recording give the same numbers within their sigmas.".into()
    } else if p > 0.001 {
        format!("The halves of the recording give somewhat different numbers (by chance {}).", rarely(p))
    } else {
        "The halves of the recording give different numbers: it is not constant, or not quite this.".into()
    })
}

/// An unknown's shapes, each once.
pub fn shapes(unknown: &Unknown) -> Vec<String> {
    let mut shapes: Vec<String> = Vec::new();
    for shape in &unknown.correlates_with {
        if !shapes.contains(shape) {
            shapes.push(shape.clone());
        }
    }
    shapes
}

/// The same numbers on another recording. Nothing was fitted to them there, so that half the fall of the sum of squares is
/// itself the ln of a Bayes factor: 3 are odds of 20 to 1.
pub fn elsewhere(other: &OtherRecording) -> String {
    let verdict = match other.gain {
        gain if gain > 3.0 => "it holds in",
        gain if gain < -3.0 => "it does NOT hold in",
        _ => "not to be told from",
    };
    let file =
        std::path::Path::new(&other.file).file_name().map_or(other.file.as_str().into(), |name| name.to_string_lossy());
    let (before, after) = (figure(other.before), figure(other.after));
    format!("{verdict} {file}: {before} -> {after} with the same numbers (ln Bayes {:+.1})", other.gain)
}

/// What it is hard to tell from, and the experiment.
pub fn ties(found: &Found) -> Option<String> {
    let others: Vec<&str> = found.tied_with.iter().chain(&found.tied_with_shapes).map(String::as_str).collect();
    if others.is_empty() {
        return None;
    }
    Some(format!(
        "This recording explains it as well by {}. To tell them apart: {}.",
        others.join(", "),
        found.separate_by.trim_end_matches('.')
    ))
}

/// Segments with their names, runs of neighbours together: `3 rest +x, 5-9, ...`.
pub fn segments(numbers: &[usize], exhibits: Option<&Exhibits>) -> String {
    let name = |number: usize| {
        let segment = exhibits.and_then(|e| e.segments.iter().find(|segment| segment.number == number));
        segment.map_or_else(|| number.to_string(), |segment| format!("{number} {}", segment.name))
    };
    if numbers.len() <= 3 {
        return numbers.iter().map(|number| name(*number)).collect::<Vec<_>>().join(", ");
    }
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some(run) if run.1 + 1 == number => run.1 = number,
            _ => runs.push((number, number)),
        }
    }
    let run = |&(first, last): &(usize, usize)| {
        if first == last { first.to_string() } else { format!("{first}-{last}") }
    };
    runs.iter().map(run).collect::<Vec<_>>().join(", ")
}

/// First letter large.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Ends with a full stop.
pub fn sentence(text: &str) -> String {
    let text = text.trim();
    if text.ends_with(['.', '!', '?']) { text.into() } else { format!("{text}.") }
}
