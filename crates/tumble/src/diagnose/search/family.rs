//! What a family of generic shapes is, and how shapes become one.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::diagnose::catalogue::{DPS, G, reading};
use crate::diagnose::twin::influence::{Influence, Push};
use crate::diagnose::twin::trajectory::Moment;

/// Shapes of one kind on one triad.
pub struct Family {
    /// What it follows, in words.
    pub name: String,
    /// Gyroscope or accelerometer.
    pub gyro: bool,
    /// Its columns: (channel, what).
    pub members: Vec<(usize, String)>,
    /// One a member.
    pub influences: Vec<Influence>,
}

/// A value a moment.
pub(super) type Shape = Box<dyn Fn(&Moment) -> f64 + Send + Sync>;
/// With what they follow.
pub(super) type Shapes = Vec<(String, Shape)>;

/// Each shape on each channel of a triad.
pub(super) fn family(name: &str, gyro: bool, shapes: impl Fn() -> Shapes) -> Family {
    let first = if gyro { 0 } else { 3 };
    let unit = if gyro { DPS } else { 1e-3 * G };
    let (mut members, mut influences) = (Vec::new(), Vec::new());
    for channel in first..first + 3 {
        for (what, shape) in shapes() {
            members.push((channel, what));
            influences.push(reading(move |moment| Push::channel(channel, unit * shape(moment))));
        }
    }
    Family { name: name.into(), gyro, members, influences }
}

/// The same of shapes that are known a value a sample.
pub(super) fn remembered(name: &str, gyro: bool, shapes: &[(String, Arc<Vec<f64>>)]) -> Family {
    let shape = |(what, values): &(String, Arc<Vec<f64>>)| {
        let values = values.clone();
        (what.clone(), Box::new(move |moment: &Moment| values.get(moment.index).copied().unwrap_or(0.0)) as Shape)
    };
    family(name, gyro, || shapes.iter().map(shape).collect())
}

/// Upward in the sensor's axes.
pub(super) fn up(moment: &Moment) -> Vector3<f64> {
    moment.attitude.inverse_transform_vector(&Vector3::z())
}
