//! The gyro's scale drifts with time.
//!
//! `D(t) = (I + diag(s)·(t/T − ½))·D` over the recording's length `T`, while the temperature stands: the drive
//! amplitude settles.
//!
//! Magnitude: the largest `|s_i|`, ppm from the first to the last sample.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_gyro_scale_drift",
    name: "gyro scale drifts with time",
    meaning: "the largest change of an axis' scale over the recording",
    unit: "ppm",
    default: 2000.0,
    values: Values::Range(0.0, 100000.0),
    draws: (1500.0, 5000.0),
    source: "drive amplitude after switch-on: 100 to 1000 ppm",
    injects: true,
    make: |draw| {
        let (start_s, duration_s) = (draw.scene.start_s, draw.scene.duration_s.max(1e-3));
        Box::new(ScaleDrift { ppm: draw.spread(), start_s, duration_s })
    },
};

#[derive(Debug, Clone)]
struct ScaleDrift {
    ppm: Vector3<f64>,
    start_s: f64,
    duration_s: f64,
}

impl Model for ScaleDrift {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        let share = (at.t_s - self.start_s) / self.duration_s - 0.5;
        signal.angular_rate_rad_s += self.ppm.component_mul(&at.ideal.angular_rate_rad_s) * (PPM * share);
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("over_the_recording", &self.ppm, "ppm")
    }
}
