//! A sample is read twice and the next one never.
//!
//! A stale read: new stamp, old values of all channels. A reader that is not locked to the chip's data-ready line
//! repeats the share by which it is faster, 0.5 to 2 % (the oscillator's tolerance), or more where reading collides
//! with the update.
//!
//! Magnitude: the share of all samples that repeat the one before, %.

use super::prelude::*;
use crate::rng::{Purpose, Rng};

pub(super) static KIND: Kind = Kind {
    id: "duplicated_samples",
    name: "old values under new stamps",
    meaning: "the share of all samples that repeat the one before",
    unit: "%",
    default: 2.0,
    values: Values::Range(0.0, 60.0),
    draws: (0.5, 6.0),
    source: "oscillator tolerance 1 % (MPU-9250 sheet) of a reader that polls",
    injects: true,
    make: |draw| {
        let rng = Rng::new((draw.rng.unit() * 2f64.powi(53)) as u64, Purpose::Effect);
        Box::new(Stale { percent: draw.magnitude, repeated: 0, rng })
    },
};

#[derive(Debug, Clone)]
struct Stale {
    percent: f64,
    repeated: u32,
    rng: Rng,
}

impl Model for Stale {
    fn stream(&mut self, samples: &mut Vec<Sample>, _: &Quantisation) {
        for i in 1..samples.len() {
            if self.rng.chance(self.percent / 100.0) {
                samples[i] = Sample { t_s: samples[i].t_s, ..samples[i - 1] };
                self.repeated += 1;
            }
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("samples_repeated", f64::from(self.repeated), "")]
    }
}
