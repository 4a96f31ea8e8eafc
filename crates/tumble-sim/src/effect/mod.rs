//! Physics that a nominal recording leaves out: one file an effect, each a full non-linear forward model.
//!
//! An [`Effect`] is an id and one magnitude; axes, directions, signs and times are drawn from the recording's seed, so
//! that a magnitude means the same thing for every seed. Ids that begin with `x_` lie outside the catalogue that a
//! diagnosis knows: they are there to find out whether it says so. Several effects go together, and each draws from a
//! stream of its own.
//!
//! ```
//! use tumble_sim::{Scheme, SchemeConfig, effect::Effect};
//!
//! let mut config = SchemeConfig::new(Scheme::Single, 7);
//! config.timing.still_s = 1.0;
//! config.effects = vec![Effect::parse("gyro_bias_step=0.1").expect("0.1 °/s is within its range")];
//! let recording = config.record().expect("a valid configuration");
//! assert_eq!(recording.truth.effects[0].parameters[0].name, "step_time");
//! ```

mod accel_bias_random_walk;
mod accel_bias_step;
mod accel_bias_temperature;
mod accel_cubic;
mod accel_internal_lever_arms;
mod accel_lever_arm;
mod accel_quadratic;
mod accel_saturation;
mod accel_scale_temperature;
mod accel_warm_up;
mod axis_mapping;
mod bias;
mod byte_tearing;
mod dropped_samples;
mod duplicated_samples;
mod earth_rotation;
mod error;
mod foreign;
mod frozen_reading;
mod gyro_accel_lag;
mod gyro_bias_random_walk;
mod gyro_bias_step;
mod gyro_bias_temperature;
mod gyro_coarse_quantization;
mod gyro_dead_zone;
mod gyro_g_sensitivity;
mod gyro_g_squared;
mod gyro_saturation;
mod gyro_scale_asymmetry;
mod gyro_scale_cubic;
mod gyro_scale_quadratic;
mod gyro_scale_temperature;
mod gyro_warm_up;
mod incomplete_turn;
mod inject;
mod kind;
mod model;
mod platform_tilt_change;
mod registry;
mod shock;
mod spin_axis_wobble;
mod table_rocking;
mod thermal;
mod timestamp_jitter;
mod timestamp_quantization;
mod undersampling;
mod vibration_line;
mod wrong_full_scale;

pub use error::EffectError;
pub use inject::inject;
pub use kind::{Kind, Parameter, Scene, Values, WIDEST};
pub(crate) use model::Chain;
pub use model::{EffectTruth, Instant, Signal};
pub(crate) use thermal::Swing;

use crate::rng::{Purpose, Rng};
use crate::sensor::Sample;
use kind::Draw;

/// What every effect's file needs.
mod prelude {
    pub(super) use super::bias::Triad;
    pub(super) use super::kind::{Kind, Parameter, Values};
    pub(super) use super::model::{Instant, Model, Signal};
    pub(super) use super::{DPS, MG, PPM};
    pub(super) use crate::STANDARD_GRAVITY_MPS2 as G;
    pub(super) use crate::scheme::SchemeConfig;
    pub(super) use crate::sensor::{Quantisation, Sample};
    pub(super) use crate::world::{Ideal, World};
    pub(super) use nalgebra::Vector3;
}

/// rad/s in a degree per second.
const DPS: f64 = core::f64::consts::PI / 180.0;
/// m/s² in a thousandth of g.
const MG: f64 = 1e-3 * crate::STANDARD_GRAVITY_MPS2;
/// A millionth.
const PPM: f64 = 1e-6;

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
        let unknown = || EffectError::Unknown { id: id.into(), near: error::near(id) };
        let kind = Self::kinds().find(|kind| kind.id == id).ok_or_else(unknown)?;
        let magnitude = magnitude.unwrap_or(kind.default);
        if kind.values.contains(magnitude) {
            Ok(Self { kind, magnitude })
        } else {
            Err(EffectError::OutOfRange { id: kind.id, magnitude })
        }
    }

    /// Of `ID` or `ID=MAGNITUDE`.
    ///
    /// # Errors
    /// As [`Effect::new`], or if the magnitude is no number.
    pub fn parse(word: &str) -> Result<Self, EffectError> {
        let Some((id, text)) = word.split_once('=') else { return Self::new(word.trim(), None) };
        let effect = Self::new(id.trim(), None)?;
        let not_a_number = |_| EffectError::NotANumber { id: effect.kind.id, text: text.trim().into() };
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

    /// Adds it to samples of a real sensor; see [`inject`].
    ///
    /// # Errors
    /// As [`inject`].
    pub fn inject(&self, samples: &mut Vec<Sample>, seed: u64) -> Result<EffectTruth, EffectError> {
        let truths = inject(core::slice::from_ref(self), samples, None, seed)?;
        truths.into_iter().next().ok_or(EffectError::NotInjectable { id: self.kind.id })
    }

    /// Everything that effects need, drawn from a seed.
    pub(crate) fn chain(effects: &[Self], scene: Scene, seed: u64) -> Chain {
        let made = |effect: &Self| {
            let mut rng = Rng::new(seed ^ fnv(effect.kind.id), Purpose::Effect);
            let mut draw = Draw { magnitude: effect.magnitude, rng: &mut rng, scene };
            (*effect, (effect.kind.make)(&mut draw))
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
