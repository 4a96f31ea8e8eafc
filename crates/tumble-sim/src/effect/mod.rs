//! Physics that a nominal recording leaves out: one file an effect, each a full non-linear forward model.
//!
//! An [`Effect`] is an id and one magnitude; axes, directions, signs and times are drawn from the recording's seed, so
//! that a magnitude means the same thing for every seed. Ids that begin with `x_` lie outside the catalogue that a
//! diagnosis knows: they are there to find out whether it says so. Several effects go together, and each draws from a
//! stream of its own.
//!
//! ```
//! use tumble_sim::{Scheme, SchemeConfig, effect::Effect};
//!
//! let mut config = SchemeConfig::new(Scheme::Single, 7);
//! config.timing.still_s = 1.0;
//! config.effects = vec![Effect::parse("gyro_bias_step=0.1").expect("0.1 °/s is within its range")];
//! let recording = config.record().expect("a valid configuration");
//! assert_eq!(recording.truth.effects[0].parameters[0].name, "step_time");
//! ```

mod accel_bias_random_walk;
mod accel_bias_step;
mod accel_bias_temperature;
mod accel_cubic;
mod accel_internal_lever_arms;
mod accel_lever_arm;
mod accel_quadratic;
mod accel_saturation;
mod accel_scale_temperature;
mod accel_warm_up;
mod axis_mapping;
mod bias;
mod byte_tearing;
mod chain;
mod dropped_samples;
mod duplicated_samples;
mod earth_rotation;
mod error;
mod foreign;
mod frozen_reading;
mod gyro_accel_lag;
mod gyro_bias_random_walk;
mod gyro_bias_step;
mod gyro_bias_temperature;
mod gyro_coarse_quantization;
mod gyro_dead_zone;
mod gyro_g_sensitivity;
mod gyro_g_squared;
mod gyro_saturation;
mod gyro_scale_asymmetry;
mod gyro_scale_cubic;
mod gyro_scale_quadratic;
mod gyro_scale_temperature;
mod gyro_warm_up;
mod incomplete_turn;
mod inject;
mod kind;
mod likeness;
mod model;
mod platform_tilt_change;
mod prelude;
mod registry;
mod shock;
mod sized;
mod spin_axis_wobble;
mod table_rocking;
mod thermal;
mod timestamp_jitter;
mod timestamp_quantization;
mod undersampling;
mod units;
mod vibration_line;
mod wrong_full_scale;

pub(crate) use chain::Chain;
pub use error::EffectError;
pub use inject::inject;
pub use kind::{Kind, Scene, Values, WIDEST};
pub use sized::Effect;
pub(crate) use thermal::Swing;
