//! Where an effect can take hold: the stages between the motion and the file.

use super::error::EffectError;
use crate::sensor::{Ideal, Instant, Parameter, Quantisation, Sample, Signal};
use crate::world::{World, WorldConfig};
use core::fmt::Debug;

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
    fn prepare(&mut self, _config: &mut WorldConfig) {}
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
