//! The catalogue: one file an effect. Each says what a unit of its parameters adds to a reading, to first order, given what
//! the twin knows of the motion. None of this is shared with the simulation's forward models.

mod accel_bias_random_walk;
mod accel_bias_step;
mod accel_bias_temperature;
mod accel_cubic;
mod accel_internal_lever_arms;
mod accel_lever_arm;
mod accel_quadratic;
mod accel_scale_temperature;
mod accel_warm_up;
pub mod earth_rotation;
mod gyro_accel_lag;
mod gyro_bias_random_walk;
mod gyro_bias_step;
mod gyro_bias_temperature;
mod gyro_dead_zone;
mod gyro_g_sensitivity;
mod gyro_g_squared;
mod gyro_scale_asymmetry;
mod gyro_scale_cubic;
mod gyro_scale_quadratic;
mod gyro_scale_temperature;
mod gyro_warm_up;
mod incomplete_turn;
mod platform_tilt_change;

use std::sync::Arc;

use nalgebra::{DMatrix, Vector3};

use super::twin::Twin;
use super::twin::influence::{Influence, Push, Reading};
use super::twin::trajectory::Moment;

/// Standard gravity, m/s².
pub const G: f64 = crate::recording::STANDARD_GRAVITY_MPS2;
/// rad/s.
pub const DPS: f64 = std::f64::consts::PI / 180.0;

/// What is known of an effect before any recording.
#[derive(Clone, Copy, Debug)]
pub struct Card {
    /// As in the contract.
    pub id: &'static str,
    /// For a person.
    pub name: &'static str,
    /// As a formula.
    pub equation: &'static str,
    /// What data sheet or literature say of its size.
    pub typical: &'static str,
    /// Where it shows.
    pub shows: &'static str,
    /// What it is easily taken for.
    pub confounded: &'static [&'static str],
    /// The experiment that tells it from those.
    pub separate_by: &'static str,
}

/// One number of an effect. Influences are per display unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Such as `x_per_y`.
    pub name: String,
    /// Of the value reported.
    pub unit: &'static str,
    /// Prior's sigma in that unit: the typical size.
    pub width: f64,
    /// Below zero it has no meaning.
    pub positive: bool,
}

/// An effect with what is not linear in it held fixed.
pub struct Variant {
    /// What is held: name, value, unit.
    pub setting: Option<(&'static str, f64, &'static str)>,
    /// One an influence.
    pub parameters: Vec<Parameter>,
    /// Per unit.
    pub influences: Vec<Influence>,
    /// Of the numbers, which combinations are its own; none: the numbers themselves.
    pub own: Option<DMatrix<f64>>,
    /// What a parameter (by its place) does at a size, per unit of it; none: the same at any size.
    pub at_size: Option<AtSize>,
}

/// See [`Variant::at_size`].
pub type AtSize = Arc<dyn Fn(usize, f64) -> Influence + Send + Sync>;

/// How an effect enters the model.
pub enum Model {
    /// Shifts the rows: one or several variants, of which one holds.
    Shift(Vec<Variant>),
    /// Lets a bias wander: densities in the filter's units, beyond what is taken for granted.
    Walk {
        /// Else the accelerometer's.
        gyro: bool,
        /// SI per display unit, of the square root of the density.
        unit_si: f64,
        /// Display unit.
        unit: &'static str,
    },
    /// Cannot show in this recording, and why.
    Absent(&'static str),
}

/// An effect of the catalogue that is found by regression.
pub struct Effect {
    /// What is known.
    pub card: &'static Card,
    /// Its model for a recording.
    pub model: fn(&Twin) -> Model,
}

/// All that are found by regression, in the contract's order.
pub const STRUCTURAL: [Effect; 24] = [
    gyro_g_sensitivity::EFFECT,
    gyro_g_squared::EFFECT,
    gyro_scale_quadratic::EFFECT,
    gyro_scale_cubic::EFFECT,
    gyro_scale_asymmetry::EFFECT,
    gyro_dead_zone::EFFECT,
    gyro_bias_temperature::EFFECT,
    gyro_scale_temperature::EFFECT,
    gyro_warm_up::EFFECT,
    gyro_bias_step::EFFECT,
    gyro_bias_random_walk::EFFECT,
    accel_bias_temperature::EFFECT,
    accel_scale_temperature::EFFECT,
    accel_bias_step::EFFECT,
    accel_bias_random_walk::EFFECT,
    accel_quadratic::EFFECT,
    accel_cubic::EFFECT,
    accel_lever_arm::EFFECT,
    accel_internal_lever_arms::EFFECT,
    gyro_accel_lag::EFFECT,
    incomplete_turn::EFFECT,
    platform_tilt_change::EFFECT,
    earth_rotation::EFFECT,
    accel_warm_up::EFFECT,
];

/// Of effects whose setting may be any number: what it does at one, for numbers finer than the variants' grid.
pub fn at_any_setting(id: &str) -> Option<fn(f64) -> Variant> {
    match id {
        "gyro_bias_step" => Some(gyro_bias_step::from),
        "accel_bias_step" => Some(accel_bias_step::from),
        "gyro_warm_up" => Some(gyro_warm_up::of),
        "accel_warm_up" => Some(accel_warm_up::of),
        _ => None,
    }
}

/// Axes' names.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// A parameter.
pub fn parameter(name: impl Into<String>, unit: &'static str, width: f64) -> Parameter {
    Parameter { name: name.into(), unit, width, positive: false }
}

/// A reading's influence from a closure.
pub fn reading(f: impl Fn(&Moment) -> Push + Send + Sync + 'static) -> Influence {
    Influence::Reading(Box::new(f) as Reading)
}

/// One parameter an axis of the gyroscope: `value(axis, moment)` in rad/s per unit.
pub fn gyro_axes(
    unit: &'static str,
    width: f64,
    value: impl Fn(usize, &Moment) -> f64 + Send + Sync + Copy + 'static,
) -> Variant {
    axes(unit, width, move |axis, moment| Push::rate(Vector3::ith(axis, value(axis, moment))))
}

/// One parameter an axis of the accelerometer: `value(axis, moment)` in m/s² per unit.
pub fn accel_axes(
    unit: &'static str,
    width: f64,
    value: impl Fn(usize, &Moment) -> f64 + Send + Sync + Copy + 'static,
) -> Variant {
    axes(unit, width, move |axis, moment| Push::force(Vector3::ith(axis, value(axis, moment))))
}

impl Variant {
    /// The same with parameters that cannot be below zero.
    #[must_use]
    pub fn positive(mut self) -> Self {
        self.parameters.iter_mut().for_each(|parameter| parameter.positive = true);
        self
    }

    /// The same, evaluated at every sample.
    #[must_use]
    pub fn at_every_sample(mut self) -> Self {
        self.influences = self.influences.into_iter().map(Influence::at_every_sample).collect();
        self
    }
}

fn axes(
    unit: &'static str,
    width: f64,
    push: impl Fn(usize, &Moment) -> Push + Send + Sync + Copy + 'static,
) -> Variant {
    Variant {
        setting: None,
        parameters: AXES.iter().map(|axis| parameter(*axis, unit, width)).collect(),
        influences: (0..3).map(|axis| reading(move |moment| push(axis, moment))).collect(),
        own: None,
        at_size: None,
    }
}

/// Range of temperatures less than which says nothing, K: ten times the reading's noise.
const LEAST_WARMING_K: f64 = 0.3;

/// A model that needs the temperature to change.
pub fn with_temperature(twin: &Twin, variant: impl FnOnce() -> Variant) -> Model {
    let known = || twin.samples.iter().map(|raw| raw.temperature_degc).filter(|t| t.is_finite());
    let (least, most) = known().fold((f64::MAX, f64::MIN), |(least, most), t| (least.min(t), most.max(t)));
    if known().next().is_none() {
        return Model::Absent("the recording has no temperatures: add a temp_c column");
    }
    if most - least < LEAST_WARMING_K {
        return Model::Absent("the temperature did not change: let the sensor warm up by some degrees while recording");
    }
    Model::Shift(vec![variant()])
}

/// A model of what jumped once: a variant an instant.
pub fn jump(twin: &Twin, from: fn(f64) -> Variant) -> Model {
    let variant = |from_s: f64| Variant { setting: Some(("at", from_s, "s")), ..from(from_s) };
    Model::Shift(instants(twin).into_iter().map(variant).collect())
}

/// At which something may have jumped: ends and middles of all stretches.
fn instants(twin: &Twin) -> Vec<f64> {
    let mut times: Vec<f64> = Vec::new();
    let end_s = twin.samples.last().map_or(0.0, |raw| raw.t_s);
    for stretch in &twin.stretches {
        let (first, last) = (twin.samples[stretch.samples.start].t_s, twin.samples[stretch.samples.end - 1].t_s);
        let parts = ((last - first) / 4.0).ceil().max(1.0) as usize;
        times.extend((0..parts).map(|part| first + (last - first) * part as f64 / parts as f64));
    }
    times.retain(|t_s| *t_s > 1.0 && *t_s < end_s - 1.0);
    // A hundred instants at most: the evidence between two neighbours changes little.
    let every = times.len().div_ceil(100).max(1);
    times.into_iter().step_by(every).collect()
}
