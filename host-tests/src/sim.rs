//! Simulated sessions through the device's own code, and their errors against the truth.

use tumble::settle;
use tumble::study::trial::readings;
use tumble_core::estimate::{Conditions, Estimate, PARAMETERS};
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_core::tape::Tape;
use tumble_sim::SchemeConfig;
use tumble_sim::sensor::FrameTruth;

/// Room for more than the board has: long schemes are tested too.
pub type Memory = Tape<8192, 256>;

/// What was estimated and what is true, in the same frame.
pub struct Session {
    /// The estimate.
    pub estimate: Estimate,
    /// Its tape.
    pub tape: Box<Memory>,
    /// The truth in the estimate's frame.
    pub truth: FrameTruth,
}

/// One number against the truth.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// Name as in `docs/protocol.md`.
    pub name: &'static str,
    /// Estimate less truth.
    pub error: f64,
    /// What the estimate says of it.
    pub sigma: f64,
}

/// Records a scheme onto a tape.
pub fn record(config: &SchemeConfig) -> (Box<Memory>, tumble_sim::Truth) {
    let recording = config.record().expect("a valid configuration");
    let mut tape = Box::new(Memory::new());
    settle::record(&readings(&recording.samples), 1.0, &mut tape);
    (tape, recording.truth)
}

/// Runs the estimator over a scheme.
pub fn session(config: &SchemeConfig, stops: TurnStops, faces: BoxFaces) -> Session {
    let (tape, truth) = record(config);
    let conditions = Conditions { stops, faces, gravity_mps2: config.world.gravity_mps2 as f32 };
    let (estimate, _) = settle::estimate(&tape, conditions, &mut |_| {}).expect("the arithmetic holds");
    let truth = if faces == BoxFaces::Square { truth.in_box } else { truth.in_accelerometer_frame };
    Session { estimate, tape, truth }
}

impl Session {
    /// Every number with a sigma.
    pub fn deviations(&self) -> Vec<Deviation> {
        self.estimate
            .calibration
            .parameters()
            .zip(self.truths())
            .filter_map(|(parameter, truth)| {
                let sigma = f64::from(parameter.sigma.filter(|sigma| *sigma > 0.0)?);
                Some(Deviation { name: parameter.name, error: f64::from(parameter.value) - truth, sigma })
            })
            .collect()
    }

    /// Errors of all numbers, in the order of the covariance.
    pub fn errors(&self) -> Vec<f64> {
        let values = self.estimate.calibration.parameters().map(|parameter| f64::from(parameter.value));
        values.zip(self.truths()).take(PARAMETERS).map(|(value, truth)| value - truth).collect()
    }

    /// Of all parameters that a calibration can have; nobody asks for the temperature's.
    fn truths(&self) -> impl Iterator<Item = f64> + '_ {
        let (accel, gyro) = (&self.truth.accelerometer, &self.truth.gyroscope);
        let truths = accel.bias_mps2.iter().chain(accel.correction.iter().flatten());
        let felt = gyro.g_sensitivity_rad_s_per_mps2.unwrap_or_default().into_iter().flatten();
        let numbers = truths.chain(&gyro.bias_rad_s).chain(gyro.correction.iter().flatten()).copied();
        numbers.chain([f64::NAN]).chain(felt)
    }
}

/// Root mean square of errors whose name passes, and the mean of their squares over sigma squared.
pub fn spread(deviations: &[Deviation], which: impl Fn(&str) -> bool) -> (f64, f64) {
    let chosen: Vec<_> = deviations.iter().filter(|deviation| which(deviation.name)).collect();
    let mean = |f: fn(&Deviation) -> f64| chosen.iter().map(|d| f(d)).sum::<f64>() / chosen.len() as f64;
    (mean(|d| d.error * d.error).sqrt(), mean(|d| (d.error / d.sigma).powi(2)))
}

/// `gyro_correction_xx` and so on.
pub fn is_gyro_scale(name: &str) -> bool {
    name.strip_prefix("gyro_correction_").is_some_and(|ij| ij.as_bytes()[0] == ij.as_bytes()[1])
}

/// `gyro_correction_xy` and so on.
pub fn is_gyro_cross(name: &str) -> bool {
    name.starts_with("gyro_correction_") && !is_gyro_scale(name)
}
