//! The report for a person.

use std::fmt::Write as _;

use super::{Report, Row, Trial};
use crate::study::blind::score::Outcome;

/// As text. Writing to a String cannot fail.
pub fn text(report: &Report) -> String {
    let mut to = String::new();
    let trials = || report.rows.iter().flat_map(|row| &row.trials);
    let good = |trial: &&Trial| matches!(trial.outcome, Outcome::Right | Outcome::Tie);
    let with_name = trials().filter(|trial| matches!(trial.outcome, Outcome::Right | Outcome::Tie | Outcome::Extra));
    let _ = writeln!(
        to,
        "{} recordings, effects at {} times the detection limit there: {} of {} recovered, {} named at all",
        report.rows.len(),
        report.at,
        trials().filter(good).count(),
        trials().count(),
        with_name.count()
    );
    report.rows.iter().for_each(|row| one(&mut to, row));
    to
}

fn one(to: &mut String, row: &Row) {
    let named = if row.named.is_empty() { String::new() } else { format!(": {}", row.named.join(", ")) };
    let _ = writeln!(to, "\n{} as it is: {}{named} ({:.1} s)", row.file, row.verdict, row.seconds);
    row.reasons.iter().for_each(|reason| {
        let _ = writeln!(to, "  {reason}");
    });
    if row.trials.is_empty() {
        let _ = writeln!(to, "  nothing was added: it can bear {} effects", row.bears);
    }
    for trial in &row.trials {
        let said = if trial.said.is_empty() { String::new() } else { format!(" ({})", trial.said.join(", ")) };
        let close = trial.numbers.iter().filter(|n| (n.value - n.truth).abs() <= 2.0 * n.sigma).count();
        let numbers = match trial.numbers.len() {
            0 => String::new(),
            count => format!("; {close} of {count} numbers within 2 sigma"),
        };
        let Trial { id, magnitude, unit, outcome, trouble, .. } = trial;
        let _ = writeln!(to, "  {id} {magnitude:.4} {unit}: {}{said}{numbers}{trouble}", outcome.word());
    }
}
