//! The stamps come in coarse steps.
//!
//! `t_out = q·⌊t/q⌋` with `t` from the first stamp. Clocks of 1 ms are common, those of 10 ms (a scheduler's tick) and
//! 15.6 ms (an old Windows) occur. Two samples never bear the same stamp, which no reader takes: the later one is set
//! 10 µs after the other.
//!
//! Magnitude: the step `q`, ms. One that divides the sample interval exactly changes nothing.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "timestamp_quantization",
    name: "stamps come in coarse steps",
    meaning: "the step of the clock",
    unit: "ms",
    default: 3.0,
    values: Values::Range(0.001, 100.0),
    draws: (2.1, 8.0),
    source: "clocks of 1, 10 and 15.6 ms",
    injects: true,
    make: |draw| Box::new(Ticks { ms: draw.magnitude }),
};

/// What a stamp that would repeat is set after the one before, s.
const LEAST_STEP_S: f64 = 1e-5;

#[derive(Debug, Clone)]
struct Ticks {
    ms: f64,
}

impl Model for Ticks {
    fn stream(&mut self, samples: &mut Vec<Sample>, _: &Quantisation) {
        let Some(first_s) = samples.first().map(|first| first.t_s) else { return };
        let (step_s, mut last_s) = (1e-3 * self.ms, f64::NEG_INFINITY);
        for sample in samples.iter_mut() {
            // A thousandth of a step makes up for rounding: 0.015/0.005 may come out below 3.
            let ticks = ((sample.t_s - first_s) / step_s + 1e-3).floor();
            last_s = (first_s + ticks * step_s).max(last_s + LEAST_STEP_S);
            sample.t_s = last_s;
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("step", self.ms, "ms")]
    }
}
