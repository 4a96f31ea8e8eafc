//! What a recording promises the search, without the search: the gain of one effect against the threshold in force, or of all
//! shapes without a name. A study that makes effects asks it how large one must be to be seen.

use super::Options;
use super::catalogue::STRUCTURAL;
use super::diagnosis::Value;
use super::findings;
use super::intake::bench;
use super::search::bench::Bench;
use super::search::ledger::Ledger;
use super::search::null::{self, FALSE_ALARMS};
use super::search::{select, unknown};
use crate::recording::Recording;

/// ln of the odds that a name needs on this recording.
pub fn threshold(recording: &Recording, options: &Options) -> Option<f64> {
    let mut bench = bench(recording, options).ok()?;
    let (noise, _) = select::settle_walks(&mut bench);
    let rows = bench.rows(noise);
    let scales = Ledger::new(&rows, |_| true).fit(&[]).scales;
    Some(null::threshold(&bench, &rows, &scales, options.seed))
}

/// The search knows nothing but what `known` says: its columns are a few, and so are the seconds.
fn knowing(options: &Options, known: impl Fn(&str) -> bool) -> Options {
    let ids = STRUCTURAL.iter().map(|effect| effect.card.id).filter(|id| !known(id));
    Options { without: ids.map(str::to_owned).collect(), ..options.clone() }
}

/// ln of the odds for this effect against the null, whatever noise excuses it best; none if the search does not know it.
pub fn of_effect(recording: &Recording, options: &Options, id: &str) -> Option<f64> {
    let mut bench = bench(recording, &knowing(options, |known| known == id)).ok()?;
    select::score(&mut bench).first().map(|score| score.gain)
}

/// The same beside others that the search knows too.
pub fn of_effect_beside(recording: &Recording, options: &Options, id: &str, others: &[&str]) -> Option<f64> {
    let mut bench = bench(recording, &knowing(options, |known| known == id || others.contains(&known))).ok()?;
    select::select(&mut bench, options.seed, &mut |_, _| {});
    let is_it = |bench: &Bench, candidate: usize| bench.candidates[candidate].effect.card.id == id;
    if let Some(k) = (0..bench.accepted.len()).find(|k| is_it(&bench, bench.accepted[*k].candidate)) {
        let whole = select::settle_walks(&mut bench).1;
        return Some(whole - select::without(&mut bench, k));
    }
    let scores = select::score(&mut bench);
    scores.iter().find(|score| is_it(&bench, score.candidate)).map(|score| score.gain)
}

/// ln of the mean odds of all shapes without a name, and what it needs.
pub fn of_shapes(recording: &Recording, options: &Options) -> Option<(f64, f64)> {
    let mut bench = bench(recording, &knowing(options, |_| false)).ok()?;
    bench.twin.noise = select::settle_walks(&mut bench).0;
    Some((unknown::left_over(&mut bench).evidence, -FALSE_ALARMS.ln()))
}

/// The numbers of effects that are known to be there, as a diagnosis would state them: the search as ever, but with nothing else
/// to choose from and no name challenged. What it does not find is left out.
pub fn numbers(recording: &Recording, options: &Options, ids: &[&str]) -> Option<Vec<(&'static str, Vec<Value>)>> {
    let mut bench = bench(recording, &knowing(options, |known| ids.contains(&known))).ok()?;
    let selection = select::select(&mut bench, options.seed, &mut |_, _| {});
    Some(findings::numbers(&mut bench, &selection))
}
