//! Scores, added up.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Options;
use super::binomial;
use super::case::Group;
use super::mapping;
use super::score::{Outcome, Scored};

/// How often each outcome was.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Counts(BTreeMap<Outcome, usize>);

impl Counts {
    fn of<'a>(scored: impl Iterator<Item = &'a Scored>) -> Self {
        let mut counts = Self::default();
        scored.for_each(|one| *counts.0.entry(one.outcome).or_default() += 1);
        counts
    }

    /// Of one outcome.
    pub fn get(&self, outcome: Outcome) -> usize {
        self.0.get(&outcome).copied().unwrap_or(0)
    }

    /// Of several.
    pub fn any(&self, outcomes: &[Outcome]) -> Share {
        Share::new(outcomes.iter().map(|outcome| self.get(*outcome)).sum(), self.0.values().sum())
    }
}

/// So many of so many, with the interval that holds the true share with 95 % certainty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Share {
    /// So many.
    pub hits: usize,
    /// Of so many.
    pub count: usize,
    /// Clopper and Pearson's lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Share {
    fn new(hits: usize, count: usize) -> Self {
        let (low, high) = binomial::interval(hits, count);
        Self { hits, count, low, high }
    }
}

/// One effect, or one pair.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its id; a pair's with a plus.
    pub id: String,
    /// How its recordings did.
    pub outcomes: Counts,
    /// Right, or a correct tie.
    pub named: Share,
    /// Median size, in the simulation's unit.
    pub magnitude: f64,
    /// Cases whose size is a multiple of a limit.
    pub by_limit: usize,
    /// Where the other sizes come from.
    pub otherwise: Option<String>,
    /// Numbers within two sigmas of the truth, where it was named.
    pub covered: Share,
    /// Mean of (value − truth)/sigma, and its root mean square: 0 and 1 if sigmas are right.
    pub bias_sigmas: Option<f64>,
    /// See there.
    pub rms_sigmas: Option<f64>,
    /// Why no numbers were compared.
    pub not_compared: Option<&'static str>,
    /// Median detection limit over the median sigma of its parameters, which knows the noise that the search chose.
    pub limit_sigmas: Option<f64>,
    /// The same over the Fisher bound under the most noise that the null may choose, as the diagnoses state it.
    pub limit_fisher: Option<f64>,
    /// Names in the widest tie that was counted as correct; 0 without any.
    pub widest_tie: usize,
}

/// Times of the diagnoses, s.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Times {
    /// Of all.
    pub median_s: f64,
    /// The longest.
    pub longest_s: f64,
}

/// Recordings without an effect, by how they were made.
#[derive(Clone, Debug, Serialize)]
pub struct Clean {
    /// Scheme, and how turns end.
    pub made: String,
    /// How they did.
    pub outcomes: Counts,
    /// Something was named.
    pub false_alarms: Share,
    /// `unknown_effect`.
    pub unknown: Share,
}

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// `tumble-study-blind`.
    pub format: &'static str,
    /// 1.
    pub version: u32,
    /// Everything is drawn from it.
    pub seed: u64,
    /// Sizes in detection limits.
    pub at: f64,
    /// Noise in motion over that at rest.
    pub noise: f64,
    /// Recordings in all.
    pub cases: usize,
    /// Effects of the catalogue.
    pub effects: Vec<Row>,
    /// All of them together.
    pub all_effects: Share,
    /// By what was there, then by what was said.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
    /// All first, then by how they were made.
    pub clean: Vec<Clean>,
    /// Outside the catalogue.
    pub foreign: Vec<Row>,
    /// Taken out of the catalogue.
    pub removed: Vec<Row>,
    /// Two together.
    pub pairs: Vec<Row>,
    /// Of the diagnoses.
    pub times: Times,
    /// Name of the recording, what was there, and what went wrong.
    pub broken: Vec<[String; 3]>,
}

impl Report {
    /// Of all scores.
    pub fn new(options: &Options, scored: &[Scored]) -> Self {
        let of = |group: Group| scored.iter().filter(move |one| one.hidden.group == group);
        let there = |one: &Scored| label(one);
        let mut confusion: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
        for one in scored {
            *confusion.entry(there(one)).or_default().entry(one.said()).or_default() += 1;
        }
        let broken = scored.iter().filter(|one| one.outcome == Outcome::Broken);
        Self {
            format: "tumble-study-blind",
            version: 1,
            seed: options.seed,
            at: options.at,
            noise: options.noise,
            cases: scored.len(),
            effects: rows(of(Group::Effect)),
            all_effects: Counts::of(of(Group::Effect)).any(&[Outcome::Right, Outcome::Tie]),
            confusion,
            clean: clean(&of(Group::Clean).collect::<Vec<_>>()),
            foreign: rows(of(Group::Foreign)),
            removed: rows(of(Group::Removed)),
            pairs: rows(of(Group::Pair)),
            times: times(scored),
            broken: broken.map(|one| [one.name.clone(), label(one), one.asked.trouble.clone()]).collect(),
        }
    }
}

/// What was there, in words.
pub fn label(one: &Scored) -> String {
    let ids = ids(one);
    match one.hidden.group {
        Group::Clean => "nothing".into(),
        Group::Removed => format!("{ids} (removed)"),
        _ => ids,
    }
}

fn ids(one: &Scored) -> String {
    one.hidden.effects.iter().map(|(id, _)| id.as_str()).collect::<Vec<_>>().join(" + ")
}

fn rows<'a>(scored: impl Iterator<Item = &'a Scored>) -> Vec<Row> {
    let mut by_id: BTreeMap<String, Vec<&Scored>> = BTreeMap::new();
    scored.for_each(|one| by_id.entry(ids(one)).or_default().push(one));
    by_id.into_iter().map(|(id, scored)| row(id, &scored)).collect()
}

fn row(id: String, scored: &[&Scored]) -> Row {
    let outcomes = Counts::of(scored.iter().copied());
    let sizes = || scored.iter().flat_map(|one| &one.hidden.sizes);
    let pairings = || scored.iter().flat_map(|one| &one.pairings);
    let count = pairings().count();
    let mean =
        |f: &dyn Fn(f64) -> f64| (count > 0).then(|| pairings().map(|p| f(p.sigmas())).sum::<f64>() / count as f64);
    Row {
        named: outcomes.any(&[Outcome::Right, Outcome::Tie]),
        magnitude: median(sizes().map(|size| size.magnitude).collect()).unwrap_or(0.0),
        by_limit: sizes().filter(|size| size.limit.is_some()).count(),
        otherwise: sizes().find(|size| size.by != "limit").map(|size| size.by.clone()),
        covered: Share::new(pairings().filter(|p| p.sigmas().abs() <= 2.0).count(), count),
        bias_sigmas: mean(&|sigmas| sigmas),
        rms_sigmas: mean(&|sigmas| sigmas * sigmas).map(f64::sqrt),
        not_compared: id.split(" + ").find_map(mapping::why_not),
        limit_sigmas: limit_sigmas(scored),
        limit_fisher: limit_fisher(&id, scored),
        widest_tie: widest_tie(scored),
        outcomes,
        id,
    }
}

/// The limit that the twin stated over the median sigma of what was found, both in the diagnosis' unit.
fn limit_sigmas(scored: &[&Scored]) -> Option<f64> {
    let ratio = |one: &&Scored| {
        let [size] = one.hidden.sizes.as_slice() else { return None };
        let sigmas = one.pairings.iter().filter(|pairing| pairing.name != "at" && pairing.name != "tau");
        let sigma = median(sigmas.map(|pairing| pairing.sigma).collect())?;
        Some(size.stated? / sigma)
    };
    median(scored.iter().filter_map(ratio).collect())
}

fn limit_fisher(id: &str, scored: &[&Scored]) -> Option<f64> {
    let limits = scored.iter().filter_map(|one| one.asked.answer.as_ref()).flat_map(|answer| &answer.detection_limits);
    median(limits.filter(|limit| limit.id == id).filter_map(|limit| limit.fisher_sigmas).collect())
}

/// The most names that a correct tie had: one of eighteen is no answer.
fn widest_tie(scored: &[&Scored]) -> usize {
    let ties = scored.iter().filter(|one| one.outcome == Outcome::Tie);
    let named = ties.filter_map(|one| one.asked.answer.as_ref()).flat_map(|answer| &answer.effects);
    named.map(|named| 1 + named.tied_with.len()).max().unwrap_or(0)
}

fn clean(scored: &[&Scored]) -> Vec<Clean> {
    if scored.is_empty() {
        return Vec::new();
    }
    let of = |made: String, scored: &[&Scored]| {
        let outcomes = Counts::of(scored.iter().copied());
        let (false_alarms, unknown) = (outcomes.any(&[Outcome::Wrong]), outcomes.any(&[Outcome::Unknown]));
        Clean { made, outcomes, false_alarms, unknown }
    };
    let mut all = vec![of("all".into(), scored)];
    let mut made: BTreeMap<String, Vec<&Scored>> = BTreeMap::new();
    for one in scored {
        let stops = if one.hidden.by_hand { "by hand" } else { "fenced" };
        made.entry(format!("{}, {stops}", one.hidden.scheme)).or_default().push(one);
    }
    all.extend(made.into_iter().map(|(made, scored)| of(made, &scored)));
    all
}

fn times(scored: &[Scored]) -> Times {
    let seconds: Vec<f64> = scored.iter().map(|one| one.asked.seconds).collect();
    let longest_s = seconds.iter().copied().fold(0.0, f64::max);
    Times { median_s: median(seconds).unwrap_or(0.0), longest_s }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
