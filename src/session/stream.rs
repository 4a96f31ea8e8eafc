//! Frames for whoever asked, and the measured rate.

use tumble_core::command::StreamKind;
use tumble_core::frame::{CompensatedFrame, RawFrame};
use tumble_core::record::Record;
use tumble_core::sample::Sample;

use crate::console;
use crate::shared::{FRAMES_DROPPED, Stamped};

/// What the sensor is set to, until it is measured.
const NOMINAL_RATE_HZ: f32 = 200.0;

/// What is streamed, and since when the rate is measured.
pub struct Stream {
    /// What is streamed.
    pub kind: StreamKind,
    /// Sequence number and time of the first and the latest sample of an unbroken run.
    run: Option<[(u32, u64); 2]>,
}

impl Default for Stream {
    fn default() -> Self {
        Self { kind: StreamKind::Off, run: None }
    }
}

impl Stream {
    /// Sends a frame if one is wanted.
    pub fn sample(&mut self, stamped: &Stamped, sample: &Sample, in_force: Option<&Record>) {
        let &Stamped { seq, t_us, counts } = stamped;
        let run = self.run.get_or_insert([(seq, t_us); 2]);
        run[1] = (seq, t_us);
        match (self.kind, in_force) {
            (StreamKind::Raw, _) => console::try_write_frame(&RawFrame { seq, t_us, counts }.line()),
            (StreamKind::Cal, Some(record)) => {
                match CompensatedFrame::new(seq, &record.calibration.calibration().compensate(sample)) {
                    Some(frame) => console::try_write_frame(&frame.line()),
                    None => FRAMES_DROPPED.add(1),
                }
            }
            (StreamKind::Cal, None) | (StreamKind::Off, _) => {}
        }
    }

    /// The samples have stopped; the next ones begin a new run.
    pub fn interrupted(&mut self) {
        self.run = None;
    }

    /// By the crystal, over the present run; none before there is one.
    pub fn measured_rate_hz(&self) -> Option<f32> {
        let [(first, from_us), (last, to_us)] = self.run?;
        (to_us > from_us).then(|| last.wrapping_sub(first) as f32 / ((to_us - from_us) as f32 * 1e-6))
    }

    /// As measured, or as set.
    pub fn rate_hz(&self) -> f32 {
        self.measured_rate_hz().unwrap_or(NOMINAL_RATE_HZ)
    }
}
