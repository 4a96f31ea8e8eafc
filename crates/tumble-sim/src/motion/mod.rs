//! Where the box is at every instant: a queue of exact moves, each from rest to rest.
//!
//! A move is a product of turns about fixed axes with analytic angles, so attitude, rate, angular acceleration, position,
//! velocity and acceleration are exact and consistent to rounding; rate and its derivative are continuous everywhere.

mod knock;
mod plan;
mod platform;
mod segment;
mod setting;
mod shape;
mod station;
mod tone;

pub use knock::Knock;
pub use plan::Standing;
pub(crate) use platform::{Course, Lean, Shortfall};
pub use segment::{Kind, Segment};
pub use setting::{BoxShape, Hands, MotionConfig, Stops, Table, Vibration};
pub use station::Station;

use crate::error::SimError;
use crate::face::Face;
use crate::kinematics::{Jet, Path, Spin};
use crate::rng::{Purpose, Rng};
use core::f64::consts::TAU;
use nalgebra::{UnitQuaternion, Vector3};
use plan::Planner;

/// Which way round, as seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Counter-clockwise: positive about up.
    Ccw,
    /// Clockwise.
    Cw,
}

impl Direction {
    /// +1 or −1.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Ccw => 1.0,
            Self::Cw => -1.0,
        }
    }

    /// The other way.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Ccw => Self::Cw,
            Self::Cw => Self::Ccw,
        }
    }

    /// The protocol's word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ccw => "ccw",
            Self::Cw => "cw",
        }
    }
}

/// A move that can be asked for. Every one ends at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Primitive {
    /// Hands off.
    Rest {
        /// s.
        duration_s: f64,
    },
    /// Held in the hands in the present attitude, with their tremor.
    Hold {
        /// s.
        duration_s: f64,
    },
    /// A turn on the table about the plate's normal. The stop's error comes on top.
    Turn {
        /// Counter-clockwise as seen from above positive, rad.
        signed_angle_rad: f64,
        /// s.
        duration_s: f64,
    },
    /// Lifted, turned over and put down with another face up.
    Reorient {
        /// The face that is to point up.
        up: Face,
        /// The mark that it is put against: heading about the plate's normal, rad.
        heading_rad: f64,
        /// Without the 0.25 s it takes to settle, s.
        duration_s: f64,
    },
    /// Carried to an oblique attitude and leaned against something.
    Pose {
        /// The attitude.
        rotation_n_from_b: UnitQuaternion<f64>,
        /// Without the 0.25 s it takes to settle, s.
        duration_s: f64,
    },
    /// Tumbled freely in the hands, back to where it was.
    Tumble {
        /// Without the 0.25 s it takes to settle, s.
        duration_s: f64,
        /// 1 turns at up to 250–400 °/s.
        violence: f64,
    },
}

impl Primitive {
    /// A full turn.
    pub const fn full_turn(direction: Direction, duration_s: f64) -> Self {
        Self::Turn { signed_angle_rad: direction.sign() * TAU, duration_s }
    }
}

/// Everything about the box's motion at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Attitude, with rate (rad/s) and angular acceleration (rad/s²) relative to the Earth, in `b`.
    pub spin: Spin,
    /// The box's centre in `n`.
    pub centre: Path,
}

impl Kinematics {
    /// Position, velocity and acceleration in `n` of a point fixed in the box at `lever_b_m` from its centre.
    pub fn point(&self, lever_b_m: &Vector3<f64>) -> Path {
        let rotation = self.spin.rotation;
        Path {
            position: self.centre.position + rotation * lever_b_m,
            velocity: self.centre.velocity + rotation * self.spin.lever_velocity(lever_b_m),
            acceleration: self.centre.acceleration + rotation * self.spin.lever_acceleration(lever_b_m),
        }
    }
}

/// The queue of moves.
#[derive(Debug, Clone)]
pub struct Motion {
    config: MotionConfig,
    rng: Rng,
    start: Station,
    standing: Standing,
    segments: Vec<Segment>,
    knocks: Vec<Knock>,
    pub(crate) leans: Vec<Lean>,
    /// On a soft table, at the last rest, rad.
    leans_n: Vector3<f64>,
    pub(crate) shortfall: Option<Shortfall>,
}

impl Motion {
    /// The box stands on the table with `+z` up.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(config: MotionConfig, seed: u64) -> Result<Self, SimError> {
        config.check()?;
        let mut rng = Rng::new(seed, Purpose::Hands);
        let standing = Standing { up: Some(Face::PlusZ), mark_rad: 0.0, offset_rad: config.hands.stops.draw(&mut rng) };
        let start = Station {
            rotation_n_from_b: config.table.rotation_n_from_p()
                * config.shape.standing(Face::PlusZ, standing.offset_rad),
            position_n_m: Vector3::zeros(),
        };
        Ok(Self {
            config,
            rng,
            start,
            standing,
            segments: Vec::new(),
            knocks: Vec::new(),
            leans: Vec::new(),
            leans_n: Vector3::zeros(),
            shortfall: None,
        })
    }

    /// What it was made from.
    pub fn config(&self) -> &MotionConfig {
        &self.config
    }

    /// Appends a move that begins at `now_s`, or when the queue ends if that is later. Returns when it ends.
    ///
    /// Durations are raised to 0.8 s where a move needs that much; a duration or angle that is not finite makes a rest
    /// of no length.
    pub fn push(&mut self, now_s: f64, primitive: Primitive) -> f64 {
        let start_s = self.end_s().max(now_s);
        if !is_finite(&primitive) {
            return start_s;
        }
        let from = self.station();
        let primitive = self.shortened(primitive);
        let planner = Planner { config: &self.config, rng: &mut self.rng, from, standing: self.standing };
        let plan = planner.plan(&primitive);
        let end_s = start_s + plan.duration_s;
        if self.config.table.soft_deg > 0.0 && !matches!(primitive, Primitive::Rest { .. } | Primitive::Hold { .. }) {
            self.sink(start_s, plan.duration_s);
        }
        self.standing = plan.standing;
        self.segments.push(Segment { start_s, duration_s: plan.duration_s, from, to: plan.to, shape: plan.shape });
        if plan.put_down && self.config.hands.knock_mps2 > 0.0 {
            let settle_s = shape::SETTLE_S;
            let peak = self.config.hands.knock_mps2 * self.rng.uniform(0.3, 1.0);
            self.knocks.push(Knock::draw(end_s - settle_s, settle_s, peak, &mut self.rng));
        }
        end_s
    }

    /// The box comes to lean otherwise than before, while it moves.
    fn sink(&mut self, start_s: f64, duration_s: f64) {
        let sigma = self.config.table.soft_deg.to_radians();
        let leans_n = Vector3::new(self.rng.normal(), self.rng.normal(), 0.0) * sigma;
        let more = leans_n - std::mem::replace(&mut self.leans_n, leans_n);
        self.leans.push(Lean {
            axis_n: more.try_normalize(0.0).unwrap_or_else(Vector3::x),
            pivot_n_m: Vector3::zeros(),
            angle_rad: more.norm(),
            course: Course::Sink { start_s, duration_s },
        });
    }

    /// The same, but for a turn that stops short.
    fn shortened(&self, primitive: Primitive) -> Primitive {
        match (primitive, self.shortfall) {
            (Primitive::Turn { signed_angle_rad, duration_s }, Some(shortfall)) => {
                let turn = self.segments.iter().filter(|segment| segment.kind() == Kind::Turn).count();
                Primitive::Turn { signed_angle_rad: shortfall.of(turn, signed_angle_rad), duration_s }
            }
            _ => primitive,
        }
    }

    /// Someone bumps the table at `start_s` with this peak acceleration (m/s²); it rings for about half a second.
    pub fn bump(&mut self, start_s: f64, peak_mps2: f64) {
        let duration_s = self.rng.uniform(0.35, 0.7);
        self.knocks.push(Knock::draw(start_s, duration_s, peak_mps2, &mut self.rng));
    }

    /// When the queue ends, s; minus infinity if nothing was ever queued.
    pub fn end_s(&self) -> f64 {
        self.segments.last().map_or(f64::NEG_INFINITY, Segment::end_s)
    }

    /// Where the box will be when the queue has ended.
    pub fn station(&self) -> Station {
        self.segments.last().map_or(self.start, |segment| segment.to)
    }

    /// How the box will stand when the queue has ended.
    pub fn standing(&self) -> Standing {
        self.standing
    }

    /// All moves so far.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// All knocks so far.
    pub fn knocks(&self) -> &[Knock] {
        &self.knocks
    }

    /// Whether nothing moves the box at `t_s`: no hand and no knock. The table's steady vibration does not count.
    pub fn idle_at(&self, t_s: f64) -> bool {
        let still = self.segment_at(t_s).is_none_or(|s| t_s >= s.end_s() || s.kind() == Kind::Rest);
        still && !self.knocks.iter().any(|k| k.start_s <= t_s && t_s < k.end_s())
    }

    /// The motion at any `t_s`, past or future.
    pub fn at(&self, t_s: f64) -> Kinematics {
        let (mut spin, mut centre) = match self.segment_at(t_s) {
            Some(segment) => segment.at(t_s),
            None => (Spin::fixed(self.start.rotation_n_from_b), Path::fixed(self.start.position_n_m)),
        };
        for knock in self.knocks.iter().rev() {
            spin = knock.shake(t_s, spin, &mut centre);
        }
        if let Some(vibration) = self.config.table.vibration {
            let omega = TAU * vibration.frequency_hz;
            let shake = Jet::phase(omega, 0.0, t_s).sin() * (-vibration.amplitude_mps2 / (omega * omega));
            centre += Path::along(&vibration.direction_n.normalize(), shake);
        }
        for lean in &self.leans {
            spin = lean.carry(t_s, spin, &mut centre);
        }
        Kinematics { spin, centre }
    }

    /// The last segment that begins at or before `t_s`.
    fn segment_at(&self, t_s: f64) -> Option<&Segment> {
        let after = self.segments.partition_point(|segment| segment.start_s <= t_s);
        after.checked_sub(1).and_then(|i| self.segments.get(i))
    }
}

/// Whether every number in a request can be used.
fn is_finite(primitive: &Primitive) -> bool {
    match *primitive {
        Primitive::Rest { duration_s } | Primitive::Hold { duration_s } => duration_s.is_finite(),
        Primitive::Turn { signed_angle_rad, duration_s } => signed_angle_rad.is_finite() && duration_s.is_finite(),
        Primitive::Reorient { heading_rad, duration_s, .. } => heading_rad.is_finite() && duration_s.is_finite(),
        Primitive::Pose { rotation_n_from_b, duration_s } => {
            rotation_n_from_b.coords.iter().all(|c| c.is_finite()) && duration_s.is_finite()
        }
        Primitive::Tumble { duration_s, violence } => duration_s.is_finite() && violence.is_finite(),
    }
}
