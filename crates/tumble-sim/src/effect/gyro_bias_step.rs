//! The gyro's bias jumps once.
//!
//! `b(t) = b + s·[t ≥ t₀]`, `t₀` within 20 to 80 % of the recording. Mechanical stress that gives way, a charge that
//! moves, a driver that re-zeroes: 0.01 to 1 °/s are seen.
//!
//! Magnitude: the length of `s`, °/s; its direction and `t₀` are drawn.

use super::bias::Step;
use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_bias_step",
    name: "gyro bias jumps once",
    meaning: "the length of the jump",
    unit: "dps",
    default: 0.05,
    values: Values::Range(0.0, 50.0),
    draws: (0.03, 0.15),
    source: "stress release and re-zeroing drivers: 0.01 to 1 dps",
    injects: true,
    make: |draw| Step::draw(Triad::Gyro, draw),
};
