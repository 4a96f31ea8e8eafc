//! From what is wanted to an exact move: the draws that make each one different.

use super::Primitive;
use super::setting::{BoxShape, Hands, MotionConfig};
use super::shape::{Carry, Juggle, SETTLE_S, Shape, Turn};
use super::station::Station;
use super::tone::{Tones, Tremor};
use crate::face::Face;
use crate::rng::Rng;
use core::f64::consts::{PI, TAU};
use nalgebra::{Unit, UnitQuaternion, Vector3};

/// Where the box stands, as the person thinks of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Which face is up; `None` in an oblique pose.
    pub up: Option<Face>,
    /// The heading of the mark or fence that it stands against, rad.
    pub mark_rad: f64,
    /// How far beside it, rad.
    pub offset_rad: f64,
}

/// A planned move.
pub(super) struct Plan {
    pub(super) shape: Shape,
    pub(super) to: Station,
    pub(super) standing: Standing,
    /// Including the time to settle.
    pub(super) duration_s: f64,
    pub(super) put_down: bool,
}

/// A box that is turned by hand is pushed about as slowly as this, Hz.
const SLIDE_HZ: (f64, f64) = (0.05, 0.5);
/// Shortest move that still has room for its edges, s.
const SHORTEST_S: f64 = 0.8;

pub(super) struct Planner<'a> {
    pub(super) config: &'a MotionConfig,
    pub(super) rng: &'a mut Rng,
    pub(super) from: Station,
    pub(super) standing: Standing,
}

impl Planner<'_> {
    pub(super) fn plan(mut self, primitive: &Primitive) -> Plan {
        match *primitive {
            Primitive::Rest { duration_s } => self.stay(Shape::Rest, duration_s.max(0.0)),
            Primitive::Hold { duration_s } => {
                let tremor = Tremor::in_air(&self.config.hands, self.rng);
                self.stay(Shape::Hold(Box::new(tremor)), duration_s.max(SHORTEST_S))
            }
            Primitive::Turn { signed_angle_rad, duration_s } => self.turn(signed_angle_rad, duration_s.max(SHORTEST_S)),
            Primitive::Reorient { up, heading_rad, duration_s } => self.reorient(up, heading_rad, duration_s),
            Primitive::Pose { rotation_n_from_b, duration_s } => {
                let standing = Standing { up: None, mark_rad: 0.0, offset_rad: 0.0 };
                let at = self.scattered();
                self.carry(Station { rotation_n_from_b, position_n_m: at }, standing, duration_s)
            }
            Primitive::Tumble { duration_s, violence } => self.tumble(duration_s, violence),
        }
    }

    fn hands(&self) -> &Hands {
        &self.config.hands
    }

    fn shape(&self) -> &BoxShape {
        &self.config.shape
    }

    fn stay(self, shape: Shape, duration_s: f64) -> Plan {
        Plan { shape, to: self.from, standing: self.standing, duration_s, put_down: false }
    }

    /// The stop's error is the difference of two stops' offsets from the mark.
    fn turn(mut self, wanted_rad: f64, duration_s: f64) -> Plan {
        let hands = *self.hands();
        let offset_rad = hands.stops.draw(self.rng);
        let angle_rad = wanted_rad + offset_rad - self.standing.offset_rad;
        let normal_n = self.config.table.normal_n();
        let axis_b = self.from.rotation_n_from_b.inverse_transform_vector(&normal_n);
        let overshoot = wanted_rad.signum() * self.rng.uniform(0.0, hands.overshoot_deg).to_radians();
        let wander_rate = hands.speed_wander * wanted_rad.abs() / duration_s;
        let turn = Turn {
            normal_n,
            axis_b,
            angle_rad,
            overshoot_rad: overshoot,
            ramp: hands.turn_ramp,
            wander: Tones::band_of_rate(0.25, 1.2, wander_rate, self.rng),
            wobble_rad: hands.wobble_deg.to_radians(),
            wobble_phases: [self.rng.phase(), self.rng.phase()],
            tremor: Tremor::on_table(&hands, normal_n, self.rng),
            // Drawn last, and only if there is any: no other motion changes with it.
            slide: self.slide(hands.slide_m),
        };
        let turned = UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis_b), angle_rad);
        Plan {
            shape: Shape::Turn(Box::new(turn)),
            to: Station { rotation_n_from_b: self.from.rotation_n_from_b * turned, ..self.from },
            standing: Standing { mark_rad: self.standing.mark_rad + wanted_rad, offset_rad, ..self.standing },
            duration_s,
            put_down: false,
        }
    }

    fn slide(&mut self, size_m: f64) -> Option<[Tones; 2]> {
        (size_m > 0.0).then(|| core::array::from_fn(|_| Tones::band(SLIDE_HZ.0, SLIDE_HZ.1, size_m, self.rng)))
    }

    fn reorient(mut self, up: Face, mark_rad: f64, duration_s: f64) -> Plan {
        let offset_rad = self.hands().stops.draw(self.rng);
        let standing = self.shape().standing(up, mark_rad + offset_rad);
        let to = Station {
            rotation_n_from_b: self.config.table.rotation_n_from_p() * standing,
            position_n_m: self.scattered(),
        };
        self.carry(to, Standing { up: Some(up), mark_rad, offset_rad }, duration_s)
    }

    /// A place on the plate near the origin, in `n`, m.
    fn scattered(&mut self) -> Vector3<f64> {
        let size = self.hands().scatter_m;
        let within = Vector3::new(self.rng.symmetric(size), self.rng.symmetric(size), 0.0);
        self.config.table.rotation_n_from_p() * within
    }

    fn carry(self, to: Station, standing: Standing, duration_s: f64) -> Plan {
        let between = self.from.rotation_n_from_b.inverse() * to.rotation_n_from_b;
        let (axis_b, angle_rad) =
            between.axis_angle().map_or((Vector3::x(), 0.0), |(a, angle)| (a.into_inner(), angle));
        let mut extra = |size_deg: f64, low_hz: f64, high_hz: f64| {
            let size = size_deg.to_radians() * self.rng.normal();
            (self.rng.direction(), size, self.rng.uniform(low_hz, high_hz), self.rng.phase())
        };
        // Swings of some 20° come with turning a box over, and a quicker 6° with changing the grip.
        let extra = [extra(20.0, 0.1, 0.5), extra(6.0, 0.8, 1.6)];
        let sideways = self.rng.phase();
        let aside = Vector3::new(sideways.cos(), sideways.sin(), 0.0) * self.rng.uniform(0.0, 0.15);
        let carry = Carry {
            axis_b,
            angle_rad,
            extra,
            apex_n_m: Vector3::z() * self.rng.uniform(0.1, 0.3) + aside,
            shift_n_m: to.position_n_m - self.from.position_n_m,
            tremor: Tremor::in_air(&self.config.hands, self.rng),
        };
        let duration_s = duration_s.max(SHORTEST_S) + SETTLE_S;
        Plan { shape: Shape::Carry(Box::new(carry)), to, standing, duration_s, put_down: true }
    }

    /// Four turns about random axes, each with a rate of some 80 °/s rms at violence 1: 250–400 °/s at the peaks.
    fn tumble(self, duration_s: f64, violence: f64) -> Plan {
        let violence = violence.clamp(0.0, 5.0);
        let turns = (0..4)
            .map(|k| {
                let rate = violence * self.rng.uniform(50.0, 110.0) * PI / 180.0;
                let quick = 1.0 + 0.35 * f64::from(k);
                (self.rng.direction(), Tones::band_of_rate(0.12 * quick, 0.7 * quick, rate, self.rng))
            })
            .collect();
        // Arms sway with up to some 2 m/s² at violence 1: 60 mm of rms at (2π·0.8 Hz)².
        let sway_m = 1.5 * violence / (TAU * 0.8).powi(2);
        let juggle = Juggle {
            turns,
            sway: core::array::from_fn(|_| Tones::band(0.3, 1.2, sway_m, self.rng)),
            lift_m: self.rng.uniform(0.2, 0.4),
            edge_s: 2.0,
            tremor: Tremor::in_air(&self.config.hands, self.rng),
        };
        let duration_s = duration_s.max(SHORTEST_S) + SETTLE_S;
        let shape = Shape::Juggle(Box::new(juggle));
        Plan { shape, to: self.from, standing: self.standing, duration_s, put_down: true }
    }
}
