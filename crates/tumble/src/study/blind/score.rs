//! One answer against one secret.

use serde::Serialize;

use super::answer::{Answer, Asked};
use super::case::Group;
use super::mapping::{self, Pairing, True};
use super::size::{self, Size};

/// What was hidden, unsealed.
#[derive(Clone, Debug)]
pub struct Hidden {
    /// The question.
    pub group: Group,
    /// What the person did.
    pub scheme: String,
    /// Of the world.
    pub seed: u64,
    /// Turns end by eye.
    pub by_hand: bool,
    /// Sizes, in the order of the effects.
    pub sizes: Vec<Size>,
    /// Ids with their true numbers.
    pub effects: Vec<(String, Vec<True>)>,
}

impl Hidden {
    /// From a seal; none if it is of another kind.
    pub fn of(secret: &serde_json::Value) -> Option<Self> {
        let group = serde_json::from_value(secret["group"].clone()).ok()?;
        let effects = secret["truth"]["effects"].as_array().into_iter().flatten();
        let effect = |value: &serde_json::Value| {
            Some((value["id"].as_str()?.to_owned(), serde_json::from_value(value["parameters"].clone()).ok()?))
        };
        Some(Self {
            group,
            scheme: secret["scheme"].as_str()?.into(),
            seed: secret["seed"].as_u64()?,
            by_hand: secret["by_hand"].as_bool()?,
            sizes: serde_json::from_value(secret["sizes"].clone()).ok()?,
            effects: effects.map(effect).collect::<Option<_>>()?,
        })
    }
}

/// How an answer did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Everything that is there and nothing else, by name. Of a clean recording: nothing is there.
    Right,
    /// The same, but tied with another.
    Tie,
    /// What is there, and more.
    Extra,
    /// One of two.
    Half,
    /// One of two, where the other shows at no size; or nothing, where the largest size that is made shows nothing.
    Hidden,
    /// Something else.
    Wrong,
    /// Something is there, unnamed.
    Unknown,
    /// An alias of something outside the catalogue, said to be tied with another name or with a shape that has none.
    Alias,
    /// Nothing was seen.
    Missed,
    /// No verdict.
    NotTestable,
    /// No answer.
    Broken,
}

impl Outcome {
    /// As in the JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Tie => "tie",
            Self::Extra => "extra",
            Self::Half => "half",
            Self::Hidden => "hidden",
            Self::Wrong => "wrong",
            Self::Unknown => "unknown",
            Self::Alias => "alias",
            Self::Missed => "missed",
            Self::NotTestable => "not_testable",
            Self::Broken => "broken",
        }
    }
}

/// A case with its score.
#[derive(Clone, Debug)]
pub struct Scored {
    /// Of the recording.
    pub name: String,
    /// What was there.
    pub hidden: Hidden,
    /// How it did.
    pub outcome: Outcome,
    /// What was said.
    pub asked: Asked,
    /// Numbers that both sides have.
    pub pairings: Vec<Pairing>,
}

impl Scored {
    /// Of an answer and a secret.
    pub fn new(name: String, hidden: Hidden, asked: Asked) -> Self {
        let ids: Vec<&str> = hidden.effects.iter().map(|(id, _)| id.as_str()).collect();
        let outcome = asked.answer.as_ref().map_or(Outcome::Broken, |answer| match judge(hidden.group, &ids, answer) {
            Outcome::Half if hidden.sizes.iter().any(|size| size.by == size::HIDDEN) => Outcome::Hidden,
            // The largest that the simulation makes of it is less than its limit here.
            Outcome::Missed if hidden.group == Group::Foreign && hidden.sizes.iter().any(Size::is_below_limit) => {
                Outcome::Hidden
            }
            outcome => outcome,
        });
        let found = |id: &str| asked.answer.as_ref()?.effects.iter().find(|named| named.id == id);
        let pairs = |(id, truth): &(String, Vec<True>)| {
            found(id).map(|named| mapping::pair(id, truth, named)).unwrap_or_default()
        };
        let pairings = hidden.effects.iter().flat_map(pairs).collect();
        Self { name, hidden, outcome, asked, pairings }
    }

    /// What was named, ties with a slash.
    pub fn said(&self) -> String {
        let Some(answer) = &self.asked.answer else { return "no answer".into() };
        let one = |named: &super::answer::Named| {
            std::iter::once(named.id.as_str())
                .chain(named.tied_with.iter().map(String::as_str))
                .collect::<Vec<_>>()
                .join("/")
        };
        let names = answer.effects.iter().map(one).collect::<Vec<_>>().join(" + ");
        match (answer.verdict.as_str(), names.is_empty()) {
            ("effect_found", false) => names,
            (verdict, true) => verdict.into(),
            (verdict, false) => format!("{verdict} + {names}"),
        }
    }
}

/// The score of an answer, given what is there.
pub fn judge(group: Group, ids: &[&str], answer: &Answer) -> Outcome {
    let named = &answer.effects;
    let unknown = answer.verdict == "unknown_effect";
    let nothing = |answer: &Answer| match answer.verdict.as_str() {
        "unknown_effect" => Outcome::Unknown,
        "not_testable" => Outcome::NotTestable,
        _ => Outcome::Missed,
    };
    match group {
        Group::Clean => match nothing(answer) {
            _ if !named.is_empty() => Outcome::Wrong,
            Outcome::Missed => Outcome::Right,
            other => other,
        },
        Group::Foreign | Group::Removed => match named.as_slice() {
            [] => nothing(answer),
            [one] if !one.tied_with.is_empty() || !one.tied_with_shapes.is_empty() => Outcome::Alias,
            _ => Outcome::Wrong,
        },
        Group::Effect | Group::Pair => {
            let hits = ids.iter().filter(|id| named.iter().any(|one| one.says(id))).count();
            let more = unknown || named.iter().any(|one| !ids.iter().any(|id| one.says(id)));
            // Two names for one effect, of which it is tied with the second, are one too many.
            let more = more || named.len() > ids.len();
            let by_name = ids.iter().all(|id| named.iter().any(|one| one.id == *id && one.tied_with.is_empty()));
            match (hits, more) {
                (0, _) if named.is_empty() => nothing(answer),
                (0, _) => Outcome::Wrong,
                (hits, _) if hits < ids.len() => Outcome::Half,
                (_, true) => Outcome::Extra,
                (_, false) if by_name => Outcome::Right,
                _ => Outcome::Tie,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::blind::answer::Named;

    fn answer(verdict: &str, named: &[(&str, &[&str])]) -> Answer {
        let one = |(id, tied): &(&str, &[&str])| Named {
            id: id.to_string(),
            tied_with: tied.iter().map(ToString::to_string).collect(),
            ..Named::default()
        };
        Answer { verdict: verdict.into(), effects: named.iter().map(one).collect(), ..Answer::default() }
    }

    fn effect(verdict: &str, named: &[(&str, &[&str])]) -> Outcome {
        judge(Group::Effect, &["a"], &answer(verdict, named))
    }

    #[test]
    fn one_effect() {
        assert_eq!(effect("effect_found", &[("a", &[])]), Outcome::Right);
        assert_eq!(effect("effect_found", &[("a", &["b"])]), Outcome::Tie);
        assert_eq!(effect("effect_found", &[("b", &["a"])]), Outcome::Tie);
        assert_eq!(effect("effect_found", &[("b", &[])]), Outcome::Wrong);
        assert_eq!(effect("effect_found", &[("b", &["c"])]), Outcome::Wrong);
        assert_eq!(effect("effect_found", &[("a", &[]), ("b", &[])]), Outcome::Extra);
        assert_eq!(effect("effect_found", &[("a", &[]), ("b", &["a"])]), Outcome::Extra);
        assert_eq!(effect("unknown_effect", &[("a", &[])]), Outcome::Extra);
        assert_eq!(effect("unknown_effect", &[]), Outcome::Unknown);
        assert_eq!(effect("nothing_missing", &[]), Outcome::Missed);
        assert_eq!(effect("not_testable", &[]), Outcome::NotTestable);
    }

    #[test]
    fn nothing() {
        let clean = |verdict, named: &[(&str, &[&str])]| judge(Group::Clean, &[], &answer(verdict, named));
        assert_eq!(clean("nothing_missing", &[]), Outcome::Right);
        assert_eq!(clean("effect_found", &[("a", &["b"])]), Outcome::Wrong);
        assert_eq!(clean("unknown_effect", &[]), Outcome::Unknown);
        assert_eq!(clean("not_testable", &[]), Outcome::NotTestable);
    }

    #[test]
    fn something_from_outside() {
        let foreign = |verdict, named: &[(&str, &[&str])]| judge(Group::Foreign, &["x_a"], &answer(verdict, named));
        assert_eq!(foreign("unknown_effect", &[]), Outcome::Unknown);
        assert_eq!(foreign("effect_found", &[("a", &["b"])]), Outcome::Alias);
        assert_eq!(foreign("effect_found", &[("a", &[])]), Outcome::Wrong);
        assert_eq!(foreign("unknown_effect", &[("a", &[])]), Outcome::Wrong);
        assert_eq!(foreign("nothing_missing", &[]), Outcome::Missed);
    }

    #[test]
    fn two_effects() {
        let pair = |named: &[(&str, &[&str])]| judge(Group::Pair, &["a", "b"], &answer("effect_found", named));
        assert_eq!(pair(&[("a", &[]), ("b", &[])]), Outcome::Right);
        assert_eq!(pair(&[("a", &["c"]), ("b", &[])]), Outcome::Tie);
        assert_eq!(pair(&[("a", &[])]), Outcome::Half);
        assert_eq!(pair(&[("a", &[]), ("c", &[])]), Outcome::Half);
        assert_eq!(pair(&[("c", &[])]), Outcome::Wrong);
        assert_eq!(pair(&[("a", &[]), ("b", &[]), ("c", &[])]), Outcome::Extra);
    }
}
