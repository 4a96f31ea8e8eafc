//! Half a second of motion as one step of the filter.
//!
//! In frame n attitude errors only add up, so the steps of many records sum to one transition and their gravity readings to
//! one mean reading: nothing is lost but what a hand's 8–12 Hz tremor does, which the mean suppresses, and the filter's work
//! falls tenfold.

use nalgebra::Matrix3;

use super::filter::{AttitudeDrive, Filter, Innovation};
use super::model::GravityParts;

/// Sums over the records of a group.
#[derive(Clone, Copy, Debug, Default)]
pub struct Group {
    /// Records in it.
    pub records: u16,
    /// Length, s.
    pub seconds: f32,
    drive: AttitudeDrive,
    since_mean: AttitudeDrive,
    gravity: GravityParts,
    to_n: Matrix3<f32>,
}

impl Group {
    /// Adds a record: its attitude drive and, on the table, its gravity reading; `to_n` is the attitude.
    pub fn take(&mut self, drive: &AttitudeDrive, gravity: Option<&GravityParts>, to_n: &Matrix3<f32>, dt_s: f32) {
        self.drive.add(drive, 1.0);
        // A record's drive is missed by the readings of all records before and by half of its own.
        self.since_mean.add(drive, self.seconds + 0.5 * dt_s);
        if let Some(gravity) = gravity {
            self.gravity.add(gravity, dt_s);
        }
        self.to_n += to_n * dt_s;
        self.records += 1;
        self.seconds += dt_s;
    }

    /// Carries the filter over the group; `variance` is what its rotation's noise adds, rad².
    pub fn propagate(&self, filter: &mut Filter, variance: f32) {
        filter.propagate(&self.drive, variance);
    }

    /// The mean of the attitude as a matrix, and how attitude has moved on since that mean. The attitude at the group's end would have
    /// what turns with the box 9° out of phase (36 °/s): as if table, faces and box were seen in another place than where they were.
    pub fn mean_attitude(&self) -> (Matrix3<f32>, AttitudeDrive) {
        (self.to_n / self.seconds, self.mean_since())
    }

    fn mean_since(&self) -> AttitudeDrive {
        let mut since = AttitudeDrive::default();
        since.add(&self.since_mean, 1.0 / self.seconds);
        since
    }

    /// Takes in the mean gravity reading after [`Self::propagate`].
    pub fn observe(&self, filter: &mut Filter, gravity_mps2: f32, variance: f32) -> [Innovation; 3] {
        let share = 1.0 / self.seconds;
        let mut mean = GravityParts::default();
        mean.add(&self.gravity, share);
        let since = self.mean_since();
        let observation = mean.observation(gravity_mps2, Some(&since));
        filter.observe_vector(&observation.rows, &observation.residual, variance)
    }
}
