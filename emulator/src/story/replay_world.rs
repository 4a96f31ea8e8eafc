//! A recording in the world's place: the sensor feels what was recorded, when it was recorded.

use std::sync::{Arc, Mutex, MutexGuard};

use tumble::recording::Recording;

use super::theatre::Taken;
use crate::world::{PhysicalSample, STANDARD_GRAVITY_MPS2, SensorWorld};

/// Where the recording says nothing of temperature.
const ROOM_DEGC: f64 = 25.0;
/// What the sensor feels now.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    /// The first sample of the recording, over and over.
    Before,
    /// Nothing: no sample comes.
    Silent,
    /// The recording, whose time 0 is at this board time.
    Playing(f64),
    /// The last sample, over and over.
    After,
}

struct Inside {
    mode: Mode,
    rows: Vec<Taken>,
    /// Spacing of what fills the time before and after the recording: its own, from which the firmware learns what to expect.
    fill_s: f64,
}

/// A handle; clones are the same.
#[derive(Clone)]
pub struct ReplayWorld(Arc<Mutex<Inside>>);

impl ReplayWorld {
    /// Times count from the recording's first stamp.
    #[must_use]
    pub fn new(recording: &Recording) -> Self {
        let origin_s = recording.origin_s();
        let row = |row: &tumble::recording::Row| Taken {
            t_s: row.t_s - origin_s,
            physical: PhysicalSample {
                angular_rate_rad_s: row.gyro_dps.map(f64::to_radians),
                specific_force_mps2: row.accel_g.map(|g| g * STANDARD_GRAVITY_MPS2),
                temperature_degc: row.temp_c.unwrap_or(ROOM_DEGC),
            },
        };
        let rows: Vec<Taken> = recording.rows.iter().map(row).collect();
        let span_s = rows.last().map_or(0.0, |row| row.t_s);
        let fill_s = (span_s / (rows.len().max(2) - 1) as f64).max(1e-3);
        Self(Arc::new(Mutex::new(Inside { mode: Mode::Before, rows, fill_s })))
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.0.lock().expect("no panic holds it")
    }

    pub fn be_silent(&self) {
        self.inside().mode = Mode::Silent;
    }

    /// Plays from `start_s` on; answers when the last sample comes.
    pub fn play(&self, start_s: f64) -> f64 {
        let mut inside = self.inside();
        inside.mode = Mode::Playing(start_s);
        start_s + inside.rows.last().map_or(0.0, |row| row.t_s)
    }

    pub fn stay_at_the_end(&self) {
        self.inside().mode = Mode::After;
    }
}

impl SensorWorld for ReplayWorld {
    fn sample(&mut self, t_s: f64) -> PhysicalSample {
        let inside = self.inside();
        let rows = &inside.rows;
        let at = match inside.mode {
            Mode::Before => 0,
            Mode::Silent | Mode::After => rows.len() - 1,
            // The one due at this instant, which the chip has rounded to a nanosecond.
            Mode::Playing(start_s) => rows.partition_point(|row| start_s + row.t_s < t_s + 1e-6).saturating_sub(1),
        };
        rows[at].physical
    }

    fn next_sample_time(&mut self, after_s: f64) -> Option<f64> {
        let inside = self.inside();
        Some(match inside.mode {
            Mode::Before | Mode::After => ((after_s / inside.fill_s).floor() + 1.0) * inside.fill_s,
            Mode::Silent => f64::INFINITY,
            Mode::Playing(start_s) => {
                let next = inside.rows.partition_point(|row| start_s + row.t_s <= after_s);
                inside.rows.get(next).map_or(f64::INFINITY, |row| start_s + row.t_s)
            }
        })
    }
}
