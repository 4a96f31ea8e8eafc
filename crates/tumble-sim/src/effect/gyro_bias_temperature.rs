//! The gyro's bias follows the die's temperature.
//!
//! `b(T) = b + β·(T − T₀)`, `β` in (°/s)/°C. The sheet allows ±30 °/s over −40 to 85 °C, 0.24 (°/s)/°C; near room
//! temperature a tenth is usual.
//!
//! Magnitude: the largest of the three axes' slopes; the others have 30 to 100 % of it, every one with its own sign.
//! The effect brings a temperature that moves by 3 to 8 °C, evenly or as a warm-up, unless the recording has one.

use super::prelude::*;
use super::thermal::{Follows, Slope};

pub(super) static KIND: Kind = Kind {
    id: "gyro_bias_temperature",
    name: "gyro bias follows temperature",
    meaning: "the largest of the three axes' slopes",
    unit: "dps/degC",
    default: 0.02,
    values: Values::Range(0.0, 2.0),
    draws: (0.006, 0.03),
    source: "±30 dps over -40 to 85 degC (MPU-9250 sheet): at most 0.24 dps/degC",
    injects: true,
    make: |draw| Slope::draw(Triad::Gyro, Follows::Bias, draw),
};
