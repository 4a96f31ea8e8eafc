//! A short recording with and without an effect.

use nalgebra::Vector3;
use tumble_sim::scheme::Recording;
use tumble_sim::sensor::Noise;
use tumble_sim::{Effect, Sample, Scheme, SchemeConfig};

pub const G: f64 = 9.80665;

/// Six faces with a turn both ways on each, in 57 s.
pub fn short(seed: u64) -> SchemeConfig {
    let mut config = SchemeConfig::new(Scheme::Double, seed);
    config.timing.still_s = 0.6;
    config.timing.turn_s = 3.0;
    config.timing.move_s = 2.0;
    config
}

pub struct Pair {
    pub with: Recording,
    pub without: Recording,
}

impl Pair {
    /// Without noise, so that the difference is the effect and nothing else.
    pub fn quiet(word: &str) -> Self {
        let mut config = short(11);
        config.world.sensor.noise = Noise::NONE;
        Self::of(config, word)
    }

    pub fn of(mut config: SchemeConfig, word: &str) -> Self {
        let without = config.record().unwrap();
        config.effects = vec![Effect::parse(word).unwrap()];
        Self { with: config.record().unwrap(), without }
    }

    pub fn samples(&self) -> impl Iterator<Item = (&Sample, &Sample)> {
        self.with.samples.iter().zip(&self.without.samples)
    }

    /// Time, what it adds to the rate (rad/s) and to the force (m/s²).
    pub fn added(&self) -> impl Iterator<Item = (f64, Vector3<f64>, Vector3<f64>)> {
        self.samples().map(|(with, without)| {
            let rate = with.angular_rate_rad_s - without.angular_rate_rad_s;
            (with.t_s, rate, with.specific_force_mps2 - without.specific_force_mps2)
        })
    }

    pub fn parameter(&self, name: &str) -> f64 {
        let all = &self.with.truth.effects[0].parameters;
        all.iter().find(|one| one.name == name).unwrap_or_else(|| panic!("{name} in {all:?}")).value
    }

    pub fn vector(&self, name: &str) -> Vector3<f64> {
        Vector3::new(
            self.parameter(&format!("{name}_x")),
            self.parameter(&format!("{name}_y")),
            self.parameter(&format!("{name}_z")),
        )
    }

    /// The largest difference of what is added from what these say, rad/s and m/s².
    pub fn check(&self, rate: impl Fn(f64) -> Vector3<f64>, force: impl Fn(f64) -> Vector3<f64>) {
        for (t_s, rate_added, force_added) in self.added() {
            assert!((rate_added - rate(t_s)).norm() < 1e-9, "rate at {t_s}: {rate_added} for {}", rate(t_s));
            assert!((force_added - force(t_s)).norm() < 1e-9, "force at {t_s}: {force_added} for {}", force(t_s));
        }
    }
}

pub fn none(_: f64) -> Vector3<f64> {
    Vector3::zeros()
}

/// °/s to rad/s.
pub fn dps(value: f64) -> f64 {
    value.to_radians()
}

/// mg to m/s².
pub fn mg(value: f64) -> f64 {
    value * 1e-3 * G
}
