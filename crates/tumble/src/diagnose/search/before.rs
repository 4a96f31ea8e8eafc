//! Generic shapes of what lay on which side before: memories by pose, not by time.

use nalgebra::Vector3;

use super::generic::Family;
use crate::diagnose::catalogue::{AXES, DPS, G, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::Push;
use crate::diagnose::twin::rows::CHANNELS;

/// Readings that remember how the sensor lay before.
pub(super) fn previous_face(twin: &Twin) -> Family {
    let mut before = Vec::new();
    let (mut last, mut current) = (Vector3::zeros(), Vector3::zeros());
    for stretch in &twin.stretches {
        if stretch.is_rest() {
            let force = twin.trajectory.moments[stretch.samples.start].force / G;
            if (force - current).norm() > 0.3 {
                last = current;
                current = force;
            }
        }
        before.resize(stretch.number + 1, last);
    }
    let before = std::sync::Arc::new(before);
    let (mut members, mut influences) = (Vec::new(), Vec::new());
    for (channel, name) in CHANNELS.iter().enumerate() {
        for (axis, letter) in AXES.iter().enumerate() {
            let before = before.clone();
            let unit = if channel < 3 { DPS } else { 1e-3 * G };
            members.push((channel, format!("previous f_{letter} on {name}")));
            influences.push(reading(move |moment| {
                let value = before.get(moment.stretch).map_or(0.0, |force: &Vector3<f64>| force[axis]);
                Push::channel(channel, unit * value)
            }));
        }
    }
    Family { name: "the face before".into(), gyro: false, members, influences }
}

/// A load of half of gravity shows an axis on which side it lies.
const SIDE: f64 = 0.5;

/// Readings that remember on which side an axis was loaded last, whatever came in between: a relay, the simplest hysteresis.
pub(super) fn last_side(twin: &Twin, gyro: bool) -> Family {
    let mut sides = Vec::new();
    let mut side = Vector3::zeros();
    for stretch in &twin.stretches {
        if stretch.is_rest() {
            let force = twin.trajectory.moments[stretch.samples.start].force / G;
            side = force.zip_map(&side, |force: f64, side| if force.abs() > SIDE { force.signum() } else { side });
        }
        sides.resize(stretch.number + 1, side);
    }
    let sides = std::sync::Arc::new(sides);
    let (mut members, mut influences) = (Vec::new(), Vec::new());
    for channel in if gyro { 0..3 } else { 3..6 } {
        for (axis, letter) in AXES.iter().enumerate() {
            let sides = sides.clone();
            let unit = if gyro { DPS } else { 1e-3 * G };
            members.push((channel, format!("last side of {letter} on {}", CHANNELS[channel])));
            influences.push(reading(move |moment| {
                let value = sides.get(moment.stretch).map_or(0.0, |side: &Vector3<f64>| side[axis]);
                Push::channel(channel, unit * value)
            }));
        }
    }
    Family { name: "the side before".into(), gyro, members, influences }
}
