//! How large an effect must be to be seen, for its very direction and on its very recording: by making it, and asking the search
//! what odds it would give.
//!
//! A limit that a diagnosis states is one number for an effect of up to nine; an effect that is drawn has one direction among
//! them. Here the size is sought at which the gain, less what noise takes from it in 95 of 100 recordings, reaches the
//! threshold: `g − 1.645 √(2g) = T`, as twice the gain of a signal with noise is a non-central χ², whose standard deviation is
//! `2 √(2g)`. Effects without a name are measured against the shapes that detect them.

use tumble_sim::Effect;
use tumble_sim::effect::Kind;

use super::case::Setting;
use super::make;
use crate::diagnose::catalogue::STRUCTURAL;
use crate::diagnose::{Options, promise};
use crate::recording::Recording;

/// Sizes that are tried at most. Gains grow with the square of the size, so that each step is nearly the last.
const TRIALS: usize = 6;
/// A gain this near its goal is good enough: a tenth in size.
const NEAR: std::ops::Range<f64> = 0.85..1.2;

/// Who would have to see it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// The candidate of its own name.
    ByName,
    /// Shapes without a name.
    ByShapes,
}

impl Seen {
    /// None for what gates find: their limits are arithmetic.
    pub fn of(kind: &Kind) -> Option<Self> {
        let foreign = Effect::FOREIGN.iter().any(|one| one.id == kind.id);
        let searched = STRUCTURAL.iter().any(|effect| effect.card.id == kind.id);
        foreign.then_some(Self::ByShapes).or(searched.then_some(Self::ByName))
    }
}

/// A size that was sought.
pub struct Sought {
    /// In the simulation's unit.
    pub size: f64,
    /// False where the largest that can be made would not be seen.
    pub shows: bool,
}

/// The size of this effect that is seen in 95 of 100 recordings like this; `present` of it is in every recording, and `beside` it are
/// effects that gates find and mask or, `known`, that the search finds. None if no size can be had.
pub fn limit(
    setting: &Setting,
    beside: &[Effect],
    known: &[&str],
    kind: &Kind,
    present: f64,
    first: f64,
) -> Option<Sought> {
    let seen = Seen::of(kind)?;
    let options = Options::default();
    let threshold = match seen {
        Seen::ByName => promise::threshold(&make::make(setting, beside).ok()?.recording, &options)?,
        Seen::ByShapes => 0.0,
    };
    let (low, high) = kind.values.bounds();
    let mut size = first;
    let mut best: Option<(f64, f64)> = None;
    let mut shows = true;
    for _ in 0..TRIALS {
        let magnitude = (present + size).clamp(low, high);
        let recording = with(setting, beside, kind, magnitude)?;
        let (gain, needed) = match seen {
            Seen::ByName if known.is_empty() => (promise::of_effect(&recording, &options, kind.id)?, threshold),
            Seen::ByName => (promise::of_effect_beside(&recording, &options, kind.id, known)?, threshold),
            Seen::ByShapes => promise::of_shapes(&recording, &options)?,
        };
        let share = gain / goal(needed);
        let off = if share > 0.0 { share.ln().abs() } else { f64::MAX };
        if best.is_none_or(|(least, _)| off < least) {
            best = Some((off, size / share.max(0.01).sqrt()));
        }
        if NEAR.contains(&share) || magnitude >= high {
            shows = share >= NEAR.start;
            break;
        }
        size /= share.clamp(0.06, 16.0).sqrt();
    }
    if !shows {
        return Some(Sought { size, shows });
    }
    best.filter(|(off, _)| *off < f64::MAX).map(|(_, size)| Sought { size, shows })
}

/// `√g = (1.645 √2 + √(2·1.645² + 4 T))/2`.
fn goal(threshold: f64) -> f64 {
    let lost = 1.645 * std::f64::consts::SQRT_2;
    (0.5 * (lost + (lost * lost + 4.0 * threshold).sqrt())).powi(2)
}

fn with(setting: &Setting, beside: &[Effect], kind: &Kind, magnitude: f64) -> Option<Recording> {
    let mut effects = beside.to_vec();
    effects.push(Effect::new(kind.id, Some(magnitude)).ok()?);
    make::make(setting, &effects).ok().map(|made| made.recording)
}

#[cfg(test)]
mod tests {
    use super::goal;

    #[test]
    fn the_goal_leaves_the_threshold_after_noise() {
        for threshold in [4.6, 6.0, 12.0] {
            let gain = goal(threshold);
            assert!((gain - 1.645 * (2.0 * gain).sqrt() - threshold).abs() < 1e-9);
        }
    }
}
