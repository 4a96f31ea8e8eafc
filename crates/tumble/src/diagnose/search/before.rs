//! Generic shapes of what lay on which side before: memories by pose, not by time.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::Vector3;

use super::generic::{Family, remembered, up};
use crate::diagnose::catalogue::{AXES, DPS, G, reading};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::influence::{Influence, Push};
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
    let (members, influences) = by_stretch(before, 0..6, "previous f_");
    Family { name: "the face before".into(), gyro: false, members, influences }
}

/// From 45° on an axis is loaded more than any other.
const LOADED: f64 = 0.7;

/// Readings that remember on which side an axis was loaded last, whatever came in between: a relay, the simplest hysteresis. Until it is
/// loaded for the first time its side is not known, and has a shape of its own.
pub(super) fn last_side(twin: &Twin, gyro: bool) -> Family {
    let mut side = Vector3::zeros();
    let sides: Vec<Vector3<f64>> = twin
        .trajectory
        .moments
        .iter()
        .map(|moment| {
            side = up(moment).zip_map(&side, |up: f64, side| if up.abs() > LOADED { up.signum() } else { side });
            side
        })
        .collect();
    let shape =
        |name: String, value: &dyn Fn(&Vector3<f64>) -> f64| (name, Arc::new(sides.iter().map(value).collect()));
    let known = (0..3).map(|axis| shape(format!("last side of {}", AXES[axis]), &move |side| side[axis]));
    let unknown = (0..3).map(|axis| {
        let first = move |side: &Vector3<f64>| if side[axis] == 0.0 { 1.0 } else { 0.0 };
        shape(format!("before {} was loaded", AXES[axis]), &first)
    });
    remembered("the side before", gyro, &known.chain(unknown).collect::<Vec<_>>())
}

/// A vector that each stretch has, every component of it on each of these channels: 1 °/s or 1 mg per unit.
fn by_stretch(values: Vec<Vector3<f64>>, channels: Range<usize>, name: &str) -> (Vec<(usize, String)>, Vec<Influence>) {
    let values = Arc::new(values);
    let each = channels.flat_map(|channel| (0..3).map(move |axis| (channel, axis)));
    each.map(|(channel, axis)| {
        let values = values.clone();
        let unit = if channel < 3 { DPS } else { 1e-3 * G };
        let influence = reading(move |moment| {
            let value = values.get(moment.stretch).map_or(0.0, |value: &Vector3<f64>| value[axis]);
            Push::channel(channel, unit * value)
        });
        ((channel, format!("{name}{} on {}", AXES[axis], CHANNELS[channel])), influence)
    })
    .unzip()
}
