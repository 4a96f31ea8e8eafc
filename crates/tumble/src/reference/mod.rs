//! References in `f64`, from the samples themselves: what the device's `f32` passes over decimated sums are held against.

pub mod batch;
pub mod data;
pub mod gravity;
pub mod solve;

use nalgebra::{Matrix3, SMatrix, Vector3};
use tumble_core::calibration::{Calibration, Fit, Frame, Triad, TriadEstimate};
use tumble_core::estimate::sums::SegmentNoise;
use tumble_core::estimate::{Conditions, Estimate, PARAMETERS};
use tumble_core::tape::Exclusion;

use crate::recording::Reading;
use crate::settle::HostTape;
use data::Stretch;
use gravity::Fitted;

/// Of the 24 numbers, in the device's order.
pub type Covariance = SMatrix<f32, PARAMETERS, PARAMETERS>;

/// Prior of a correction's element, the device's (`docs/method.md`, "Priors and observability"), 1.
pub const CORRECTION_SIGMA: f64 = 0.06;
/// Prior of an accelerometer bias, the device's, m/s².
pub const ACCEL_BIAS_SIGMA: f64 = 0.8;

/// The segments of a tape with their samples, less what the device found the gyroscope to feel of force and with the bias that it had at
/// the end: neither reference fits these anew.
fn plain(tape: &HostTape, readings: &[Reading], device: &Calibration) -> Vec<Stretch> {
    let mut readings = readings.to_vec();
    if let Some(felt) = device.g_sensitivity {
        for Reading { sample, .. } in &mut readings {
            let force = device.accelerometer.triad.compensate(&sample.specific_force_mps2);
            sample.angular_rate_rad_s -= felt.matrix * force;
        }
    }
    let mut stretches = data::stretches(tape.segments(), &readings);
    for jumped in 0..stretches.len() {
        let (before, after) = stretches.split_at_mut(jumped + 1);
        let rests = before.iter().rfind(|one| one.is_rest()).zip(after.iter().find(|one| one.is_rest()));
        if let Some((from, to)) = rests.filter(|_| before[jumped].segment.exclusion == Exclusion::BiasJump) {
            let by = to.mean_rate - from.mean_rate;
            before.iter_mut().for_each(|stretch| stretch.shift(&by));
        }
    }
    stretches
}

/// [`batch::estimate`] over the segments of a tape.
pub fn batch(
    tape: &HostTape,
    readings: &[Reading],
    conditions: &Conditions,
    start: &Estimate,
    noise: &[SegmentNoise],
) -> Option<(Calibration, Covariance)> {
    let stretches = plain(tape, readings, &start.calibration);
    let batch = batch::estimate(&stretches, conditions, start, noise, batch::MeanNoise::Exact)?;
    let fit = fit(&stretches, &batch.accel, conditions, &start.calibration.fit, batch.chi_square_per_dof as f32);
    let found = calibration([&batch.accel, &batch.gyro], conditions.frame(), fit, &start.calibration);
    Some((found, batch.covariance.cast()))
}

/// [`gravity::estimate`] likewise; it has no residuals that would be comparable with the others'.
pub fn gravity(
    tape: &HostTape,
    readings: &[Reading],
    conditions: &Conditions,
    start: &Estimate,
) -> Option<(Calibration, Covariance)> {
    let stretches = plain(tape, readings, &start.calibration);
    let (accel, gyro) = gravity::estimate(&stretches, conditions, &start.noise)?;
    let fit = fit(&stretches, &accel, conditions, &start.calibration.fit, f32::NAN);
    let found = calibration([&accel, &gyro], Frame::Accelerometer, fit, &start.calibration);
    // The two fits follow each other: nothing is said of how their errors go together.
    let mut covariance = Covariance::zeros();
    covariance.fixed_view_mut::<12, 12>(0, 0).copy_from(&accel.covariance.cast());
    covariance.fixed_view_mut::<12, 12>(12, 12).copy_from(&gyro.covariance.cast());
    Some((found, covariance))
}

fn calibration([accel, gyro]: [&Fitted; 2], frame: Frame, fit: Fit, device: &Calibration) -> Calibration {
    Calibration { accelerometer: triad(accel), gyroscope: triad(gyro), frame, fit, ..*device }
}

/// Not observable where the device would say so: where the data leave more than a tenth of the prior.
fn triad(fitted: &Fitted) -> TriadEstimate {
    let correction_sigma: Matrix3<f32> = fitted.correction_sigma.cast();
    let limit = 0.1 * CORRECTION_SIGMA as f32;
    TriadEstimate {
        triad: Triad { bias: fitted.bias.cast(), correction: fitted.correction.cast() },
        bias_sigma: fitted.bias_sigma.cast(),
        correction_sigma,
        observable: std::array::from_fn(|i| std::array::from_fn(|j| correction_sigma[(i, j)] < limit)),
    }
}

fn fit(stretches: &[Stretch], accel: &Fitted, conditions: &Conditions, device: &Fit, nis_per_dof: f32) -> Fit {
    let gravity = f64::from(conditions.gravity_mps2);
    let force = |rest: &Stretch| -> Vector3<f64> { accel.correction * (rest.mean_force - accel.bias) };
    let errors: Vec<f64> =
        stretches.iter().filter(|stretch| stretch.is_rest()).map(|rest| force(rest).norm() - gravity).collect();
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    Fit {
        nis_per_dof,
        gravity_rms_mps2: (squares / errors.len().max(1) as f64).sqrt() as f32,
        gravity_max_mps2: errors.iter().fold(0.0f64, |most, error| most.max(error.abs())) as f32,
        ..*device
    }
}
