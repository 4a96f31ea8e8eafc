//! Errors against truth and against their own sigmas, over many sessions.

use std::collections::BTreeMap;

use tumble_core::calibration::TriadEstimate;
use tumble_core::estimate::two_step::{Outcome, Variant, estimate};
use tumble_sim::SchemeConfig;

use crate::session::{FENCED, SessionTape, Truth, session};

/// Sums over one kind of parameter.
#[derive(Clone, Copy, Default)]
pub struct Group {
    squares: f64,
    variances: f64,
    normalised: f64,
    count: f64,
}

impl Group {
    fn add(&mut self, error: f64, sigma: f64) {
        self.squares += error * error;
        self.variances += sigma * sigma;
        self.normalised += (error / sigma).powi(2);
        self.count += 1.0;
    }

    /// Of the errors.
    pub fn rms(&self) -> f64 {
        (self.squares / self.count).sqrt()
    }

    /// Rms of the stated sigmas.
    pub fn sigma(&self) -> f64 {
        (self.variances / self.count).sqrt()
    }

    /// Mean of (error over sigma) squared: 1 if the sigmas are true.
    pub fn z2(&self) -> f64 {
        self.normalised / self.count
    }
}

/// Groups by name.
pub type Groups = BTreeMap<&'static str, Group>;

/// Estimates `seeds` sessions in `f64`.
pub fn study(config: impl Fn(u64) -> SchemeConfig, seeds: u64, variant: Variant) -> Groups {
    let mut groups = Groups::new();
    for seed in 1..=seeds {
        let (tape, truth) = session(&config(seed));
        take(&mut groups, &run(&tape, variant), &truth);
    }
    groups
}

/// One session in `f64`.
pub fn run(tape: &SessionTape, variant: Variant) -> Outcome<f64> {
    estimate(tape, &FENCED, variant).expect("a whole session")
}

fn take(groups: &mut Groups, outcome: &Outcome<f64>, truth: &Truth) {
    let closed = outcome.first.gyroscope().expect("regular");
    triad(
        groups,
        ["accel bias", "accel scale", "accel cross"],
        &outcome.calibration.accelerometer,
        |i| truth.accel_bias[i],
        |i, j| truth.accel[(i, j)],
    );
    let names = ["gyro bias", "gyro scale", "K"];
    triad(groups, names, &outcome.calibration.gyroscope, |i| truth.gyro_bias[i], |i, j| truth.gyro[(i, j)]);
    let names = ["gyro bias", "gyro scale by closed form", "K by closed form"];
    triad(groups, names, &closed, |i| truth.gyro_bias[i], |i, j| truth.gyro[(i, j)]);
    groups.entry("nis").or_default().add(outcome.nis_per_dof.sqrt(), 1.0);
}

fn triad(
    groups: &mut Groups,
    [bias, scale, cross]: [&'static str; 3],
    estimate: &TriadEstimate,
    true_bias: impl Fn(usize) -> f64,
    truth: impl Fn(usize, usize) -> f64,
) {
    for i in 0..3 {
        let error = f64::from(estimate.triad.bias[i]) - true_bias(i);
        groups.entry(bias).or_default().add(error, f64::from(estimate.bias_sigma[i]));
        for j in 0..3 {
            let error = f64::from(estimate.triad.correction[(i, j)]) - truth(i, j);
            let name = if i == j { scale } else { cross };
            groups.entry(name).or_default().add(error, f64::from(estimate.correction_sigma[(i, j)]));
        }
    }
}

/// As a table.
pub fn print(title: &str, groups: &Groups) {
    println!("{title}");
    for (name, group) in groups {
        println!("  {name:25} rms {:8.1e}  sigma {:8.1e}  z² {:8.2}", group.rms(), group.sigma(), group.z2());
    }
}
