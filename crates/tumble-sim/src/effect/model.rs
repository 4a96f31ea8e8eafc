//! Where an effect can take hold: the stages between the motion and the file.

use super::EffectError;
use super::kind::Parameter;
use crate::scheme::SchemeConfig;
use crate::sensor::{Quantisation, Sample};
use crate::world::{Ideal, World};
use core::fmt::Debug;
use nalgebra::{UnitQuaternion, Vector3};
use serde::Serialize;

/// What is so at the instant of a sample.
#[derive(Debug, Clone, Copy)]
pub struct Instant {
    /// s.
    pub t_s: f64,
    /// What a perfect sensor would say.
    pub ideal: Ideal,
    /// In the box frame, rad/s².
    pub angular_acceleration_rad_s2: Vector3<f64>,
    /// Of the die, °C.
    pub temperature_degc: f64,
    /// Attitude.
    pub rotation_n_from_b: UnitQuaternion<f64>,
}

/// What the sensor makes of it so far, with its linear errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signal {
    /// rad/s.
    pub angular_rate_rad_s: Vector3<f64>,
    /// m/s².
    pub specific_force_mps2: Vector3<f64>,
}

/// A full non-linear forward model of one effect. Every stage does nothing unless the effect lives there.
///
/// In order: `prepare` (before anything is made), `before` and `after` the moves are queued, then for every sample
/// `ideal` (what is there to be measured), `analog` (added to the linear model, before noise), `converter` (after
/// noise, before rounding), and at the end `stream` (all samples with their stamps). A real recording takes `adopt`
/// instead of the first three and `shift` for what is a matter of time.
pub(crate) trait Model: Boxed + Debug + Send + Sync {
    /// All numbers that were drawn or came out.
    fn parameters(&self) -> Vec<Parameter>;
    /// Settings of table, box, hands and sensor.
    fn prepare(&mut self, _config: &mut SchemeConfig) {}
    /// The world before the first move.
    fn before(&mut self, _world: &mut World) {}
    /// The world when all moves are known.
    fn after(&mut self, _world: &mut World) {}
    /// What is there to be measured.
    fn ideal(&self, _at: &Instant, _ideal: &mut Ideal) {}
    /// Before noise.
    fn analog(&mut self, _at: &Instant, _signal: &mut Signal) {}
    /// After noise, before rounding.
    fn converter(&mut self, _at: &Instant, _signal: &mut Signal) {}
    /// The finished samples.
    fn stream(&mut self, _samples: &mut Vec<Sample>, _ranges: &Quantisation) {}
    /// The rate of the recording, if the effect changed it, Hz.
    fn rate_hz(&self) -> Option<f64> {
        None
    }
    /// A real recording is about to be changed.
    fn adopt(&mut self, _samples: &[Sample]) -> Result<(), EffectError> {
        Ok(())
    }
    /// A real recording's channels are moved in time.
    fn shift(&self, _samples: &mut [Sample]) {}
}

/// What can be copied behind its trait.
pub(crate) trait Boxed {
    /// A box of the same.
    fn boxed(&self) -> Box<dyn Model>;
}

impl<T: Model + Clone + 'static> Boxed for T {
    fn boxed(&self) -> Box<dyn Model> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn Model> {
    fn clone(&self) -> Self {
        // Of what is in the box, not of the box.
        (**self).boxed()
    }
}

/// An effect as it was drawn: what goes into the truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectTruth {
    /// The contract's id.
    pub id: &'static str,
    /// As asked for.
    pub magnitude: f64,
    /// Of the magnitude.
    pub unit: &'static str,
    /// What was drawn or came out.
    pub parameters: Vec<Parameter>,
}

/// All effects of one recording, in the order in which they were asked for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chain(pub(super) Vec<(super::Effect, Box<dyn Model>)>);

impl Chain {
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn models(&mut self) -> impl Iterator<Item = &mut Box<dyn Model>> {
        self.0.iter_mut().map(|(_, model)| model)
    }

    pub(crate) fn prepare(&mut self, config: &mut SchemeConfig) {
        self.models().for_each(|model| model.prepare(config));
    }

    pub(crate) fn before(&mut self, world: &mut World) {
        self.models().for_each(|model| model.before(world));
    }

    pub(crate) fn after(&mut self, world: &mut World) {
        self.models().for_each(|model| model.after(world));
    }

    pub(crate) fn ideal(&self, at: &Instant) -> Ideal {
        let mut ideal = at.ideal;
        self.0.iter().for_each(|(_, model)| model.ideal(at, &mut ideal));
        ideal
    }

    pub(crate) fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        self.models().for_each(|model| model.analog(at, signal));
    }

    pub(crate) fn converter(&mut self, at: &Instant, signal: &mut Signal) {
        self.models().for_each(|model| model.converter(at, signal));
    }

    pub(crate) fn stream(&mut self, samples: &mut Vec<Sample>, ranges: &Quantisation) {
        self.models().for_each(|model| model.stream(samples, ranges));
    }

    pub(crate) fn rate_hz(&self) -> Option<f64> {
        self.0.iter().rev().find_map(|(_, model)| model.rate_hz())
    }

    pub(super) fn adopt(&mut self, samples: &[Sample]) -> Result<(), EffectError> {
        self.models().try_for_each(|model| model.adopt(samples))
    }

    pub(super) fn shift(&self, samples: &mut [Sample]) {
        self.0.iter().for_each(|(_, model)| model.shift(samples));
    }

    pub(crate) fn truths(&self) -> Vec<EffectTruth> {
        let truth = |(effect, model): &(super::Effect, Box<dyn Model>)| EffectTruth {
            id: effect.kind().id,
            magnitude: effect.magnitude(),
            unit: effect.kind().unit,
            parameters: model.parameters(),
        };
        self.0.iter().map(truth).collect()
    }
}
