//! The moves themselves. Times are since the segment's start; `whole` is the segment's duration.

use super::station::Station;
use super::tone::{Tones, Tremor};
use crate::kinematics::{Jet, Path, Spin, bump, cruise, ease, window};
use core::f64::consts::TAU;
use nalgebra::Vector3;

/// After a move that ends on the table: the hands have let go and the knock rings out, s.
pub(super) const SETTLE_S: f64 = 0.25;
/// Time to take hold of the box or let go of it, s.
const GRASP_S: f64 = 0.4;
/// Time to turn back after an overshoot, s.
const TURN_BACK_S: f64 = 0.9;

/// What happens between a segment's ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Rest,
    Turn(Box<Turn>),
    Carry(Box<Carry>),
    Juggle(Box<Juggle>),
    Hold(Box<Tremor>),
}

impl Shape {
    pub(super) fn at(&self, t_s: f64, whole_s: f64, from: &Station) -> (Spin, Path) {
        match self {
            Self::Rest => (Spin::fixed(from.rotation_n_from_b), Path::fixed(from.position_n_m)),
            Self::Turn(turn) => turn.at(t_s, whole_s, from),
            Self::Carry(carry) => carry.at(t_s, whole_s, from),
            Self::Juggle(juggle) => juggle.at(t_s, whole_s, from),
            Self::Hold(tremor) => {
                let mut path = Path::fixed(from.position_n_m);
                let grip = window(t_s, 0.0, whole_s, GRASP_S);
                (tremor.shake(t_s, grip, Spin::fixed(from.rotation_n_from_b), &mut path), path)
            }
        }
    }
}

/// A turn on the table about the box's own face normal, which is the plate's normal and not the vertical.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Turn {
    /// Plate normal in `n`, and in `b` at the start.
    pub(super) normal_n: Vector3<f64>,
    pub(super) axis_b: Vector3<f64>,
    /// Signed angle from stop to stop, and how far beyond it goes first.
    pub(super) angle_rad: f64,
    pub(super) overshoot_rad: f64,
    pub(super) ramp: f64,
    /// The speed's wander, as an angle.
    pub(super) wander: Tones,
    pub(super) wobble_rad: f64,
    pub(super) wobble_phases: [f64; 2],
    /// Along two directions in the plate; none if it turns on the spot.
    pub(super) slide: Option<[Tones; 2]>,
    pub(super) tremor: Tremor,
}

impl Turn {
    /// `R = R_wobble · R_0 · R(axis, angle)`.
    fn at(&self, t_s: f64, whole_s: f64, from: &Station) -> (Spin, Path) {
        let angle = self.angle(t_s, whole_s);
        let turned = Spin::fixed(from.rotation_n_from_b).then(Spin::about(&self.axis_b, angle));
        let mut path = Path::fixed(from.position_n_m);
        if let Some(slide) = &self.slide {
            let size = window(t_s, 0.0, whole_s, 0.25 * whole_s);
            for (along, tones) in self.plate().iter().zip(slide) {
                path += Path::along(along, tones.at(t_s) * size);
            }
        }
        let grip = window(t_s, 0.0, whole_s, GRASP_S);
        let spin = self.tremor.shake(t_s, grip, self.wobble(t_s, whole_s, angle).then(turned), &mut path);
        (spin, path)
    }

    /// East and north within the plate.
    fn plate(&self) -> [Vector3<f64>; 2] {
        let x = Vector3::x();
        let east = (x - self.normal_n * self.normal_n.dot(&x)).normalize();
        [east, self.normal_n.cross(&east)]
    }

    /// The turn's angle: a cruise at a wandering speed, a little too far, and back.
    fn angle(&self, t_s: f64, whole_s: f64) -> Jet {
        let back_s = if self.overshoot_rad == 0.0 { 0.0 } else { TURN_BACK_S.min(0.3 * whole_s) };
        let main_s = whole_s - back_s;
        let wander = self.wander.at(t_s) * window(t_s, 0.0, main_s, 0.25 * main_s);
        let mut angle = cruise(t_s, 0.0, main_s, self.ramp) * (self.angle_rad + self.overshoot_rad) + wander;
        if back_s > 0.0 {
            angle += ease(t_s, main_s, back_s) * -self.overshoot_rad;
        }
        angle
    }

    /// The spin axis wobbles about the plate's normal by `wobble_rad`, once a turn and, a third as much, twice:
    /// small turns about two axes in the plate, faded in and out so that the box stands flat at both ends.
    fn wobble(&self, t_s: f64, whole_s: f64, angle: Jet) -> Spin {
        if self.wobble_rad == 0.0 {
            return Spin::fixed(nalgebra::UnitQuaternion::identity());
        }
        let [east, north] = self.plate();
        let size = window(t_s, 0.0, whole_s, 0.2 * whole_s) * self.wobble_rad;
        let [once, twice] = self.wobble_phases;
        let (once, twice) = (angle + Jet::constant(once), angle * 2.0 + Jet::constant(twice));
        let lean = |f: fn(Jet) -> Jet| size * (f(once) + f(twice) * (1.0 / 3.0));
        Spin::about(&east, lean(Jet::cos)).then(Spin::about(&north, lean(Jet::sin)))
    }
}

/// Lifted, carried along an arc, turned over on the way, put down.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Carry {
    /// The shortest rotation to the new attitude, in `b`.
    pub(super) axis_b: Vector3<f64>,
    pub(super) angle_rad: f64,
    /// Random extra turns that come back: axis, amplitude (rad), frequency (Hz), phase.
    pub(super) extra: [(Vector3<f64>, f64, f64, f64); 2],
    /// The arc's apex above the straight line, and the straight line, in `n`, m.
    pub(super) apex_n_m: Vector3<f64>,
    pub(super) shift_n_m: Vector3<f64>,
    pub(super) tremor: Tremor,
}

impl Carry {
    fn at(&self, t_s: f64, whole_s: f64, from: &Station) -> (Spin, Path) {
        let move_s = whole_s - SETTLE_S;
        // The box leaves the table before it is turned over, and lies flat just before it is put down.
        let (start_s, span_s) = (0.06 * move_s, 0.88 * move_s);
        let lift = bump(t_s, start_s, span_s);
        let mut spin = Spin::fixed(from.rotation_n_from_b)
            .then(Spin::about(&self.axis_b, ease(t_s, start_s, span_s) * self.angle_rad));
        for (axis, amplitude, frequency_hz, phase) in &self.extra {
            let swing = lift * Jet::phase(TAU * frequency_hz, *phase, t_s).sin() * *amplitude;
            spin = spin.then(Spin::about(axis, swing));
        }
        let mut path = Path::fixed(from.position_n_m);
        path += Path::along(&self.apex_n_m, bump(t_s, 0.0, move_s));
        path += Path::along(&self.shift_n_m, ease(t_s, 0.0, move_s));
        let grip = window(t_s, 0.0, move_s, GRASP_S);
        (self.tremor.shake(t_s, grip, spin, &mut path), path)
    }
}

/// Tumbled freely in the hands; ends where it began.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Juggle {
    /// Turns about fixed axes in `b`, one after the other.
    pub(super) turns: Vec<(Vector3<f64>, Tones)>,
    pub(super) sway: [Tones; 3],
    pub(super) lift_m: f64,
    pub(super) edge_s: f64,
    pub(super) tremor: Tremor,
}

impl Juggle {
    fn at(&self, t_s: f64, whole_s: f64, from: &Station) -> (Spin, Path) {
        let move_s = whole_s - SETTLE_S;
        let size = window(t_s, 0.0, move_s, self.edge_s);
        let mut spin = Spin::fixed(from.rotation_n_from_b);
        for (axis, tones) in &self.turns {
            spin = spin.then(Spin::about(axis, tones.at(t_s) * size));
        }
        let mut path = Path::fixed(from.position_n_m);
        path += Path::along(&Vector3::z(), size * self.lift_m);
        for (axis, tones) in self.sway.iter().enumerate() {
            path += Path::along(&Vector3::ith(axis, 1.0), tones.at(t_s) * size);
        }
        let grip = window(t_s, 0.0, move_s, GRASP_S);
        (self.tremor.shake(t_s, grip, spin, &mut path), path)
    }
}
