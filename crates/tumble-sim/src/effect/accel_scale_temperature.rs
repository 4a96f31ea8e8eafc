//! The accelerometer's scale follows the die's temperature.
//!
//! `D(T) = (I + diag(σ)·(T − T₀))·D`, `σ` in ppm/°C. The sheet has ±0.026 %/°C, 260 ppm/°C.
//!
//! Magnitude: the largest of the three axes' slopes; the others have 30 to 100 % of it, every one with its own sign.
//! The effect brings a temperature that moves by 3 to 8 °C, evenly or as a warm-up, unless the recording has one.

use super::prelude::*;
use super::thermal::{Follows, Slope};

pub(super) static KIND: Kind = Kind {
    id: "accel_scale_temperature",
    name: "accelerometer scale follows temperature",
    meaning: "the largest of the three axes' slopes",
    unit: "ppm/degC",
    default: 1000.0,
    values: Values::Range(0.0, 20000.0),
    draws: (900.0, 3000.0),
    source: "±0.026 %/degC (MPU-9250 sheet): 260 ppm/degC",
    injects: true,
    make: |draw| Slope::draw(Triad::Accel, Follows::Scale, draw),
};
