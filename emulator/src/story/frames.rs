//! Stream frames as they come, damage and gaps counted.

use tumble_core::frame::{CompensatedFrame, Frame, RawFrame};

use super::line::Line;

#[derive(Debug, Clone, Default)]
pub struct Frames {
    /// With the board time at which each had come.
    pub raw: Vec<(f64, RawFrame)>,
    pub compensated: Vec<(f64, CompensatedFrame)>,
    /// Lines that are no whole frame, and why.
    pub damaged: Vec<String>,
}

impl Frames {
    pub fn take_in(&mut self, line: &Line) {
        match Frame::parse(&line.text) {
            Ok(Frame::Raw(frame)) => self.raw.push((line.t_s, frame)),
            Ok(Frame::Compensated(frame)) => self.compensated.push((line.t_s, frame)),
            Err(error) => self.damaged.push(format!("{}: {error}", line.text)),
        }
    }

    /// Samples that are missing between the frames of either kind, by their numbers.
    #[must_use]
    pub fn lost(&self) -> u64 {
        missing(self.raw.iter().map(|(_, frame)| frame.seq))
            + missing(self.compensated.iter().map(|(_, frame)| frame.seq))
    }
}

fn missing(numbers: impl Iterator<Item = u32>) -> u64 {
    let numbers: Vec<u32> = numbers.collect();
    numbers.windows(2).map(|pair| u64::from(pair[1].wrapping_sub(pair[0]).wrapping_sub(1))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_counted_also_where_the_number_wraps() {
        assert_eq!(missing([7, 8, 9].into_iter()), 0);
        assert_eq!(missing([u32::MAX, 0, 3].into_iter()), 2);
        assert_eq!(missing([].into_iter()), 0);
    }
}
