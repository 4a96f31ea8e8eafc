//! Generic shapes of what lay on which side before: memories by pose, not by time.

use std::sync::Arc;

use nalgebra::Vector3;

use super::family::{Family, remembered, up};
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
    let before = Arc::new(before);
    let each = (0..6).flat_map(|channel| (0..3).map(move |axis| (channel, axis)));
    let one = |(channel, axis): (usize, usize)| {
        let before = before.clone();
        // 1 °/s or 1 mg for each g.
        let unit = if channel < 3 { DPS } else { 1e-3 * G };
        let influence = reading(move |moment| {
            let force = before.get(moment.stretch).map_or(0.0, |force: &Vector3<f64>| force[axis]);
            Push::channel(channel, unit * force)
        });
        ((channel, format!("previous f_{} on {}", AXES[axis], CHANNELS[channel])), influence)
    };
    let (members, influences) = each.map(one).unzip();
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
