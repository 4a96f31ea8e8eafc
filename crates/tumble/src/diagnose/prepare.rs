//! From a recording to its twin.

use tumble_core::estimate::{Conditions, Estimate, start};
use tumble_core::tape::Segment;

use super::twin::Twin;
use super::twin::data::{Raw, stretches};
use super::twin::edges;
use super::twin::noise::Noise;
use super::twin::trajectory::Nominal;

use crate::settle::Settled;

/// Why there is no twin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoTwin(pub String);

/// What a recording came to through the board's segmenter and estimator.
pub struct Prepared {
    /// Starts from the board's result.
    pub twin: Twin,
}

/// From samples, and from what the same samples settled into as the estimator takes them; segments in `masked` are
/// left out and lose attitude.
///
/// # Errors
/// If there is nothing to estimate from, or the arithmetic breaks down: in words.
pub fn prepare(
    samples: Vec<Raw>,
    settled: &Settled,
    conditions: Conditions,
    masked: &[usize],
) -> Result<Prepared, NoTwin> {
    let tape = &settled.tape;
    if !tape.segments().iter().any(Segment::is_usable_still) {
        return Err(NoTwin("no rest was found: hold the sensor still for two seconds now and then".into()));
    }
    // The board's result is the better start; where it has none, the closed form is near enough for a fit in `f64`.
    let estimate = settled.estimate.as_ref().ok().map(|(estimate, _)| estimate);
    let gravity = conditions.gravity_mps2;
    let device_noise = match estimate {
        Some(estimate) => estimate.noise,
        None => tumble_core::estimate::Noise::from_rests(tape, conditions.stops, conditions.faces),
    };
    let start = match estimate {
        Some(Estimate { calibration, .. }) => {
            Nominal::new(&calibration.gyroscope.triad, &calibration.accelerometer.triad)
        }
        None => {
            let start = start::nominal(tape, gravity);
            Nominal::new(&start.gyro, &start.accel)
        }
    };
    let mut stretches = stretches(tape.segments(), &samples, &device_noise);
    edges::refine(&mut stretches, &samples);
    for stretch in stretches.iter_mut().filter(|stretch| masked.contains(&stretch.number)) {
        (stretch.broken, stretch.excluded) = (true, true);
    }
    let noise = Noise::new(&device_noise, conditions.stops);
    let segments = settled.estimate.iter().flat_map(|(_, segments)| segments).enumerate();
    let kept = segments.filter(|(number, _)| !masked.contains(number));
    let hinges = kept.filter_map(|(_, segment)| segment.hinge).collect();
    let twin = Twin::new(samples, stretches, start, (noise, hinges), &conditions);
    Ok(Prepared { twin })
}
