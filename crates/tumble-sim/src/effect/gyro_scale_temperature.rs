//! The gyro's scale follows the die's temperature.
//!
//! `D(T) = (I + diag(σ)·(T − T₀))·D`, `σ` in ppm/°C. The sheet allows ±4 % over −40 to 85 °C, 320 ppm/°C.
//!
//! Magnitude: the largest of the three axes' slopes; the others have 30 to 100 % of it, every one with its own sign.
//! The effect brings a temperature that moves by 3 to 8 °C, evenly or as a warm-up, unless the recording has one.

use super::prelude::*;
use super::thermal::{Follows, Slope};

pub(super) static KIND: Kind = Kind {
    id: "gyro_scale_temperature",
    name: "gyro scale follows temperature",
    meaning: "the largest of the three axes' slopes",
    unit: "ppm/degC",
    default: 500.0,
    values: Values::Range(0.0, 20000.0),
    draws: (400.0, 1300.0),
    source: "±4 % over -40 to 85 degC (MPU-9250 sheet): at most 320 ppm/degC",
    injects: true,
    make: |draw| Slope::draw(Triad::Gyro, Follows::Scale, draw),
};
