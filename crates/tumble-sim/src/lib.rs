//! The person's hands, the table and the sensor.
//!
//! Full non-linear forward physics of one MPU-9250-class sensor inside a box that a person moves over a table: where
//! the box is ([`motion`]), what the sensor makes of it ([`sensor`]), who decides what happens next ([`person`], which
//! hears only the serial console and sees only the LED), fixed schemes for recordings ([`scheme`]), and physics that a nominal
//! recording leaves out ([`effect`]).
//! Nothing here reads or writes a file, and nothing here is shared with the estimator: a test that compares the
//! two therefore means something.
//!
//! # Frames
//!
//! | name | axes |
//! |---|---|
//! | `n` | level, east-north-up, fixed to the Earth; `z` up |
//! | `p` | the table's plate: `z` is the plate's normal, tilted from up |
//! | `b` | the box: axes are its nominal faces, origin at its centre, where the spin axis of a turn passes |
//! | `a` | the accelerometer: `x` along its x axis, `y` in its x–y plane |
//!
//! Attitude is `rotation_n_from_b`. Angular rate is that of `b` relative to inertial space, in `b`. Specific force points up
//! at rest: `f_b = R_b_from_n · (a + 2 ω_ie × v + g·up)`. All units are SI unless a name's suffix says otherwise.
//!
//! # Example
//!
//! ```
//! use tumble_sim::{Face, Primitive, World, WorldConfig};
//!
//! let mut world = World::new(&WorldConfig::mpu9250(1)).expect("the preset is valid");
//! let placed = world.motion.push(0.0, Primitive::Reorient { up: Face::PlusX, heading_rad: 0.0, duration_s: 3.0 });
//! let sample = world.sample(placed + 1.0);
//! assert!((sample.specific_force_mps2.x - 9.8).abs() < 2.0, "+x points up, but for the sheet's errors");
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod effect;
pub mod error;
pub mod face;
pub mod kinematics;
pub mod motion;
pub mod person;
pub mod rng;
pub mod scheme;
pub mod sensor;
pub mod world;

pub use effect::Effect;
pub use error::SimError;
pub use face::Face;
pub use motion::{Direction, Motion, Primitive};
pub use nalgebra;
pub use person::{Person, PersonConfig};
pub use scheme::{Recording, Scheme, SchemeConfig};
pub use sensor::{Sample, SensorConfig, SensorTruth, Truth};
pub use world::{World, WorldConfig};

/// Standard gravity, m/s²: the contract's `1 g`.
pub const STANDARD_GRAVITY_MPS2: f64 = 9.80665;
/// The Earth's rate, rad/s (WGS 84).
pub const EARTH_RATE_RAD_S: f64 = 7.292_115e-5;
