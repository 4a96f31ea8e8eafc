//! A short ring of the table: the box is put down, or someone bumps into it.

use crate::kinematics::{Jet, Path, Spin, ease};
use crate::rng::Rng;
use core::f64::consts::TAU;
use nalgebra::Vector3;

/// Rise of the ring, s: as fast as a wooden table follows.
const RISE_S: f64 = 0.012;

/// `A·e(t)·sin(2πf(t − t₀))` in position, and the same in a small rock of the box; leaves everything as it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Knock {
    /// When it begins, s.
    pub start_s: f64,
    /// How long it rings, s.
    pub duration_s: f64,
    frequency_hz: f64,
    displacement_n_m: Vector3<f64>,
    rock_b_rad: Vector3<f64>,
}

impl Knock {
    /// A knock of about this peak acceleration (m/s²) from a random side.
    ///
    /// The table rings at 25–45 Hz, as desks do; the box rocks with it by 1 mrad per m/s² of the knock, at most some
    /// 10 °/s for a set-down of 1 m/s².
    pub fn draw(start_s: f64, duration_s: f64, peak_mps2: f64, rng: &mut Rng) -> Self {
        let frequency_hz = rng.uniform(25.0, 45.0);
        let omega = TAU * frequency_hz;
        let rock = 1e-3 * peak_mps2 * rng.uniform(0.3, 1.0);
        let level = Vector3::new(rng.normal(), rng.normal(), 0.0);
        Self {
            start_s,
            duration_s: duration_s.max(4.0 * RISE_S),
            frequency_hz,
            displacement_n_m: (Vector3::z() + 0.4 * level).normalize() * (peak_mps2 / (omega * omega)),
            rock_b_rad: rng.direction() * rock,
        }
    }

    /// When it has died away, s.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// Adds the knock to a motion.
    pub(super) fn shake(&self, t_s: f64, spin: Spin, path: &mut Path) -> Spin {
        if t_s <= self.start_s || t_s >= self.end_s() {
            return spin;
        }
        let rise = ease(t_s, self.start_s, RISE_S);
        let fall = Jet::constant(1.0) - ease(t_s, self.start_s + RISE_S, self.duration_s - RISE_S);
        let ring = rise * fall * Jet::phase(TAU * self.frequency_hz, 0.0, t_s - self.start_s).sin();
        *path += Path::along(&self.displacement_n_m, ring);
        let angle = self.rock_b_rad.norm();
        match self.rock_b_rad.try_normalize(0.0) {
            Some(axis) => spin.then(Spin::about(&axis, ring * angle)),
            None => spin,
        }
    }
}
