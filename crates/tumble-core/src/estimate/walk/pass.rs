//! What a pass over the tape begins anew with.

use nalgebra::{UnitQuaternion, Vector3};

use crate::estimate::closures::Closures;
use crate::estimate::facets::Facets;
use crate::estimate::filter::Filter;
use crate::estimate::group::Group;
use crate::estimate::model::Nominal;
use crate::estimate::noise::{FORCE_WALK_FLOOR, WALK_FLOOR};
use crate::estimate::resting::{Account, Resting};
use crate::estimate::state::Block;
use crate::estimate::sums::Sums;
use crate::estimate::turn_noise::TurnNoise;
use crate::estimate::wander::Wander;
use crate::estimate::wobble::Wobble;
use crate::face::Face;

/// A pass's memory but for the error state.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Over the pass.
    pub sums: Sums,
    /// What stops, faces and rates at rest say of their variances and of how the bias drifts.
    pub closures: Closures,
    /// See [`Self::closures`].
    pub facets: Facets,
    /// See [`Self::closures`].
    pub resting: Resting,
    /// See [`Self::closures`].
    pub wobble: Wobble,
    /// What the last pass made of the rates at rest, without and with a sensitivity to force, …
    pub accounts: [Option<Account>; 2],
    /// … and whether the gyroscope's bias wanders under each, …
    pub rate_walks: [Wander<3>; 2],
    /// … and the accelerometer's?
    pub force_walk: Wander<1>,
    /// Are there faces enough for the plate to be believed?
    pub plated: bool,
    /// Were there in a stretch before attitude was lost? The faces of another stretch then only share the box's axes.
    pub agreed: bool,
    /// Is the prior still wide?
    pub coarse: bool,
    pub(super) nominal: Nominal,
    /// The same with the bias as it is now.
    pub(super) now: Nominal,
    /// Time since the session's middle, and its length, s.
    pub(super) time_s: f32,
    pub(super) session_s: f32,
    pub(super) segment: usize,
    pub(super) record: usize,
    pub(super) attitude: UnitQuaternion<f32>,
    pub(super) aligned: bool,
    pub(super) table_known: bool,
    pub(super) chains: u16,
    pub(super) visit: Option<Visit>,
    pub(super) group: Group,
    /// How much noisier its readings are than they are taken to be.
    pub(super) turn_noise: TurnNoise,
    /// What the last pass's turns had in common of that: see [`Pool::prior`](crate::estimate::turn_noise::Pool::prior).
    pub(super) turn_prior: Option<(f32, f32)>,
    /// Groups of this turn since the plate was last looked at.
    pub(super) unplated: u16,
    /// Mean rate of this rest, rad/s, and how far from it a record's may be.
    pub(super) steady: (Vector3<f32>, f32),
    /// The move since the last rest: its segment, whether a hand carried it, its length, and that rest's levelling variance, rad².
    pub(super) hinge: Option<usize>,
    pub(super) in_hand: bool,
    pub(super) move_s: f32,
    pub(super) level_variance: f32,
    /// The widest prior sigma of a correction or, over gravity, of the accelerometer's bias, 1.
    pub(super) width: f32,
}

/// A stay on one face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visit {
    pub(super) face: Face,
    pub(super) first_stop: UnitQuaternion<f32>,
    /// Rotation since the last stop that counted, rad, and the gyroscope's variance in it, rad².
    pub(super) turned_rad: f32,
    pub(super) noise: f32,
    /// What the last closure left, rad.
    pub(super) residual: f32,
}

impl Pass {
    /// The session's length, s.
    pub fn session_s(&self) -> f32 {
        self.session_s
    }

    /// Nothing walked yet. `width`: see [`widest`]; `turn_prior`: what the last pass's turns had in common.
    pub(super) fn new(nominal: Nominal, width: f32, turn_prior: Option<(f32, f32)>) -> Self {
        Self {
            width,
            sums: Sums::default(),
            closures: Closures::default(),
            facets: Facets::default(),
            resting: Resting::default(),
            wobble: Wobble::default(),
            accounts: [Some(Account::default()), None],
            rate_walks: [Wander::new(WALK_FLOOR); 2],
            force_walk: Wander::new(FORCE_WALK_FLOOR),
            plated: true,
            agreed: false,
            coarse: true,
            nominal,
            now: nominal,
            time_s: 0.0,
            session_s: 0.0,
            segment: 0,
            record: 0,
            attitude: UnitQuaternion::identity(),
            aligned: false,
            table_known: false,
            chains: 0,
            visit: None,
            group: Group::default(),
            turn_noise: TurnNoise::default(),
            turn_prior,
            unplated: 0,
            steady: (Vector3::zeros(), 0.0),
            hinge: None,
            in_hand: false,
            move_s: 0.0,
            level_variance: 0.0,
        }
    }
}

/// The widest sigma of a correction in a prior or, over gravity, of the accelerometer's bias, 1.
pub(super) fn widest(prior: &Filter, gravity: f32) -> f32 {
    let widest = |block: Block| block.range().fold(0.0f32, |widest, i| widest.max(prior.covariance()[(i, i)]));
    let corrections = widest(Block::GyroCorrection).max(widest(Block::AccelCorrection));
    libm::sqrtf(corrections.max(widest(Block::AccelBias) / (gravity * gravity)))
}
