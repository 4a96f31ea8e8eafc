//! Sections of the page. Each is there for every verdict, and says why where it has nothing to show.

use super::html::{definitions, figure, paragraph, section, table};
use super::{channels, evidence as bars, heat, isolable, scatter, words};
use crate::diagnose::catalogue::STRUCTURAL;
use crate::diagnose::diagnosis::{Diagnosis, Found, Place};
use crate::diagnose::exhibits::Exhibits;
use crate::diagnose::gates;

/// What a residual is, said once.
const RESIDUALS: &str = "A twin of the sensor follows the recording and predicts every reading from the motion alone. What it \
    misses by is the residual, divided by the noise that is expected there. Its mean square is 1 where noise is all there is; \
    cells of few rows scatter about 1 by chance (point at a cell for their number).";

/// Where.
pub fn place(diagnosis: &Diagnosis, exhibits: Option<&Exhibits>) -> String {
    let mut body = String::new();
    for found in &diagnosis.effects {
        body += &paragraph(&format!("{}: {}.", words::capital(&found.name), place_words(&found.place, exhibits)));
    }
    if let Some(unknown) = &diagnosis.unknown {
        body += &paragraph(&format!("What has no name: {}.", place_words(&unknown.place, exhibits)));
    }
    if diagnosis.effects.is_empty() && diagnosis.unknown.is_none() {
        body += &paragraph("Nowhere does more than noise stand out.");
    }
    body += &match exhibits.and_then(|exhibits| heat::picture(exhibits, after_what(diagnosis))) {
        Some(svg) => figure(&svg, RESIDUALS),
        None => paragraph("No picture: no motion was fitted to this recording."),
    };
    section("where", "Where", &body)
}

/// What stands in the right half: where nothing could be named, what came nearest.
fn after_what(diagnosis: &Diagnosis) -> &'static str {
    match (&diagnosis.unknown, diagnosis.effects.is_empty()) {
        (None, true) => "after (nothing was found)",
        (None, false) => "after what was found",
        (Some(_), _) => "after the nearest known effects",
    }
}

fn place_words(place: &Place, exhibits: Option<&Exhibits>) -> String {
    let channels = if place.channels.is_empty() { "no single channel".into() } else { place.channels.join(", ") };
    let segments = match place.segments.as_slice() {
        [] => String::new(),
        some => format!(", segments {}", words::segments(some, exhibits)),
    };
    format!("{channels}; from {:.1} to {:.1} s{segments}", place.start_s, place.end_s)
}

/// What, and how sure.
pub fn what(diagnosis: &Diagnosis, exhibits: Option<&Exhibits>) -> String {
    let threshold = exhibits.map(|exhibits| exhibits.threshold);
    let mut body: String = diagnosis.effects.iter().map(|found| effect(found, threshold)).collect();
    if diagnosis.effects.is_empty() {
        body += &paragraph("No effect of the catalogue is needed, or none can be named.");
    }
    section("what", "What, and how sure", &body)
}

fn effect(found: &Found, threshold: Option<f64>) -> String {
    let mut facts = vec![
        ("equation", found.equation.clone()),
        ("usual size", found.typical.clone()),
        ("how sure", sure(found, threshold)),
    ];
    if let Some(rival) = &found.runner_up {
        let odds = words::odds(rival.gap.abs()).replace(" for it", "");
        let side = if rival.gap >= 0.0 { "less" } else { "more" };
        facts.push((
            "next best",
            format!("{}, {} {side} in ln Bayes factor: {odds}", rival.id, words::figure(rival.gap.abs())),
        ));
    }
    facts.push((
        "ties",
        words::ties(found).unwrap_or_else(|| "None: nothing else explains as much of this recording.".into()),
    ));
    if let Some(constancy) = words::constancy(found) {
        facts.push(("constancy", constancy));
    }
    if let Some(held) = found.held_out {
        let (before, after) = (words::figure(held.before), words::figure(held.after));
        facts
            .push(("held out", format!("each half by the other half's numbers: {before} without it, {after} with it")));
    }
    facts.extend(found.other_recordings.iter().map(|other| ("elsewhere", words::elsewhere(other))));
    let rows: Vec<Vec<String>> = found.parameters.iter().map(parameter).collect();
    let numbers = table(&["parameter", "value#", "\u{b1} sigma#", "unit", "sigmas from none#"], &rows);
    let title = super::html::escape(&format!("{} ({})", words::capital(&found.name), found.id));
    format!("<h3>{title}</h3>\n{}{numbers}", definitions(&facts))
}

fn sure(found: &Found, threshold: Option<f64>) -> String {
    let needed = threshold.map_or(String::new(), |limit| format!("; {limit:.1} was needed"));
    format!("{}: ln Bayes factor {}{needed}", words::odds(found.evidence), words::figure(found.evidence))
}

fn parameter(value: &crate::diagnose::diagnosis::Value) -> Vec<String> {
    let [size, sigma] = words::size_and_sigma(value);
    vec![value.name.clone(), size, sigma, value.unit.clone(), format!("{:.1}", words::significance(value))]
}

/// Before and after.
pub fn fit(diagnosis: &Diagnosis) -> String {
    let fit = &diagnosis.fit;
    let Some(svg) = channels::picture(fit) else {
        return section("fit", "Before and after", &paragraph("No motion was fitted to this recording."));
    };
    let row = |name: &str, before: f64, after: f64| vec![name.into(), words::figure(before), words::figure(after)];
    let mut rows = vec![
        row("all data", fit.before.train, fit.after.train),
        row("data left out of the fit", fit.before.held_out, fit.after.held_out),
    ];
    rows.extend(fit.per_channel.iter().map(|(name, channel)| row(name, channel.before, channel.after)));
    let nearest =
        if diagnosis.unknown.is_some() { " After: with the nearest of the effects I know, named or not." } else { "" };
    let told = "Mean squared residual in units of its noise. Left out: each half of every position is predicted with numbers \
                from the other halves.";
    let told = format!("{told}{nearest}");
    let body = table(&["mean squared residual", "before#", "after#"], &rows) + &figure(&svg, &told);
    section("fit", "Before and after", &body)
}

/// Residual against regressor.
pub fn regressions(diagnosis: &Diagnosis, exhibits: Option<&Exhibits>) -> String {
    let named = |id: &str| diagnosis.effects.iter().any(|found| found.id == id);
    let regressions = exhibits.map_or(&[][..], |exhibits| &exhibits.regressions);
    let mut body = String::new();
    for regression in regressions.iter().filter(|regression| named(&regression.id)) {
        let Some(svg) = scatter::picture(regression) else { continue };
        let told = format!(
            "{}: each small dot is a comparison; large dots are means over neighbours with their error. Before, they lie on \
             the dashed line if the effect is what it is said to be; after, nothing may be left to follow.",
            regression.id
        );
        body += &figure(&svg, &told);
    }
    if body.is_empty() {
        body = paragraph("No effect with a course that could be drawn.");
    }
    section("regressor", "Does the residual follow the effect?", &body)
}

/// All candidates.
pub fn evidence(diagnosis: &Diagnosis, exhibits: Option<&Exhibits>) -> String {
    let found: Vec<String> = diagnosis.effects.iter().map(|found| found.id.clone()).collect();
    let told = "Each effect alone, before any other was accepted: several may be high because they resemble the true one. \
                ln Bayes factor: each 2.3 is a factor ten in odds. The axis is logarithmic on both sides of 0; blue was named.";
    let body = match exhibits.and_then(|exhibits| bars::picture(exhibits, &found)) {
        Some(svg) => figure(&svg, told),
        None => paragraph("No candidate was weighed."),
    };
    section("evidence", "What else it could have been", &body)
}

/// What can be told apart.
pub fn isolability(exhibits: Option<&Exhibits>) -> String {
    let told = "Of the row's effect at its usual size, the share that the column's effect could imitate in this very \
                recording. Dark means: a recording of other motions is needed to tell the two apart.";
    let body = match exhibits.and_then(isolable::picture) {
        Some(svg) => figure(&svg, told),
        None => paragraph("No effects were compared."),
    };
    section("isolability", "Which effects this recording can tell apart", &body)
}

/// What has no name.
pub fn unknown(diagnosis: &Diagnosis) -> String {
    let body = match &diagnosis.unknown {
        None => paragraph("Nothing without a name is left over."),
        Some(unknown) => {
            let follows: Vec<Vec<String>> = words::shapes(unknown).into_iter().map(|shape| vec![shape]).collect();
            paragraph(&words::resemblance(unknown)) + &table(&["it follows (best first)"], &follows)
        }
    };
    section("unknown", "What has no name", &body)
}

/// What could have been seen.
pub fn limits(diagnosis: &Diagnosis) -> String {
    if diagnosis.detection_limits.is_empty() {
        return section("limits", "What could have been seen", &paragraph("No effect could be tested."));
    }
    let cards = || STRUCTURAL.iter().map(|effect| effect.card).chain(gates::CARDS);
    let typical = |id: &str| cards().find(|card| card.id == id).map_or("", |card| card.typical);
    let (seen, blind): (Vec<_>, Vec<_>) = diagnosis.detection_limits.iter().partition(|limit| limit.testable);
    let size = |limit: f64| if limit < 1e90 { words::figure(limit) } else { "no size".into() };
    let rows: Vec<Vec<String>> = seen
        .iter()
        .map(|limit| {
            let of = [&limit.id, &size(limit.limit), &limit.unit, &limit.why].map(String::clone);
            of.into_iter().chain([typical(&limit.id).into()]).collect()
        })
        .collect();
    let mut body = paragraph("Of this size, an effect would have been found in 95 of 100 recordings like this one:");
    body += &table(&["effect", "limit#", "unit", "where", "usual size"], &rows);
    if !blind.is_empty() {
        let rows: Vec<Vec<String>> =
            blind.iter().map(|limit| vec![limit.id.clone(), limit.why.clone(), typical(&limit.id).into()]).collect();
        body += &paragraph("These would not have shown at a usual size:");
        body += &table(&["effect", "why", "usual size"], &rows);
    }
    section("limits", "What could have been seen", &body)
}
