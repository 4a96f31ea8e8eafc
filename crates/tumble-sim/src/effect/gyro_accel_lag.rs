//! The accelerometer reports later than the gyro.
//!
//! `f_raw(t) = f(t − τ)`, with the gyro on time. The register map gives the accelerometer's filter 4.88 ms in one place
//! and 11.8 ms in another, the gyro's 5.9 ms; two chips on two buses lag by up to 20 ms.
//!
//! Magnitude: `τ`, ms. A real recording's accelerometer is shifted by straight lines between its samples.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "gyro_accel_lag",
    name: "accelerometer lags behind the gyro",
    meaning: "by how much later the accelerometer's samples were taken",
    unit: "ms",
    default: 10.0,
    values: Values::Range(0.0, 200.0),
    draws: (6.0, 25.0),
    source: "4.88 or 11.8 ms against 5.9 ms (MPU-9250 register map)",
    injects: true,
    make: |draw| Box::new(Lag { ms: draw.magnitude }),
};

#[derive(Debug, Clone)]
struct Lag {
    ms: f64,
}

impl Model for Lag {
    fn prepare(&mut self, config: &mut WorldConfig) {
        config.sensor.delay.accel_s += self.ms * 1e-3;
    }

    fn shift(&self, samples: &mut [Sample]) {
        let old: Vec<(f64, Vector3<f64>)> = samples.iter().map(|s| (s.t_s, s.specific_force_mps2)).collect();
        for sample in samples.iter_mut() {
            let wanted_s = sample.t_s - self.ms * 1e-3;
            let after = old.partition_point(|(t_s, _)| *t_s <= wanted_s);
            // Before the first sample there is nothing to take: it stands for what was.
            sample.specific_force_mps2 = match (after.checked_sub(1).and_then(|i| old.get(i)), old.get(after)) {
                (Some((t0, f0)), Some((t1, f1))) => f0 + (f1 - f0) * ((wanted_s - t0) / (t1 - t0)),
                (Some((_, force)), None) | (None, Some((_, force))) => *force,
                (None, None) => sample.specific_force_mps2,
            };
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::new("lag", self.ms, "ms")]
    }
}
