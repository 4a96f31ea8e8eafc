//! A table that does not stay where it was: it sinks on one leg, or rocks.

use crate::kinematics::{Jet, Path, Spin, ease};
use core::f64::consts::TAU;
use nalgebra::Vector3;

/// How the angle goes with time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Course {
    /// From 0 to the whole angle, where it stays.
    Sink { start_s: f64, duration_s: f64 },
    /// `angle · sin(2πft + φ)`, all the time.
    Rock { frequency_hz: f64, phase_rad: f64 },
}

/// A rotation of table, box and all about a fixed level axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lean {
    /// Unit vector in `n`.
    pub(crate) axis_n: Vector3<f64>,
    /// A point on the axis, m from where the box stands.
    pub(crate) pivot_n_m: Vector3<f64>,
    /// rad.
    pub(crate) angle_rad: f64,
    pub(crate) course: Course,
}

impl Lean {
    fn angle(&self, t_s: f64) -> Jet {
        let share = match self.course {
            Course::Sink { start_s, duration_s } => ease(t_s, start_s, duration_s),
            Course::Rock { frequency_hz, phase_rad } => Jet::phase(TAU * frequency_hz, phase_rad, t_s).sin(),
        };
        share * self.angle_rad
    }

    /// Carries a motion along: `p' = c + R(p − c)`, and with `ω` in the moving frame
    /// `v' = R(v + ω × r)`, `a' = R(a + 2ω × v + ω̇ × r + ω × (ω × r))`.
    pub(super) fn carry(&self, t_s: f64, spin: Spin, path: &mut Path) -> Spin {
        let lean = Spin::about(&self.axis_n, self.angle(t_s));
        let arm = path.position - self.pivot_n_m;
        let (velocity, acceleration) = (path.velocity, path.acceleration);
        path.position = self.pivot_n_m + lean.rotation * arm;
        path.velocity = lean.rotation * (velocity + lean.lever_velocity(&arm));
        path.acceleration =
            lean.rotation * (acceleration + 2.0 * lean.rate.cross(&velocity) + lean.lever_acceleration(&arm));
        lean.then(spin)
    }
}

/// Turns that stop short of where they were to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shortfall {
    /// rad.
    pub(crate) angle_rad: f64,
    /// Which turn, counted from 0; all of them if none is named.
    pub(crate) only: Option<usize>,
}

impl Shortfall {
    /// What becomes of the turn of this number.
    pub(super) fn of(&self, turn: usize, wanted_rad: f64) -> f64 {
        let meant = self.only.is_none_or(|only| only == turn);
        let short = if meant { self.angle_rad.min(wanted_rad.abs()) } else { 0.0 };
        wanted_rad - wanted_rad.signum() * short
    }
}
