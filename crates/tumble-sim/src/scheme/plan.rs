//! The moves of each scheme.

use super::{Scheme, SchemeConfig, TurnOrder};
use crate::face::Face;
use crate::motion::{Direction, Primitive, Stops};
use crate::rng::{Purpose, Rng};
use crate::world::World;
use core::f64::consts::FRAC_PI_2;
use nalgebra::{Quaternion, UnitQuaternion};

/// Time that a put-down takes to settle, which the motion adds to a re-orientation, s.
const SETTLE_S: f64 = 0.25;
/// Rest between two quarter turns, s.
const BETWEEN_QUARTERS_S: f64 = 2.0;

/// Queues the scheme's moves from time 0, with the box already on its first face; returns when all is done, s.
pub(super) fn queue(config: &SchemeConfig, world: &mut World) -> f64 {
    let mut hand = Hand { config, world, rng: Rng::new(config.world.seed, Purpose::Scheme), end_s: -30.0 };
    match config.scheme {
        Scheme::Single => hand.single(),
        Scheme::Double => hand.double(),
        Scheme::MultiPose { poses } => hand.poses(poses),
        Scheme::Quarter => hand.quarter(),
        Scheme::Tumble { duration_s, violence } => hand.tumble(duration_s, violence),
    }
    hand.end_s
}

struct Hand<'a> {
    config: &'a SchemeConfig,
    world: &'a mut World,
    rng: Rng,
    end_s: f64,
}

impl Hand<'_> {
    fn push(&mut self, primitive: Primitive) {
        self.end_s = self.world.motion.push(self.end_s, primitive);
    }

    fn still(&mut self) {
        self.push(Primitive::Rest { duration_s: self.config.timing.still_s });
    }

    fn full_turn(&mut self, direction: Direction) {
        self.push(Primitive::full_turn(direction, self.config.timing.turn_s));
    }

    fn face(&mut self, up: Face) {
        let heading_rad = heading(self.config.world.motion.hands.stops, &mut self.rng);
        self.push(Primitive::Reorient { up, heading_rad, duration_s: self.config.timing.move_s - SETTLE_S });
    }

    /// What came so far happened before the recording: it begins now, with the extra rest.
    fn begin(&mut self) {
        self.end_s = 0.0;
        self.push(Primitive::Rest { duration_s: self.config.timing.start_rest_s });
    }

    fn single(&mut self) {
        for (i, face) in self.config.faces.into_iter().enumerate() {
            self.face(face);
            if i == 0 {
                self.begin();
            }
            let backwards = self.config.turns == TurnOrder::Paper && i % 2 == 1;
            self.still();
            self.full_turn(if backwards { Direction::Cw } else { Direction::Ccw });
            self.still();
        }
    }

    fn double(&mut self) {
        for (i, face) in self.config.faces.into_iter().enumerate() {
            self.face(face);
            if i == 0 {
                self.begin();
            }
            for direction in [Direction::Ccw, Direction::Cw] {
                self.still();
                self.full_turn(direction);
            }
            self.still();
        }
    }

    fn quarter(&mut self) {
        let faces = self.config.faces.into_iter().enumerate();
        for (i, face) in faces {
            self.face(face);
            if i == 0 {
                self.begin();
            }
            self.still();
        }
        for face in [Face::PlusX, Face::PlusY, Face::PlusZ] {
            self.face(face);
            self.still();
            for _ in 0..4 {
                self.push(Primitive::Turn {
                    signed_angle_rad: FRAC_PI_2,
                    duration_s: 0.25 * self.config.timing.turn_s,
                });
                self.push(Primitive::Rest { duration_s: BETWEEN_QUARTERS_S });
            }
            self.still();
        }
    }

    fn poses(&mut self, poses: usize) {
        self.begin();
        self.still();
        for _ in 0..poses {
            let rotation_n_from_b = any_attitude(&mut self.rng);
            self.push(Primitive::Pose { rotation_n_from_b, duration_s: self.config.timing.move_s - SETTLE_S });
            self.still();
        }
    }

    fn tumble(&mut self, duration_s: f64, violence: f64) {
        self.begin();
        self.still();
        self.push(Primitive::Tumble { duration_s, violence });
        self.still();
    }
}

/// The heading at which a box is put down: square to the fence, or by eye to some 5°.
pub(crate) fn heading(stops: Stops, rng: &mut Rng) -> f64 {
    let square = rng.index(4) as f64 * FRAC_PI_2;
    let by_eye = if matches!(stops, Stops::ByHand { .. }) { 5f64.to_radians() * rng.normal() } else { 0.0 };
    square + by_eye
}

/// An attitude, uniform over all rotations.
pub(crate) fn any_attitude(rng: &mut Rng) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(rng.normal(), rng.normal(), rng.normal(), rng.normal()))
}
