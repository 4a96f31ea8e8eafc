//! The simulated world behind the sensor, shared by the chip that samples it and the person who moves the box in it.

use std::sync::{Arc, Mutex, MutexGuard};

use tumble_sim::World;

use crate::world::{PhysicalSample, SensorWorld};

/// One sample that the chip took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taken {
    pub t_s: f64,
    pub physical: PhysicalSample,
}

struct Inside {
    world: World,
    taken: Vec<Taken>,
}

/// A handle on the world; clones are the same world.
#[derive(Clone)]
pub struct Theatre(Arc<Mutex<Inside>>);

impl Theatre {
    #[must_use]
    pub fn new(world: World) -> Self {
        Self(Arc::new(Mutex::new(Inside { world, taken: Vec::new() })))
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.0.lock().expect("no panic holds it")
    }

    /// Does something to the world, or asks it something.
    pub fn with<T>(&self, act: impl FnOnce(&mut World) -> T) -> T {
        act(&mut self.inside().world)
    }

    /// The samples that the chip took after `from_s`.
    #[must_use]
    pub fn taken_since(&self, from_s: f64) -> Vec<Taken> {
        let inside = self.inside();
        let first = inside.taken.partition_point(|taken| taken.t_s < from_s);
        inside.taken[first..].to_vec()
    }
}

impl SensorWorld for Theatre {
    fn sample(&mut self, t_s: f64) -> PhysicalSample {
        let mut inside = self.inside();
        let sample = inside.world.sample(t_s);
        let physical = PhysicalSample {
            angular_rate_rad_s: sample.angular_rate_rad_s.into(),
            specific_force_mps2: sample.specific_force_mps2.into(),
            temperature_degc: sample.temperature_degc,
        };
        inside.taken.push(Taken { t_s, physical });
        physical
    }
}
