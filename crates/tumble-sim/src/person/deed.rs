//! What the hands do: when, and with which mishaps.

use super::{Ask, LED_PATIENCE_S, NoteKind, Person, REQUEST_LIVES_S, VERDICT_S};
use crate::face::Face;
use crate::motion::{Direction, Primitive};
use crate::scheme::{any_attitude, heading};
use crate::world::World;
use core::f64::consts::TAU;

impl Person {
    /// Moves the box if there is a request, it was not done just now, and the reaction time is over.
    pub(super) fn move_box(&mut self, now_s: f64, world: &mut World) {
        if let Some(due_s) = self.bump_due_s.filter(|due_s| *due_s <= now_s) {
            self.bump_due_s = None;
            world.motion.bump(due_s.max(now_s), self.rng.uniform(3.0, 6.0));
            self.note(now_s, NoteKind::Did, "bumps into the table".to_owned());
        }
        if now_s < self.busy_until_s {
            return;
        }
        let Some(ask) = self.wanted(now_s) else { return };
        let due_s = match self.due_s {
            Some(due_s) => due_s,
            None => {
                let due_s = now_s + self.reaction_s();
                self.due_s = Some(due_s);
                due_s
            }
        };
        // A steady LED says "do not touch": it holds the hands back, but not for ever against a request in words.
        let held_back = self.eye.is_steady(now_s) && now_s < due_s + LED_PATIENCE_S;
        if now_s >= due_s && !held_back {
            self.due_s = None;
            self.busy_until_s = self.obey(now_s, &ask, world);
            self.done = Some((ask, self.busy_until_s));
        }
    }

    /// The request that calls for the hands now, if any.
    fn wanted(&self, now_s: f64) -> Option<Ask> {
        let request = self.request.as_ref().filter(|request| now_s - request.last_s < REQUEST_LIVES_S)?;
        let patience_s = self.config.patience_s;
        if let Some((done, end_s)) = &self.done {
            // It has just let go and waits for the verdict. What it did already it does again only if it is asked
            // afresh later, or for longer than its patience; anything else only if it is still asked after a while.
            let same = *done == request.ask && request.first_s < end_s + VERDICT_S;
            let wait_s = if same { patience_s } else { VERDICT_S };
            if now_s < end_s + wait_s || request.last_s < end_s + VERDICT_S {
                return None;
            }
        }
        match request.ask {
            Ask::Hold(_) => None,
            // On a face with the hands off there is nothing to do, until it has been asked for very long.
            Ask::Still if self.up.is_some() && now_s < request.first_s.max(self.busy_until_s) + patience_s => None,
            _ => Some(request.ask.clone()),
        }
    }

    /// Does what is asked, and returns when it is done.
    fn obey(&mut self, now_s: f64, ask: &Ask, world: &mut World) -> f64 {
        match ask {
            Ask::Place(faces) => {
                let face = self.choose(faces);
                self.place(now_s, face, world)
            }
            Ask::Turn(_, direction) => self.turn(now_s, *direction, world),
            Ask::Pose(_) => self.pose(now_s, world),
            Ask::Still => {
                let face = self.up.unwrap_or(self.favourites[0]);
                self.place(now_s, face, world)
            }
            Ask::Hold(_) => now_s,
        }
    }

    /// One of the faces asked for, in the person's own order, and not the one that is up already if there is another.
    fn choose(&mut self, faces: &[Face]) -> Face {
        let favourites = self.favourites;
        let asked = || favourites.into_iter().filter(|face| faces.contains(face));
        let right = asked().find(|face| Some(*face) != self.up).or_else(|| asked().next()).unwrap_or(Face::PlusZ);
        let others: Vec<Face> = Face::ALL.into_iter().filter(|face| !faces.contains(face)).collect();
        if others.is_empty() || !self.mishap(self.config.clumsiness.wrong_face) {
            return right;
        }
        others[self.rng.index(others.len())]
    }

    fn place(&mut self, now_s: f64, up: Face, world: &mut World) -> f64 {
        let heading_rad = heading(world.motion.config().hands.stops, &mut self.rng);
        let duration_s = self.between(self.config.move_s);
        self.up = Some(up);
        self.note(now_s, NoteKind::Did, format!("puts {up} up"));
        world.motion.push(now_s, Primitive::Reorient { up, heading_rad, duration_s })
    }

    fn turn(&mut self, now_s: f64, asked: Option<Direction>, world: &mut World) -> f64 {
        let any = if self.rng.chance(0.5) { Direction::Ccw } else { Direction::Cw };
        let mut direction = asked.unwrap_or(any);
        if asked.is_some() && self.mishap(self.config.clumsiness.wrong_direction) {
            direction = direction.reversed();
        }
        let short = self.mishap(self.config.clumsiness.short_turn);
        let angle_rad = if short { self.rng.uniform(200.0, 300.0).to_radians() } else { TAU };
        let duration_s = self.between(self.config.turn_s) * angle_rad / TAU;
        let whole = if short { "not quite once".to_owned() } else { "once".to_owned() };
        let name = direction.name();
        self.note(now_s, NoteKind::Did, format!("turns it {whole} round, {name}, in {duration_s:.1} s"));
        world.motion.push(now_s, Primitive::Turn { signed_angle_rad: direction.sign() * angle_rad, duration_s })
    }

    fn pose(&mut self, now_s: f64, world: &mut World) -> f64 {
        let rotation_n_from_b = any_attitude(&mut self.rng);
        let duration_s = self.between(self.config.move_s);
        self.up = None;
        self.note(now_s, NoteKind::Did, "leans it in a new pose".to_owned());
        world.motion.push(now_s, Primitive::Pose { rotation_n_from_b, duration_s })
    }

    /// Decides at the start of a hold whether it will bump into the table, within the next 0.4 to 1.5 s.
    pub(super) fn perhaps_bump(&mut self, now_s: f64) {
        if self.mishap(self.config.clumsiness.bump) {
            self.bump_due_s = Some(now_s + self.rng.uniform(0.4, 1.5));
        }
    }

    fn between(&mut self, (low, high): (f64, f64)) -> f64 {
        self.rng.uniform(low, high)
    }

    /// Whether a mishap of this probability happens now.
    fn mishap(&mut self, probability: f64) -> bool {
        let spent = self.config.clumsiness.at_most.is_some_and(|most| self.mishaps >= most);
        // No draw at probability 0, so that a careful person does the same whatever mishaps exist.
        let happens = probability > 0.0 && !spent && self.rng.chance(probability);
        self.mishaps += u32::from(happens);
        happens
    }
}
