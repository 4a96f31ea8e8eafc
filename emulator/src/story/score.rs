//! Truth against estimate, parameter by parameter.

use nalgebra::{Matrix3, Vector3};
use tumble_sim::STANDARD_GRAVITY_MPS2;
use tumble_sim::sensor::FrameTruth;

use super::parameters::{AXES, Parameters, Sensor};

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    pub name: String,
    pub unit: String,
    pub truth: f64,
    /// Estimate and sigma, if the board gave both.
    pub estimate: Option<(f64, f64)>,
}

impl Row {
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        self.estimate.map(|(value, _)| value - self.truth)
    }

    #[must_use]
    pub fn sigmas(&self) -> Option<f64> {
        self.estimate.map(|(value, sigma)| (value - self.truth) / sigma)
    }
}

/// Accelerometer's 12, gyroscope's 12, and 9 of its sensitivity to force where there is one or the board says one.
#[derive(Debug, Clone, PartialEq)]
pub struct Score(pub Vec<Row>);

/// Root mean squares over the axes or elements; NaN where an estimate is missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rms {
    pub gyro_bias_mdps: f64,
    pub gyro_scale_ppm: f64,
    pub gyro_cross_urad: f64,
    pub accel_bias_ug: f64,
    pub accel_scale_ppm: f64,
    pub accel_cross_urad: f64,
}

impl Score {
    #[must_use]
    pub fn new(truth: &FrameTruth, parameters: &Parameters) -> Self {
        let accel = (&truth.accelerometer.bias_mps2, &truth.accelerometer.correction);
        let gyro = (&truth.gyroscope.bias_rad_s, &truth.gyroscope.correction);
        let mut rows = Vec::new();
        for (sensor, (bias, correction)) in [(Sensor::Accelerometer, accel), (Sensor::Gyroscope, gyro)] {
            let prefix = sensor.prefix();
            let mut push = |name: String, truth: f64| {
                let parameter = parameters.get(&name);
                let estimate = parameter.and_then(|p| Some((f64::from(p.value?), f64::from(p.sigma?))));
                let unit = parameter.map_or("-".to_owned(), |parameter| parameter.unit.clone());
                rows.push(Row { name, unit, truth, estimate });
            };
            for (axis, truth) in AXES.iter().zip(bias) {
                push(format!("{prefix}_bias_{axis}"), *truth);
            }
            for (row, truths) in AXES.iter().zip(correction) {
                for (column, truth) in AXES.iter().zip(truths) {
                    push(format!("{prefix}_correction_{row}{column}"), *truth);
                }
            }
        }
        let felt = truth.gyroscope.g_sensitivity_rad_s_per_mps2;
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let name = format!("gyro_g_sensitivity_{}{}", AXES[i], AXES[j]);
            let parameter = parameters.get(&name);
            let estimate = parameter.and_then(|p| Some((f64::from(p.value?), f64::from(p.sigma?))));
            if felt.is_some() || estimate.is_some() {
                let truth = felt.map_or(0.0, |felt| felt[i][j]);
                rows.push(Row { name, unit: "s/m".to_owned(), truth, estimate });
            }
        }
        Self(rows)
    }

    /// How many lie within so many sigmas.
    #[must_use]
    pub fn within(&self, sigmas: f64) -> usize {
        self.0.iter().filter(|row| row.sigmas().is_some_and(|error| error.abs() <= sigmas)).count()
    }

    /// The parameters beyond so many sigmas, or without a number.
    #[must_use]
    pub fn beyond(&self, sigmas: f64) -> Vec<String> {
        let describe = |row: &Row| match row.sigmas() {
            Some(error) => format!("{} {error:+.1} sigma", row.name),
            None => format!("{} has no number", row.name),
        };
        let far = self.0.iter().filter(|row| row.sigmas().is_none_or(|error| error.is_nan() || error.abs() > sigmas));
        far.map(describe).collect()
    }

    /// The errors of one sensor: bias, and correction as `δC·C⁻¹` to first order, that is δC.
    fn errors(&self, first: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let error = |k: usize| self.0[first + k].error().unwrap_or(f64::NAN);
        (Vector3::from_fn(|i, _| error(i)), Matrix3::from_fn(|i, j| error(3 + 3 * i + j)))
    }

    #[must_use]
    pub fn rms(&self) -> Rms {
        let ((accel_bias, accel), (gyro_bias, gyro)) = (self.errors(0), self.errors(12));
        let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
        let diagonal = |m: &Matrix3<f64>| rms(m.diagonal().as_slice());
        let cross = |m: &Matrix3<f64>| rms(&[m.m12, m.m13, m.m21, m.m23, m.m31, m.m32]);
        Rms {
            gyro_bias_mdps: rms(gyro_bias.as_slice()).to_degrees() * 1e3,
            gyro_scale_ppm: diagonal(&gyro) * 1e6,
            gyro_cross_urad: cross(&gyro) * 1e6,
            accel_bias_ug: rms(accel_bias.as_slice()) / STANDARD_GRAVITY_MPS2 * 1e6,
            accel_scale_ppm: diagonal(&accel) * 1e6,
            accel_cross_urad: cross(&accel) * 1e6,
        }
    }

    pub fn print(&self) {
        println!(
            "\n{:<22} {:>4}  {:>12} {:>12} {:>10} {:>11} {:>7}",
            "parameter", "unit", "truth", "estimate", "sigma", "error", "sigmas"
        );
        for row in &self.0 {
            let Row { name, unit, truth, .. } = row;
            match (row.estimate, row.error(), row.sigmas()) {
                (Some((value, sigma)), Some(error), Some(sigmas)) => println!(
                    "{name:<22} {unit:>5} {truth:>12.7} {value:>12.7} {sigma:>10.7} {error:>+11.7} {sigmas:>+7.2}"
                ),
                _ => println!("{name:<22} {unit:>5} {truth:>12.7} {:>12}", "none"),
            }
        }
        let rms = self.rms();
        println!(
            "\nrms errors: gyroscope bias {:.2} m°/s, scale {:.1} ppm, non-orthogonality K {:.1} µrad",
            rms.gyro_bias_mdps, rms.gyro_scale_ppm, rms.gyro_cross_urad
        );
        println!(
            "            accelerometer bias {:.1} µg, scale {:.1} ppm, non-orthogonality {:.1} µrad",
            rms.accel_bias_ug, rms.accel_scale_ppm, rms.accel_cross_urad
        );
        println!("errors within 2 sigma: {} of {}", self.within(2.0), self.0.len());
    }
}
