//! Generic shapes of what went before: memories of motion and of force, which fade with time.

use std::sync::Arc;

use nalgebra::Vector3;

use super::family::{Family, remembered};
use crate::diagnose::catalogue::{AXES, G};
use crate::diagnose::twin::Twin;

/// What shapes remember of a rate.
type Remembered = fn(&Vector3<f64>) -> f64;

/// Readings that remember motion: `∫ e^(−(t−s)/τ) ω(s) ds`, its components' sizes, and its own.
pub(super) fn memory_of_motion(twin: &Twin, gyro: bool) -> Family {
    const TAUS_S: [f64; 3] = [2.0, 8.0, 30.0];
    // Shapes that belong to axes come first, in threes.
    const OF_AXES: [(&str, Remembered); 6] = [
        ("w_x", |w| w.x),
        ("w_y", |w| w.y),
        ("w_z", |w| w.z),
        ("|w_x|", |w| w.x.abs()),
        ("|w_y|", |w| w.y.abs()),
        ("|w_z|", |w| w.z.abs()),
    ];
    let of_axes = TAUS_S.into_iter().flat_map(|tau_s| OF_AXES.map(|(name, value)| (tau_s, name, value)));
    let whole = TAUS_S.map(|tau_s| (tau_s, "|w|", (|w| w.norm()) as Remembered));
    let shapes: Vec<_> = of_axes
        .chain(whole)
        .map(|(tau_s, name, value)| (format!("memory of {name} over {tau_s} s"), faded(twin, tau_s, value)))
        .collect();
    remembered("memory of motion", gyro, &shapes)
}

/// `∫ e^(−(t−s)/τ) v(s) ds` of a value of the rate.
fn faded(twin: &Twin, tau_s: f64, value: Remembered) -> Arc<Vec<f64>> {
    let (mut sum, mut last_s) = (0.0, 0.0);
    let filtered = twin.trajectory.moments.iter().map(|moment| {
        let dt_s = moment.t_s - last_s;
        last_s = moment.t_s;
        sum = sum * (-dt_s / tau_s).exp() + value(&moment.smooth_rate) * dt_s;
        sum
    });
    Arc::new(filtered.collect())
}

/// Readings that come late in part, as of a body that creeps: `ṡ = (f − s)/τ`, settled at the start.
pub(super) fn memory_of_force(twin: &Twin, gyro: bool) -> Family {
    let mut shapes: Vec<(String, Arc<Vec<f64>>)> = Vec::new();
    for tau_s in [3.0, 12.0, 50.0] {
        for (axis, letter) in AXES.iter().enumerate() {
            let (mut settled, mut last_s) = (None, 0.0);
            let filtered = twin.trajectory.moments.iter().map(|moment| {
                let force = moment.force[axis] / G;
                let keep = (-(moment.t_s - last_s) / tau_s).exp();
                last_s = moment.t_s;
                let value = force + (settled.unwrap_or(force) - force) * keep;
                settled = Some(value);
                value
            });
            shapes.push((format!("memory of f_{letter} over {tau_s} s"), Arc::new(filtered.collect())));
        }
    }
    remembered("memory of force", gyro, &shapes)
}
