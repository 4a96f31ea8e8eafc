//! The accelerometer's bias walks.
//!
//! `db = q·dW` on each axis, from 0 at the first sample, so that its sigma after `t` is `q·√t`. Of consumer parts 0.005
//! to 0.05 mg/√s is measured.
//!
//! Magnitude: `q` of every axis, mg/√s.

use super::bias::Walk;
use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_bias_random_walk",
    name: "accelerometer bias walks at random",
    meaning: "the density of every axis' walk",
    unit: "mg/√s",
    default: 0.2,
    values: Values::Range(0.0, 20.0),
    draws: (0.1, 0.5),
    source: "0.005 to 0.05 mg/√s of consumer parts",
    injects: true,
    make: |draw| Walk::draw(Triad::Accel, draw),
};
