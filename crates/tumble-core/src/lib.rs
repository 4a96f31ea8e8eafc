//! Everything of Tumble that can be wrong in mathematics, for the board and the host alike.
//!
//! No hardware, no clock, no executor and no allocation: time arrives inside samples and events, prompts and saves leave
//! as actions. A sample's way through the rooms:
//!
//! [`sample`] → [`motion`] (still, turn or move) → [`tape`] (decimated sums) and [`procedure`] (what to ask next) →
//! [`estimate`] → [`calibration`] (with its verdict) → [`record`] (bytes for the flash) → live compensation.
//!
//! Frames: `s` the sensor's own axes, `b` the box (or the accelerometer's orthogonalised axes where no box is given),
//! `n` level, z up. `rotation_n_from_b` maps a vector's `b` coordinates to its `n` coordinates. Specific force points up
//! at rest. Units are SI; names carry them.
#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod calibration;
pub mod command;
pub mod estimate;
pub mod face;
pub mod frame;
pub mod led;
pub mod message;
pub mod motion;
mod order;
pub mod procedure;
pub mod record;
pub mod sample;
pub mod session;
pub mod setup;
pub mod tape;
pub mod verify;

/// Standard gravity in m/s², the unit "g" of recordings and of the sensor's sensitivity (CGPM 1901, exact).
pub const STANDARD_GRAVITY_MPS2: f32 = 9.806_65;

/// One degree in radians.
pub const DEGREE_RAD: f32 = core::f32::consts::PI / 180.0;
