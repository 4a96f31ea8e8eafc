//! The gyro's bias walks.
//!
//! `db = q·dW` on each axis, from 0 at the first sample, so that its sigma after `t` is `q·√t`. IEEE Std 952 calls it
//! rate random walk; of consumer parts 1e-4 to 1e-3 (°/s)/√s is measured.
//!
//! Magnitude: `q` of every axis, (°/s)/√s.

use super::bias::Walk;
use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_bias_random_walk",
    name: "gyro bias walks at random",
    meaning: "the density of every axis' walk",
    unit: "dps/√s",
    default: 0.005,
    values: Values::Range(0.0, 1.0),
    draws: (0.003, 0.015),
    source: "rate random walk (IEEE Std 952): 1e-4 to 1e-3 dps/√s of consumer parts",
    injects: true,
    make: |draw| Walk::draw(Triad::Gyro, draw),
};
