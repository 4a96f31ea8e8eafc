//! The report for a person, and all cases for a spreadsheet.

use std::fmt::Write as _;

use super::score::{Outcome, Scored};
use super::tally::{self, Report, Row, Share};

/// As text. Writing to a String cannot fail.
pub fn text(report: &Report) -> String {
    let mut to = String::new();
    let noise = if report.noise > 1.0 {
        format!(", noise in motion {} times that at rest", report.noise)
    } else {
        String::new()
    };
    let _ = writeln!(
        to,
        "seed {}: {} recordings, effects at {} times the detection limit{noise}; a diagnosis took {:.1} s (median), {:.1} s (longest)",
        report.seed, report.cases, report.at, report.times.median_s, report.times.longest_s
    );
    effects(&mut to, report);
    clean(&mut to, report);
    let _ = rows(&mut to, "outside the catalogue", &report.foreign, &STRANGERS);
    let _ = rows(&mut to, "taken out of the catalogue", &report.removed, &STRANGERS);
    let _ = rows(&mut to, "two effects", &report.pairs, &PAIRS);
    confusion(&mut to, report);
    for [name, there, trouble] in &report.broken {
        let _ = writeln!(to, "broken: {name} ({there}): {}", trouble.replace('\n', " | "));
    }
    to
}

const EFFECTS: [(&str, Outcome); 8] = [
    ("right", Outcome::Right),
    ("tie", Outcome::Tie),
    ("extra", Outcome::Extra),
    ("wrong", Outcome::Wrong),
    ("unkn", Outcome::Unknown),
    ("missed", Outcome::Missed),
    ("untest", Outcome::NotTestable),
    ("broken", Outcome::Broken),
];
const STRANGERS: [(&str, Outcome); 6] = [
    ("unkn", Outcome::Unknown),
    ("alias", Outcome::Alias),
    ("wrong", Outcome::Wrong),
    ("missed", Outcome::Missed),
    ("untest", Outcome::NotTestable),
    ("broken", Outcome::Broken),
];
const PAIRS: [(&str, Outcome); 9] = [
    ("right", Outcome::Right),
    ("tie", Outcome::Tie),
    ("extra", Outcome::Extra),
    ("half", Outcome::Half),
    ("hidden", Outcome::Hidden),
    ("wrong", Outcome::Wrong),
    ("unkn", Outcome::Unknown),
    ("missed", Outcome::Missed),
    ("broken", Outcome::Broken),
];

fn share(share: &Share) -> String {
    if share.count == 0 {
        return "-".into();
    }
    let percent = |value: f64| 100.0 * value;
    let Share { hits, count, low, high } = *share;
    let of = percent(hits as f64 / count as f64);
    format!("{hits}/{count} = {of:.1} % ({:.1}-{:.1})", percent(low), percent(high))
}

fn effects(to: &mut String, report: &Report) {
    if report.effects.is_empty() {
        return;
    }
    let _ = write!(to, "\n{:<27}", "effect");
    EFFECTS.iter().for_each(|(word, _)| {
        let _ = write!(to, "{word:>7}");
    });
    let (s, fisher) = ("limit/s", "limit/F");
    let _ = writeln!(to, "{:>11}{:>12}{:>7}{:>7}{s:>9}{fisher:>9}{:>6}", "size", "2 sigma", "bias", "rms", "names");
    for row in &report.effects {
        counts(to, row, &EFFECTS);
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1}"));
        let covered = format!("{}/{}", row.covered.hits, row.covered.count);
        let _ = writeln!(
            to,
            "{:>11.4}{:>12}{:>7}{:>7}{:>9}{:>9}{:>6}{}",
            row.magnitude,
            covered,
            number(row.bias_sigmas),
            number(row.rms_sigmas),
            number(row.limit_sigmas),
            number(row.limit_fisher),
            if row.widest_tie == 0 { ".".to_owned() } else { row.widest_tie.to_string() },
            row.otherwise.as_ref().map_or(String::new(), |by| format!("  ({by})"))
        );
    }
    let _ = writeln!(to, "right name or a correct tie: {}", share(&report.all_effects));
}

fn counts(to: &mut String, row: &Row, columns: &[(&str, Outcome)]) {
    let _ = write!(to, "{:<27}", row.id);
    for (_, outcome) in columns {
        let count = row.outcomes.get(*outcome);
        let _ = write!(to, "{:>7}", if count == 0 { ".".to_owned() } else { count.to_string() });
    }
}

fn rows(to: &mut String, title: &str, rows: &[Row], columns: &[(&str, Outcome)]) -> std::fmt::Result {
    if rows.is_empty() {
        return Ok(());
    }
    write!(to, "\n{title:<27}")?;
    for (word, _) in columns {
        write!(to, "{word:>7}")?;
    }
    writeln!(to)?;
    for row in rows {
        counts(to, row, columns);
        writeln!(to)?;
    }
    Ok(())
}

fn clean(to: &mut String, report: &Report) {
    for (k, clean) in report.clean.iter().enumerate() {
        if k == 0 {
            let _ = writeln!(to, "\n{:<27}{:<32}{:<32}", "clean", "false alarms", "unknown_effect");
        }
        let _ = write!(to, "{:<27}{:<32}{:<32}", clean.made, share(&clean.false_alarms), share(&clean.unknown));
        for outcome in [Outcome::NotTestable, Outcome::Broken] {
            if clean.outcomes.get(outcome) > 0 {
                let _ = write!(to, " {} {}", clean.outcomes.get(outcome), outcome.word());
            }
        }
        let _ = writeln!(to);
    }
}

/// What was there and everything that was said of it, the most frequent first.
fn confusion(to: &mut String, report: &Report) {
    let _ = writeln!(to, "\nwhat was there: what was said");
    for (there, said) in &report.confusion {
        let mut said: Vec<_> = said.iter().collect();
        said.sort_by(|a, b| b.1.cmp(a.1));
        let said: Vec<String> = said.into_iter().map(|(said, count)| format!("{count} × {said}")).collect();
        let _ = writeln!(to, "{there}: {}", said.join(", "));
    }
}

/// One line a recording.
pub fn cases(scored: &[Scored]) -> String {
    let mut to = String::from(
        "name,group,effect,scheme,seed,by_hand,magnitude,limit,sized_by,outcome,said,seconds,pairings,within_2_sigma,worst_sigmas\n",
    );
    for one in scored {
        let sizes = &one.hidden.sizes;
        let join = |f: &dyn Fn(&super::size::Size) -> String| sizes.iter().map(f).collect::<Vec<_>>().join(" + ");
        let sigmas = || one.pairings.iter().map(|pairing| pairing.sigmas().abs());
        let _ = writeln!(
            to,
            "{},{},{},{},{},{},{},{},\"{}\",{},\"{}\",{:.2},{},{},{:.2}",
            one.name,
            one.hidden.group.word(),
            tally::label(one),
            one.hidden.scheme,
            one.hidden.seed,
            one.hidden.by_hand,
            join(&|size| size.magnitude.to_string()),
            join(&|size| size.limit.map_or(String::new(), |limit| limit.to_string())),
            join(&|size| size.by.clone()),
            one.outcome.word(),
            one.said(),
            one.asked.seconds,
            one.pairings.len(),
            sigmas().filter(|sigmas| *sigmas <= 2.0).count(),
            sigmas().fold(0.0, f64::max)
        );
    }
    to
}
