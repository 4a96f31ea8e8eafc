//! Samples are missing.
//!
//! Gaps begin at random and are 1 to 5 samples long (geometric, 2 on average); their stamps are missing too. A serial
//! line that overruns or a Bluetooth link loses 0.1 to 5 %.
//!
//! Magnitude: the share of all samples that is lost, %.

use super::prelude::*;
use crate::rng::{Purpose, Rng};

pub(super) static KIND: Kind = Kind {
    id: "dropped_samples",
    name: "samples are missing",
    meaning: "the share of all samples that is lost",
    unit: "%",
    default: 2.0,
    values: Values::Range(0.0, 60.0),
    draws: (0.5, 6.0),
    source: "0.1 to 5 % on serial lines that overrun and on radio links",
    injects: true,
    make: |draw| {
        let rng = Rng::new((draw.rng.unit() * 2f64.powi(53)) as u64, Purpose::Effect);
        Box::new(Dropped { percent: draw.magnitude, lost: 0, gaps: 0, rng })
    },
};

/// Mean and greatest length of a gap, samples.
const MEAN_GAP: f64 = 2.0;
const LONGEST_GAP: usize = 5;

#[derive(Debug, Clone)]
struct Dropped {
    percent: f64,
    lost: usize,
    gaps: usize,
    rng: Rng,
}

impl Dropped {
    /// One more with probability one half each time.
    fn gap(&mut self) -> usize {
        let mut length = 1;
        while length < LONGEST_GAP && self.rng.chance(1.0 - 1.0 / MEAN_GAP) {
            length += 1;
        }
        length
    }
}

impl Model for Dropped {
    fn stream(&mut self, samples: &mut Vec<Sample>, _: &Quantisation) {
        let wanted = (samples.len() as f64 * self.percent / 100.0).round() as usize;
        let mut keep = vec![true; samples.len()];
        while self.lost < wanted {
            // The first and the last sample stay, so that the recording keeps its length.
            let start = 1 + self.rng.index(samples.len().saturating_sub(2));
            let gap = self.gap().min(wanted - self.lost);
            let end = (start + gap).min(samples.len().saturating_sub(1));
            let taken = keep[start..end].iter_mut().filter(|kept| **kept).map(|kept| *kept = false).count();
            self.lost += taken;
            self.gaps += usize::from(taken > 0);
        }
        let mut kept = keep.into_iter();
        samples.retain(|_| kept.next().unwrap_or(true));
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("samples_lost", self.lost as f64, ""), Parameter::new("gaps_begun", self.gaps as f64, "")]
    }
}
