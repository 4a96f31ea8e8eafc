//! What the sizes of effects that were taken out of the readings leave uncertain of a calibration.
//!
//! Were the sizes exact, the numbers would have the covariance P that the estimator says. They have Σ, and the numbers follow them by J:
//! `P + J Σ Jᵀ`. J is taken from the estimator itself: the session once more for each principal axis of Σ, the effects larger by one
//! sigma. A scale that follows temperature, seen on an axis that was turned within one minute, is known to 0.3 %/K, and where that minute was
//! 1 K off the mean the scale at the mean is known to 0.3 %: without this its sigma was a tenth of that.

use nalgebra::{SMatrix, SVector};
use tumble_core::calibration::{Calibration, TriadEstimate, Verdict};
use tumble_core::estimate::PARAMETERS;

use crate::calibrate::{Method, Outcome, Session};
use crate::diagnose::carry::Carry;
use crate::output::covariance_order;

/// How many times as uncertain a number must be for a person to be told.
const TOLD: f32 = 2.0;

type Numbers = SVector<f32, PARAMETERS>;

/// Adds it to the outcome of a session whose readings have the effects taken out; `progress` hears which share is done.
pub fn widen(carry: &Carry, session: &Session, method: Method, outcome: &mut Outcome, mut progress: impl FnMut(f32)) {
    let Some(calibration) = outcome.calibration.filter(|_| outcome.verdict != Verdict::Rejected) else { return };
    // The batch follows the readings as the board does, which takes a tenth of its time.
    let (method, base) = match method {
        Method::Batch => (Method::Device, session.replay(&mut |_| {}).calibration.unwrap_or(calibration)),
        _ => (method, calibration),
    };
    let doubts = carry.doubtful(session.readings);
    let count = doubts.len();
    let mut widened = SMatrix::<f32, PARAMETERS, PARAMETERS>::zeros();
    for (k, readings) in doubts.enumerate() {
        let doubtful = Session { readings: &readings, ..*session };
        let other = doubtful.run(method, &mut |_| {}).calibration;
        let Some(other) = other.filter(|other| other.frame == base.frame) else {
            return outcome.warn(
                "What is uncertain of the effects carried is not in the sigmas: with one sigma more of it the recording is calibrated \
                 otherwise, or not at all."
                    .into(),
            );
        };
        let shift = numbers(&other) - numbers(&base);
        widened += shift * shift.transpose();
        progress((k + 1) as f32 / count as f32);
    }
    if let Some(covariance) = &mut outcome.covariance {
        *covariance += widened;
    }
    let told = add(outcome, calibration, &widened.diagonal());
    if !told.is_empty() {
        let ids: Vec<&str> = carry.effects.iter().map(|carried| carried.id.as_str()).collect();
        outcome.warn(format!(
            "What is uncertain of {} more than doubles the sigmas of {}, which have it. Turn on every face both early and late in the session: then \
             what it follows differs within each.",
            ids.join(" with "),
            told.join(", ")
        ));
    }
}

/// Variances to the sigmas; the names of what is far less sure than it was.
fn add(outcome: &mut Outcome, mut calibration: Calibration, widened: &Numbers) -> Vec<String> {
    let before = sigmas(&calibration);
    for (triad, first) in [(&mut calibration.accelerometer, 0), (&mut calibration.gyroscope, PARAMETERS / 2)] {
        for axis in 0..3 {
            triad.bias_sigma[axis] = triad.bias_sigma[axis].hypot(widened[first + axis].sqrt());
            for other in 0..3 {
                let sigma = &mut triad.correction_sigma[(axis, other)];
                *sigma = sigma.hypot(widened[first + 3 + 3 * axis + other].sqrt());
            }
        }
    }
    let after = sigmas(&calibration);
    outcome.calibration = Some(calibration);
    let names = covariance_order().into_iter().zip(before.iter().zip(&after));
    names.filter(|(_, (before, after))| **after > TOLD * **before).map(|(name, _)| name).collect()
}

/// In the order of [`covariance_order`]; zero for what the recording does not determine.
fn numbers(calibration: &Calibration) -> Numbers {
    in_order(calibration, |triad| (triad.triad.bias, triad.triad.correction))
}

fn sigmas(calibration: &Calibration) -> Numbers {
    in_order(calibration, |triad| (triad.bias_sigma, triad.correction_sigma))
}

fn in_order(
    calibration: &Calibration,
    of: impl Fn(&TriadEstimate) -> (nalgebra::Vector3<f32>, nalgebra::Matrix3<f32>),
) -> Numbers {
    let triads = [&calibration.accelerometer, &calibration.gyroscope];
    let all = triads.into_iter().flat_map(|triad| {
        let (bias, matrix) = of(triad);
        let element = |k: usize| if triad.observable[k / 3][k % 3] { matrix[(k / 3, k % 3)] } else { 0.0 };
        bias.iter().copied().chain((0..9).map(element)).collect::<Vec<f32>>()
    });
    Numbers::from_iterator(all)
}
