//! Effects outside the catalogue: plausible physics that no diagnosis has a name for.
//!
//! A diagnosis that meets one of these should say that something is there, where, and what it goes with, and not
//! force it into the nearest name that it knows.

mod x_accel_creep;
mod x_accel_cross_product;
mod x_accel_hysteresis;
mod x_accel_rate_squared;
mod x_gyro_after_effect;
mod x_gyro_angular_acceleration;
mod x_gyro_force_rate_product;
mod x_gyro_magnetic;
mod x_gyro_periodic_bias;
mod x_gyro_rate_product;
mod x_gyro_scale_drift;
mod x_gyro_telegraph_noise;

use super::kind::Kind;

/// All of them.
pub(super) const FOREIGN: &[&Kind] = &[
    &x_gyro_after_effect::KIND,
    &x_gyro_periodic_bias::KIND,
    &x_gyro_rate_product::KIND,
    &x_gyro_force_rate_product::KIND,
    &x_gyro_telegraph_noise::KIND,
    &x_accel_rate_squared::KIND,
    &x_accel_hysteresis::KIND,
    &x_gyro_magnetic::KIND,
    &x_gyro_angular_acceleration::KIND,
    &x_accel_creep::KIND,
    &x_gyro_scale_drift::KIND,
    &x_accel_cross_product::KIND,
];
