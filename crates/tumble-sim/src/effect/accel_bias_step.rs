//! The accelerometer's bias jumps once.
//!
//! `b(t) = b + s·[t ≥ t₀]`, `t₀` within 20 to 80 % of the recording. A knock that shifts the proof mass, or stress of
//! the board: 0.5 to 20 mg.
//!
//! Magnitude: the length of `s`, mg; its direction and `t₀` are drawn.

use super::bias::Step;
use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_bias_step",
    name: "accelerometer bias jumps once",
    meaning: "the length of the jump",
    unit: "mg",
    default: 3.0,
    values: Values::Range(0.0, 500.0),
    draws: (1.0, 6.0),
    source: "shock and board stress: 0.5 to 20 mg",
    injects: true,
    make: |draw| Step::draw(Triad::Accel, draw),
};
