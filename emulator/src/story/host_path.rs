//! The host's tool on the samples that the board had: the same arithmetic, so the same numbers to the last bit.

use tumble::calibrate::Session;
use tumble::recording::Reading;
use tumble_core::estimate::Conditions;
use tumble_core::frame::RawFrame;
use tumble_core::sample::Ranges;

use super::frames::Frames;
use super::line::Line;
use super::parameters::{Parameter, Parameters};

/// The raw frames of the session in `lines`. Frames and lines come from one task in one order, so they are the very
/// samples the session had; none if one is missing or damaged.
#[must_use]
pub fn session_frames(lines: &[Line], frames: &Frames) -> Option<Vec<RawFrame>> {
    let place = |pattern: &str| Some(lines.iter().find(|line| line.says(pattern))?.after_raw_frames);
    let (first, end) = (place("@ok command=calibrate")?, place("@busy what=estimate")?);
    let session: Vec<RawFrame> = frames.raw.get(first..end)?.iter().map(|(_, frame)| *frame).collect();
    let whole = session.windows(2).all(|pair| pair[1].seq == pair[0].seq.wrapping_add(1));
    (whole && frames.damaged.is_empty()).then_some(session)
}

/// What `tumble calibrate` makes of them, as the board would say it.
#[must_use]
pub fn compute(frames: &[RawFrame], conditions: Conditions) -> Option<Parameters> {
    let reading = |frame: &RawFrame| Reading {
        sample: Ranges::WIDEST.to_si(frame.t_us, &frame.counts),
        clipped: frame.counts.clipped(),
    };
    let readings: Vec<Reading> = frames.iter().map(reading).collect();
    let outcome = Session { readings: &readings, origin_s: 0.0, lost: 0, conditions }.replay(&mut |_| {});
    let calibration = outcome.calibration?;
    let parameters = calibration.parameters().map(|parameter| Parameter {
        name: parameter.name.to_owned(),
        value: parameter.observable.then_some(parameter.value),
        sigma: parameter.sigma.filter(|_| parameter.observable),
        unit: parameter.unit.to_owned(),
        observable: parameter.observable,
    });
    Some(Parameters(parameters.collect()))
}
