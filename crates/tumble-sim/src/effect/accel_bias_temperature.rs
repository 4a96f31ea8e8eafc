//! The accelerometer's bias follows the die's temperature.
//!
//! `b(T) = b + β·(T − T₀)`, `β` in mg/°C. The sheet has ±1.5 mg/°C.
//!
//! Magnitude: the largest of the three axes' slopes; the others have 30 to 100 % of it, every one with its own sign.
//! The effect brings a temperature that moves by 3 to 8 °C, evenly or as a warm-up, unless the recording has one.

use super::prelude::*;
use super::thermal::{Follows, Slope};

pub(super) static KIND: Kind = Kind {
    id: "accel_bias_temperature",
    name: "accelerometer bias follows temperature",
    meaning: "the largest of the three axes' slopes",
    unit: "mg/degC",
    default: 0.5,
    values: Values::Range(0.0, 50.0),
    draws: (0.15, 0.8),
    source: "±1.5 mg/degC (MPU-9250 sheet)",
    injects: true,
    make: |draw| Slope::draw(Triad::Accel, Follows::Bias, draw),
};
