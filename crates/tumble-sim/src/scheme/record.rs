//! From a scheme to samples.

use super::{Scheme, SchemeConfig, Stamps, plan};
use crate::effect::{Chain, Effect, Scene, WIDEST};
use crate::error::SimError;
use crate::sensor::{Quantisation, Sample, Truth};
use crate::world::World;
use nalgebra::Vector3;

/// Samples and, apart from them, the truth.
#[derive(Debug, Clone)]
pub struct Recording {
    /// In order of time, beginning at 0.
    pub samples: Vec<Sample>,
    /// What a recorder would say its rate is, Hz.
    pub rate_hz: f64,
    /// The parameters, averaged over the recording.
    pub truth: Truth,
    /// For a test's eyes only: true attitudes, moves, turns.
    pub world: World,
}

impl SchemeConfig {
    /// Makes the recording.
    ///
    /// # Errors
    /// If a setting is out of its range; it is named.
    pub fn record(&self) -> Result<Recording, SimError> {
        self.check()?;
        let mut config = self.clone();
        let mut chain = Effect::chain(&self.effects, self.scene(), self.world.seed);
        chain.prepare(&mut config.world);
        let mut world = World::new(&config.world)?;
        chain.before(&mut world);
        let end_s = plan::queue(&config, &mut world);
        chain.after(&mut world);
        let samples = config.samples(&mut world, &mut chain, end_s);
        let mut samples = averaged(samples, config.averaged, config.world.sensor.quantisation);
        let mut truth = world.truth()?;
        chain.stream(&mut samples, &self.scene().ranges);
        truth.effects = chain.truths();
        let rate_hz = chain.rate_hz().unwrap_or(self.scene().rate_hz);
        Ok(Recording { samples, rate_hz, truth, world })
    }

    /// What the effects are drawn for.
    pub(super) fn scene(&self) -> Scene {
        Scene {
            start_s: 0.0,
            duration_s: self.duration_s(),
            rate_hz: self.world.sensor.rate_hz / self.averaged.max(1) as f64,
            ranges: self.world.sensor.quantisation.unwrap_or(WIDEST),
        }
    }

    fn samples(&self, world: &mut World, chain: &mut Chain, end_s: f64) -> Vec<Sample> {
        let rate_hz = self.world.sensor.rate_hz;
        let true_rate_hz = rate_hz * (1.0 + self.clock.rate_error);
        let count = (end_s * true_rate_hz).floor() as usize + 1;
        let sample = |k: usize| {
            let sample = world.sample_through(k as f64 / true_rate_hz, chain);
            match self.clock.stamps {
                Stamps::True => sample,
                Stamps::Nominal => Sample { t_s: k as f64 / rate_hz, ..sample },
            }
        };
        (0..count).map(sample).collect()
    }

    fn check(&self) -> Result<(), SimError> {
        let timing = &self.timing;
        for (name, value) in [
            ("start_rest_s", timing.start_rest_s),
            ("still_s", timing.still_s),
            ("turn_s", timing.turn_s),
            ("move_s", timing.move_s),
        ] {
            SimError::check(name, value, |v| (0.0..=3600.0).contains(&v), "0 to 3600 s")?;
        }
        if let Scheme::Tumble { duration_s, violence } = self.scheme {
            SimError::check("tumble.duration_s", duration_s, |v| (0.0..=3600.0).contains(&v), "0 to 3600 s")?;
            SimError::check("tumble.violence", violence, |v| (0.0..=5.0).contains(&v), "0 to 5")?;
        }
        SimError::check("averaged", self.averaged as f64, |v| (1.0..=1000.0).contains(&v), "1 to 1000")?;
        SimError::check("clock.rate_error", self.clock.rate_error, |v| v.abs() < 0.5, "below 0.5")
    }
}

/// The mean of the samples within half of `every` of each `every`-th one, under its stamp, rounded as the recorder
/// rounds.
fn averaged(samples: Vec<Sample>, every: usize, ranges: Option<Quantisation>) -> Vec<Sample> {
    if every <= 1 {
        return samples;
    }
    let mean = |k: usize| {
        let near = &samples[k.saturating_sub(every / 2)..(k + every.div_ceil(2)).min(samples.len())];
        let share = 1.0 / near.len() as f64;
        let rate = near.iter().map(|s| s.angular_rate_rad_s).sum::<Vector3<f64>>() * share;
        let force = near.iter().map(|s| s.specific_force_mps2).sum::<Vector3<f64>>() * share;
        Sample {
            t_s: samples[k].t_s,
            angular_rate_rad_s: ranges.map_or(rate, |ranges| ranges.gyro(&rate)),
            specific_force_mps2: ranges.map_or(force, |ranges| ranges.accel(&force)),
            temperature_degc: samples[k].temperature_degc,
        }
    };
    (0..samples.len()).step_by(every).map(mean).collect()
}
