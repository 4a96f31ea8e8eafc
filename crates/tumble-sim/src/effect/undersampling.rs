//! Samples are left out on purpose, without a filter before.
//!
//! Every `n`-th sample is kept, `n = round(rate/N)`: noise and motion above half of the new rate fold back. The
//! recording says the lower rate and its stamps are true. A logger that keeps up with 25 Hz of a chip that filters at
//! 41.
//!
//! Magnitude: the wanted rate `N`, Hz; what comes out is the nearest whole division. A *lower* one is the larger
//! effect.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "undersampling",
    name: "sampled too slowly for its bandwidth",
    meaning: "the rate that is kept",
    unit: "Hz",
    default: 25.0,
    values: Values::Range(1.0, 1000.0),
    draws: (25.0, 40.0),
    source: "41 Hz of bandwidth (MPU-9250, CONFIG = 3) asks for more than 82 Hz",
    injects: true,
    make: |draw| {
        let every = (draw.scene.rate_hz / draw.magnitude).round().max(1.0);
        Box::new(Sparse { every, rate_hz: draw.scene.rate_hz / every })
    },
};

#[derive(Debug, Clone)]
struct Sparse {
    every: f64,
    rate_hz: f64,
}

impl Model for Sparse {
    fn stream(&mut self, samples: &mut Vec<Sample>, _: &Quantisation) {
        let (every, mut index) = (self.every as usize, 0);
        samples.retain(|_| {
            index += 1;
            (index - 1) % every == 0
        });
    }

    fn rate_hz(&self) -> Option<f64> {
        Some(self.rate_hz)
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("rate", self.rate_hz, "Hz"), Parameter::new("kept_one_of", self.every, "")]
    }
}
