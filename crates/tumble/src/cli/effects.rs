//! Effects on the command line: reading one, and the list of all.

use std::fmt::Write as _;

use tumble_sim::Effect;
use tumble_sim::effect::Kind;

/// `ID` or `ID=MAGNITUDE`.
pub(super) fn parse(word: &str) -> Result<Effect, String> {
    Effect::parse(word).map_err(|error| error.to_string())
}

/// All of them, the catalogue first.
pub(super) fn list() -> String {
    let mut text =
        String::from("Effects for --effect ID[=MAGNITUDE]. Axes, directions, signs and times are drawn from --seed.\n");
    for (title, kinds) in [
        ("The catalogue, which a diagnosis knows by name:", Effect::ALL),
        ("Outside the catalogue, to see what a diagnosis does with the unknown:", Effect::FOREIGN),
    ] {
        let _ = writeln!(text, "\n{title}"); // a String takes everything
        for kind in kinds {
            entry(&mut text, kind);
        }
    }
    text
}

fn entry(text: &mut String, kind: &Kind) {
    let Kind { id, name, meaning, unit, default, values, source, injects, .. } = kind;
    let only = if *injects { "" } else { "; simulated only, not for --inject" };
    let _ = writeln!(text, "  {id}={default}  {unit}\n      {name}{only}");
    let _ = writeln!(text, "      magnitude: {meaning}; {values} {unit}\n      typical: {source}");
}
