//! An effect of a size: what a recording is asked for.

use super::chain::Chain;
use super::error::EffectError;
use super::kind::{Draw, Kind, Scene, Values};
use super::likeness::near;
use super::{foreign, registry};
use crate::rng::{Purpose, Rng};

/// An effect and its size.
#[derive(Debug, Clone, Copy)]
pub struct Effect {
    kind: &'static Kind,
    magnitude: f64,
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.kind.id == other.kind.id && self.magnitude == other.magnitude
    }
}

impl Effect {
    /// The contract's catalogue, in its order.
    pub const ALL: &'static [&'static Kind] = registry::CATALOGUE;
    /// Effects that no diagnosis has heard of; their ids begin with `x_`.
    pub const FOREIGN: &'static [&'static Kind] = foreign::FOREIGN;

    /// The catalogue and what lies outside it.
    pub fn kinds() -> impl Iterator<Item = &'static Kind> {
        Self::ALL.iter().chain(Self::FOREIGN).copied()
    }

    /// An effect of this id with its default magnitude, or with this one.
    ///
    /// # Errors
    /// If there is none, or the magnitude is outside its range.
    pub fn new(id: &str, magnitude: Option<f64>) -> Result<Self, EffectError> {
        let unknown = || EffectError::Unknown { id: id.into(), near: near(id, Self::kinds().map(|kind| kind.id)) };
        let kind = Self::kinds().find(|kind| kind.id == id).ok_or_else(unknown)?;
        let magnitude = magnitude.unwrap_or(kind.default);
        if kind.values.contains(magnitude) {
            Ok(Self { kind, magnitude })
        } else {
            Err(EffectError::OutOfRange { id: kind.id, magnitude, must: kind.allowed() })
        }
    }

    /// Of `ID` or `ID=MAGNITUDE`.
    ///
    /// # Errors
    /// As [`Effect::new`], or if the magnitude is no number.
    pub fn parse(word: &str) -> Result<Self, EffectError> {
        let Some((id, text)) = word.split_once('=') else { return Self::new(word.trim(), None) };
        let effect = Self::new(id.trim(), None)?;
        let not_a_number =
            |_| EffectError::NotANumber { id: effect.kind.id, text: text.trim().into(), must: effect.kind.allowed() };
        Self::new(id.trim(), Some(text.trim().parse().map_err(not_a_number)?))
    }

    /// This kind with a magnitude drawn from its [`Kind::draws`], evenly in the logarithm.
    pub fn drawn(kind: &'static Kind, rng: &mut Rng) -> Self {
        let (low, high) = kind.draws;
        let magnitude = match kind.values {
            Values::Whole(..) => (low + rng.index((high - low) as usize + 1) as f64).round(),
            Values::Range(..) => two_digits(low * (high / low).powf(rng.unit())).clamp(low, high),
        };
        Self { kind, magnitude }
    }

    /// Its entry in the registry.
    pub fn kind(&self) -> &'static Kind {
        self.kind
    }

    /// The contract's id.
    pub fn id(&self) -> &'static str {
        self.kind.id
    }

    /// Its size, in the unit of its kind.
    pub fn magnitude(&self) -> f64 {
        self.magnitude
    }

    /// Everything that effects need, drawn from a seed.
    pub(crate) fn chain(effects: &[Self], scene: Scene, seed: u64) -> Chain {
        let made = |effect: &Self| {
            let mut rng = Rng::new(seed ^ fnv(effect.kind.id), Purpose::Effect);
            let mut draw = Draw { magnitude: effect.magnitude, rng: &mut rng, scene };
            (effect.kind, effect.magnitude, (effect.kind.make)(&mut draw))
        };
        Chain(effects.iter().map(made).collect())
    }
}

/// To two digits: a magnitude that a person can read out.
fn two_digits(value: f64) -> f64 {
    let unit = 10f64.powf(value.abs().log10().floor() - 1.0);
    (value / unit).round() * unit
}

/// FNV-1a of an id: the stream of an effect does not depend on what else is asked for.
fn fnv(text: &str) -> u64 {
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}
