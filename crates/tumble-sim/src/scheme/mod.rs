//! Fixed schemes of moves, recorded offline.

mod imperfection;
mod plan;
mod realistic;
mod record;

pub use imperfection::Imperfection;
pub(crate) use plan::{any_attitude, heading};
pub use record::Recording;

use crate::effect::Effect;
use crate::face::Face;
use crate::motion::{Hands, Stops, Table};
use crate::sensor::SensorTruth;
use crate::world::WorldConfig;

/// What is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// Six faces, each still, one full turn, still: 200 s in segments of 10 s, as in the paper.
    Single,
    /// Six faces, each with a turn both ways: 194 s.
    Double,
    /// Generic poses with hand rotations between them.
    MultiPose {
        /// How many.
        poses: usize,
    },
    /// Six faces without turns, then one full turn about each axis in four quarter steps.
    Quarter,
    /// Tumbled in the hands between two rests.
    Tumble {
        /// s.
        duration_s: f64,
        /// 1 turns at up to 250–400 °/s.
        violence: f64,
    },
}

impl Scheme {
    /// Of its name on the command line: `single`, `double`, `multipose` (17 poses), `quarter`, `tumble` (65 s).
    pub fn parse(name: &str) -> Option<Self> {
        match name {
            "single" => Some(Self::Single),
            "double" => Some(Self::Double),
            "multipose" => Some(Self::MultiPose { poses: 17 }),
            "quarter" => Some(Self::Quarter),
            "tumble" => Some(Self::Tumble { duration_s: 65.0, violence: 1.0 }),
            _ => None,
        }
    }

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Double => "double",
            Self::MultiPose { .. } => "multipose",
            Self::Quarter => "quarter",
            Self::Tumble { .. } => "tumble",
        }
    }
}

/// Which way the single turns go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurnOrder {
    /// Counter-clockwise on faces 1, 3, 5, clockwise on 2, 4, 6: the same sign in the sensor's frame for both faces of
    /// an axis.
    Paper,
    /// Counter-clockwise from above on every face: opposite signs in the sensor's frame, which cancels a bias.
    SameFromAbove,
}

/// How long things take, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Extra rest before everything else.
    pub start_rest_s: f64,
    /// Each still.
    pub still_s: f64,
    /// Each full turn (a quarter turn takes a quarter of it).
    pub turn_s: f64,
    /// Each re-orientation, with settling.
    pub move_s: f64,
}

impl Timing {
    /// The scheme's usual times.
    pub const fn of(scheme: Scheme) -> Self {
        let (still_s, turn_s, move_s) = match scheme {
            Scheme::Single => (10.0, 10.0, 4.0),
            Scheme::Double => (3.0, 10.0, 4.0),
            Scheme::MultiPose { .. } => (4.0, 10.0, 2.5),
            Scheme::Quarter => (5.0, 10.0, 4.0),
            Scheme::Tumble { .. } => (5.0, 10.0, 4.0),
        };
        Self { start_rest_s: 0.0, still_s, turn_s, move_s }
    }
}

/// What a recording's stamps say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stamps {
    /// When the sample was really taken: stamped by the microcontroller's crystal.
    True,
    /// The sample's number over the nominal rate, as many recorders do: a clock error then looks like gyro scale.
    Nominal,
}

/// The sensor's own oscillator and the stamps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// The sensor samples this fraction faster than its nominal rate (the sheet allows ±1 %).
    pub rate_error: f64,
    /// The stamps.
    pub stamps: Stamps,
}

/// A recording to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct SchemeConfig {
    /// What is done.
    pub scheme: Scheme,
    /// With what: seed, table, box, hands, sensor and rate.
    pub world: WorldConfig,
    /// How long things take.
    pub timing: Timing,
    /// Order of the faces.
    pub faces: [Face; 6],
    /// Directions of the single turns.
    pub turns: TurnOrder,
    /// The sensor's clock.
    pub clock: Clock,
    /// Physics that the nominal world leaves out.
    pub effects: Vec<Effect>,
    /// The recorder keeps the mean of every so many samples: a lower rate with the low-pass that belongs to it. 1 keeps
    /// all.
    pub averaged: usize,
}

impl SchemeConfig {
    /// The nominal world: tilt 1.5°, sensor (3, 2, 1) cm off the axis, square box, fence, sheet errors and noise, 200
    /// Hz.
    pub fn new(scheme: Scheme, seed: u64) -> Self {
        Self {
            scheme,
            world: WorldConfig::nominal(seed),
            timing: Timing::of(scheme),
            faces: Face::ALL,
            turns: if scheme == Scheme::Single { TurnOrder::Paper } else { TurnOrder::SameFromAbove },
            clock: Clock { rate_error: 0.0, stamps: Stamps::True },
            effects: Vec::new(),
            averaged: 1,
        }
    }

    /// The paper's simulation: [`Scheme::Single`] with Table 1's gyro, tilt 1.5°, exact turns by a machine with the
    /// sensor on the axis. The accelerometer, of which the paper gives no errors, is drawn from the sheet by the seed.
    pub fn paper(seed: u64) -> Self {
        let mut config = Self::new(Scheme::Single, seed);
        config.world.sensor.truth = SensorTruth::paper_table_1(config.world.sensor.truth.accel);
        config.world.motion.table = Table::tilted(1.5, 30.0);
        config.world.motion.hands = Hands::machine();
        config.world.motion.shape.lever_b_m.fill(0.0);
        config
    }

    /// Whether turns end against something, as the recording's metadata has it: `fenced` or `by-hand`.
    pub fn turns_word(&self) -> &'static str {
        if matches!(self.world.motion.hands.stops, Stops::ByHand { .. }) { "by-hand" } else { "fenced" }
    }
}
