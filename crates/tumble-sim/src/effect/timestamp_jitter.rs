//! The stamps scatter, the samples do not.
//!
//! `t_out,k = t_k + n_k`, `n` white and normal; the sample was taken on time. A host that stamps what arrives by USB or
//! Bluetooth has 0.2 to 10 ms. Stamps stay in order: one that would not is set 10 µs after its predecessor. The first
//! is exact, being where the recorder starts to count.
//!
//! Magnitude: the sigma of `n`, ms.

use super::prelude::*;
use crate::rng::{Purpose, Rng};

pub(super) static KIND: Kind = Kind {
    id: "timestamp_jitter",
    name: "stamps scatter",
    meaning: "the sigma of each stamp",
    unit: "ms",
    default: 1.0,
    values: Values::Range(0.0, 50.0),
    draws: (0.3, 2.0),
    source: "0.2 to 10 ms where the host stamps what arrives",
    injects: true,
    make: |draw| {
        let rng = Rng::new((draw.rng.unit() * 2f64.powi(53)) as u64, Purpose::Effect);
        Box::new(Jitter { ms: draw.magnitude, rng })
    },
};

/// What a stamp that would go back is set after the one before, s.
const LEAST_STEP_S: f64 = 1e-5;

#[derive(Debug, Clone)]
struct Jitter {
    ms: f64,
    rng: Rng,
}

impl Model for Jitter {
    fn stream(&mut self, samples: &mut Vec<Sample>, _: &Quantisation) {
        let Some(mut last_s) = samples.first().map(|first| first.t_s) else { return };
        for sample in samples.iter_mut().skip(1) {
            last_s = (sample.t_s + 1e-3 * self.ms * self.rng.normal()).max(last_s + LEAST_STEP_S);
            sample.t_s = last_s;
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("sigma", self.ms, "ms")]
    }
}
