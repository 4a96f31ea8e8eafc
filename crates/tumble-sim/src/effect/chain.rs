//! Several effects on one recording.

use super::error::EffectError;
use super::kind::Kind;
use super::model::Model;
use crate::sensor::{EffectTruth, Ideal, Instant, Quantisation, Sample, Signal, Stages};
use crate::world::{World, WorldConfig};

/// All effects of one recording, in the order in which they were asked for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chain(pub(super) Vec<(&'static Kind, f64, Box<dyn Model>)>);

impl Chain {
    fn models(&mut self) -> impl Iterator<Item = &mut Box<dyn Model>> {
        self.0.iter_mut().map(|(_, _, model)| model)
    }

    pub(crate) fn prepare(&mut self, config: &mut WorldConfig) {
        self.models().for_each(|model| model.prepare(config));
    }

    pub(crate) fn before(&mut self, world: &mut World) {
        self.models().for_each(|model| model.before(world));
    }

    pub(crate) fn after(&mut self, world: &mut World) {
        self.models().for_each(|model| model.after(world));
    }

    pub(crate) fn stream(&mut self, samples: &mut Vec<Sample>, ranges: &Quantisation) {
        self.models().for_each(|model| model.stream(samples, ranges));
    }

    pub(crate) fn rate_hz(&self) -> Option<f64> {
        self.0.iter().rev().find_map(|(_, _, model)| model.rate_hz())
    }

    pub(super) fn adopt(&mut self, samples: &[Sample]) -> Result<(), EffectError> {
        self.models().try_for_each(|model| model.adopt(samples))
    }

    pub(super) fn shift(&self, samples: &mut [Sample]) {
        self.0.iter().for_each(|(_, _, model)| model.shift(samples));
    }

    pub(crate) fn truths(&self) -> Vec<EffectTruth> {
        let truth = |(kind, magnitude, model): &(&'static Kind, f64, Box<dyn Model>)| EffectTruth {
            id: kind.id,
            magnitude: *magnitude,
            unit: kind.unit,
            parameters: model.parameters(),
        };
        self.0.iter().map(truth).collect()
    }
}

impl Stages for Chain {
    fn ideal(&self, at: &Instant) -> Ideal {
        let mut ideal = at.ideal;
        self.0.iter().for_each(|(_, _, model)| model.ideal(at, &mut ideal));
        ideal
    }

    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        self.models().for_each(|model| model.analog(at, signal));
    }

    fn converter(&mut self, at: &Instant, signal: &mut Signal) {
        self.models().for_each(|model| model.converter(at, signal));
    }
}
