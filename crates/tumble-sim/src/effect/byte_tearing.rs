//! High and low byte of a reading come from two samples.
//!
//! `c_out = 256·⌊c_{k−1}/256⌋ + c_k mod 256` where the high bytes of two neighbours differ, else unchanged: a spike of
//! whole multiples of 256 counts against one of the two samples (15.6 °/s or 0.125 g at the widest ranges). Without the
//! chip's shadow registers, that is without a burst read, a few per cent of the crossings are torn. Half of the time
//! the low byte is the old one. The other channels of the sample are whole.
//!
//! Magnitude: the share of such crossings that is torn, %.

use super::prelude::*;
use crate::rng::{Purpose, Rng};

pub(super) static KIND: Kind = Kind {
    id: "byte_tearing",
    name: "bytes of two samples in one reading",
    meaning: "the share of changes of a high byte that are torn",
    unit: "%",
    default: 10.0,
    values: Values::Range(0.0, 100.0),
    draws: (3.0, 30.0),
    source: "byte-wise reads without the shadow registers of a burst (MPU-9250 register map): the read's share of the interval",
    injects: true,
    make: |draw| {
        let rng = Rng::new((draw.rng.unit() * 2f64.powi(53)) as u64, Purpose::Effect);
        Box::new(Torn { percent: draw.magnitude, torn: 0, crossings: 0, rng })
    },
};

#[derive(Debug, Clone)]
struct Torn {
    percent: f64,
    torn: u32,
    crossings: u32,
    rng: Rng,
}

impl Torn {
    /// By how many counts the reading `now` is wrong after `before`.
    fn error(&mut self, before: f64, now: f64) -> f64 {
        let (before, now) = (before.round() as i32, now.round() as i32);
        let (old_high, new_high) = (before.div_euclid(256), now.div_euclid(256));
        if old_high == new_high {
            return 0.0;
        }
        self.crossings += 1;
        if !self.rng.chance(self.percent / 100.0) {
            return 0.0;
        }
        self.torn += 1;
        let torn = if self.rng.chance(0.5) {
            256 * old_high + now.rem_euclid(256)
        } else {
            256 * new_high + before.rem_euclid(256)
        };
        f64::from(torn - now)
    }
}

impl Model for Torn {
    fn stream(&mut self, samples: &mut Vec<Sample>, ranges: &Quantisation) {
        let gyro = ranges.gyro_counts_per_dps() / DPS;
        let accel = ranges.accel_counts_per_g() / G;
        for k in (1..samples.len()).rev() {
            for i in 0..3 {
                let (before, now) = (samples[k - 1].angular_rate_rad_s[i], samples[k].angular_rate_rad_s[i]);
                let error = self.error(before * gyro, now * gyro);
                samples[k].angular_rate_rad_s[i] += error / gyro;
                let (before, now) = (samples[k - 1].specific_force_mps2[i], samples[k].specific_force_mps2[i]);
                let error = self.error(before * accel, now * accel);
                samples[k].specific_force_mps2[i] += error / accel;
            }
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![
            Parameter::new("readings_torn", f64::from(self.torn), ""),
            Parameter::new("high_byte_changes", f64::from(self.crossings), ""),
        ]
    }
}
