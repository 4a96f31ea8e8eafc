//! One channel repeats its value while the others go on.
//!
//! A data register that is not updated: a bus transfer cut short that leaves an old word in the reader's buffer, a sensor whose
//! shadow register sticks. It freezes while the channel moves, for there it does harm.
//!
//! Magnitude: for how long, s.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "frozen_reading",
    name: "one channel stands still",
    meaning: "for how long a channel of the gyro, at random, repeats its reading in the midst of a motion",
    unit: "s",
    default: 0.5,
    values: Values::Range(0.01, 10.0),
    draws: (0.2, 1.0),
    source: "an old word in a reader's buffer after a transfer cut short: until the next good one",
    injects: true,
    make: |draw| {
        Box::new(Frozen { seconds: draw.magnitude, axis: draw.axis(), place: draw.rng.unit(), at_s: f64::NAN })
    },
};

/// A motion, rad/s: 20 °/s.
const MOVING: f64 = 0.35;

#[derive(Debug, Clone)]
struct Frozen {
    seconds: f64,
    axis: usize,
    place: f64,
    at_s: f64,
}

impl Model for Frozen {
    fn stream(&mut self, samples: &mut Vec<Sample>, _: &Quantisation) {
        let rate = |sample: &Sample| sample.angular_rate_rad_s[self.axis];
        let moving: Vec<usize> = (0..samples.len()).filter(|i| rate(&samples[*i]).abs() > MOVING).collect();
        let Some(first) = moving.get((self.place * moving.len() as f64) as usize).copied() else { return };
        let (value, from_s) = (rate(&samples[first]), samples[first].t_s);
        for sample in samples[first..].iter_mut().take_while(|sample| sample.t_s - from_s < self.seconds) {
            sample.angular_rate_rad_s[self.axis] = value;
        }
        self.at_s = from_s;
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            Parameter::new("channel", self.axis as f64, ""),
            Parameter::new("time", self.at_s, "s"),
            Parameter::new("duration", self.seconds, "s"),
        ]
    }
}
