//! From a recording to its twin.

use tumble_core::estimate::sums::SegmentNoise;
use tumble_core::estimate::{self, Conditions, Estimate, start};
use tumble_core::tape::Segment;

use super::twin::Twin;
use super::twin::data::{Arrival, Raw, stretches};
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
    let found = settled.estimate.as_ref().ok().map(|(estimate, _)| estimate);
    let gravity = conditions.gravity_mps2;
    let device_noise = match found {
        Some(estimate) => estimate.noise,
        None => estimate::Noise::from_rests(tape, conditions.stops, conditions.faces),
    };
    let start = match found {
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
    let arrivals = arrivals(settled, &device_noise, f64::from(gravity), masked);
    let twin = Twin::new(samples, stretches, start, (noise, arrivals), &conditions);
    Ok(Prepared { twin })
}

/// How the device saw moves end, with what a walk of unit density makes of each (`estimate/walk/still.rs`), all over what its gyroscope at
/// rest would make of the move.
fn arrivals(settled: &Settled, noise: &estimate::Noise, gravity_mps2: f64, masked: &[usize]) -> Vec<Arrival> {
    let segments = settled.tape.segments();
    let seconds = |number: usize| segments.get(number).map_or(0.0, |segment| f64::from(segment.duration_s()));
    let (from_us, to_us) = (segments.first().map_or(0, |s| s.start_us), segments.last().map_or(0, |s| s.end_us));
    let session_s = (to_us - from_us) as f64 * 1e-6;
    let found = settled.estimate.iter().flat_map(|(_, segments)| segments).enumerate();
    let kept = found.filter(|(number, _)| !masked.contains(number));
    let arrival = |(number, found): (usize, &SegmentNoise)| {
        let hinge = found.hinge?;
        let (move_s, moved) = (seconds(number), f64::from(noise.rate_density) * seconds(number));
        let apart_s = if hinge.in_hand { session_s } else { move_s + seconds(number + 1) };
        Some(Arrival {
            hinge,
            by_bias_walk: session_s / 6.0 * move_s * move_s / moved,
            by_force_walk: apart_s / (gravity_mps2 * gravity_mps2) / moved,
        })
    };
    kept.filter_map(arrival).collect()
}
