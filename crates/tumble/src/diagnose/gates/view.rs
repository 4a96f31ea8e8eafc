//! What all gates need of a recording: channels, stamps, rests on something solid, noise and steps.

use std::ops::Range;

use nalgebra::Vector3;
use tumble_core::tape::{Exclusion, Kind, Segment};

use super::Scene;
use super::chance::{median, quantile};
use crate::diagnose::diagnosis::Place;

/// Names as the contract has them.
pub const CHANNELS: [&str; 6] = ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"];
/// Left out of a rest after it began, s: what a put-down shakes has died away.
const SETTLING_S: f64 = 0.3;
/// Left out of a rest before it ends, s: the segmenter's block in which motion begins.
const LEAVING_S: f64 = 0.3;
/// Rates at a rest that scatter by more are a hand's, °/s: tremor has 1 to 5, sensors 0.02 to 0.3, and a strong hum 1.
const SOLID_DPS: f64 = 1.5;
/// Blocks over which noise is taken, s: bias noise moves less in one than the white noise does.
const BLOCK_S: f64 = 0.5;

/// A rest, its ends trimmed.
#[derive(Clone, Debug)]
pub struct Rest {
    /// Samples.
    pub samples: Range<usize>,
    /// Mean, °/s.
    pub rate: Vector3<f64>,
    /// Mean, g.
    pub force: Vector3<f64>,
}

/// All of it.
pub struct View<'a> {
    /// As given.
    pub scene: &'a Scene<'a>,
    /// Since the first sample, s.
    pub t_s: Vec<f64>,
    /// Median spacing, s.
    pub dt_s: f64,
    /// °/s and g.
    pub channels: [Vec<f64>; 6],
    /// In order of time.
    pub rests: Vec<Rest>,
    /// Median over the recording, °/s: near the offset, since no axis turns most of the time.
    pub resting: Vector3<f64>,
    /// Scatter of one reading at rest, rounding included, °/s and g.
    pub sigma: [f64; 6],
    /// Least usual step between different readings; zero where readings are not rounded coarsely.
    pub step: [f64; 6],
}

/// Samples that batches are averaged over.
const RUN: usize = 32;

/// The median spacing; the mean one where samples come in batches (stamps by a host's arrival), whose own spacing is that of a bus. Lost
/// samples lengthen a run by less than half as long as most are there.
fn usual_spacing_s(t_s: &[f64]) -> f64 {
    let spacing = |over: usize| median(t_s.windows(over + 1).map(|run| (run[over] - run[0]) / over as f64).collect());
    let (single, run) = (spacing(1), spacing(RUN));
    if run > 1.5 * single { spacing(t_s.len() - 1) } else { single }
}

impl<'a> View<'a> {
    /// Looks through the recording.
    pub fn new(scene: &'a Scene<'a>) -> Self {
        let rows = &scene.recording.rows;
        let t_s: Vec<f64> = scene.samples.iter().map(|raw| raw.t_s).collect();
        let dt_s = usual_spacing_s(&t_s);
        let channels: [Vec<f64>; 6] = std::array::from_fn(|c| rows.iter().map(|row| row.channels()[c]).collect());
        let resting = Vector3::from_fn(|c, _| median(channels[c].clone()));
        let step = std::array::from_fn(|c| step(&channels[c]));
        let mut view = Self { scene, t_s, dt_s, channels, rests: Vec::new(), resting, sigma: [f64::NAN; 6], step };
        view.rests = view.find_rests();
        if view.rests.len() < 3 {
            view.rests = view.own_rests();
        }
        view.sigma = std::array::from_fn(|c| view.noise(c));
        view
    }

    /// How many samples.
    pub fn len(&self) -> usize {
        self.t_s.len()
    }

    /// Samples of a time.
    pub fn count(&self, time_s: f64) -> usize {
        (time_s / self.dt_s).round().max(1.0) as usize
    }

    /// °/s.
    pub fn rate(&self, index: usize) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.channels[i][index])
    }

    /// g.
    pub fn force(&self, index: usize) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.channels[3 + i][index])
    }

    /// How far a reading is off the middle of its two neighbours, °/s or g.
    pub fn bend(&self, channel: usize, index: usize) -> f64 {
        let values = &self.channels[channel];
        (values[index] - 0.5 * (values[index - 1] + values[index + 1])).abs()
    }

    /// A segment's samples.
    pub fn samples_of(&self, segment: &Segment) -> Range<usize> {
        let at = |t_us: u64| self.t_s.partition_point(|t| *t < t_us as f64 * 1e-6 - 1e-6);
        at(segment.start_us)..(at(segment.end_us) + 1).min(self.len())
    }

    /// A place of samples on channels (bits as in `clipped`).
    pub fn place(&self, channels: u8, samples: Range<usize>) -> Place {
        let origin_s = self.scene.recording.origin_s();
        let time = |index: usize| origin_s + self.t_s.get(index).copied().unwrap_or(0.0);
        let (start_s, end_s) = (time(samples.start), time(samples.end.saturating_sub(1)));
        let touches = |segment: &Segment| {
            let range = self.samples_of(segment);
            range.start < samples.end && samples.start < range.end
        };
        let segments = self.scene.segments.iter().enumerate();
        Place {
            channels: (0..6).filter(|c| channels >> c & 1 == 1).map(|c| CHANNELS[c].into()).collect(),
            segments: segments.filter(|(_, segment)| touches(segment)).map(|(number, _)| number).collect(),
            start_s,
            end_s,
        }
    }

    /// The whole recording on all channels.
    pub fn everywhere(&self) -> Place {
        self.place(0x3f, 0..self.len())
    }

    fn find_rests(&self) -> Vec<Rest> {
        let still = |segment: &Segment| match segment.kind {
            Kind::Still { rate_variance, .. } if segment.exclusion != Exclusion::SteadyTurn => {
                Some(f64::from(rate_variance).sqrt().to_degrees())
            }
            _ => None,
        };
        let mut scatters: Vec<f64> = self.scene.segments.iter().filter_map(still).collect();
        // Twice the variance of the quieter ones; rounding that hides the noise of some is allowed for.
        let floor_dps = 0.5 * self.step[0].max(self.step[1]).max(self.step[2]);
        let limit_dps = (1.6 * quantile(&mut scatters, 0.25) + floor_dps).min(SOLID_DPS);
        let solid = |segment: &Segment| still(segment).is_some_and(|scatter| scatter <= limit_dps);
        let segments = self.scene.segments.iter().filter(|segment| solid(segment));
        segments.filter_map(|segment| self.rest(self.samples_of(segment))).collect()
    }

    /// Where the board's segmenter finds none (a table that rocks, a rate below its own): half seconds that hardly turn, with
    /// gravity within 2.5° of the first's, for two seconds.
    fn own_rests(&self) -> Vec<Rest> {
        let length = self.count(BLOCK_S).max(4);
        let quiet = |start: usize| {
            let share = 1.0 / length as f64;
            let mean = (start..start + length).map(|i| self.rate(i)).sum::<Vector3<f64>>() * share - self.resting;
            let rough = (0..3).any(|c| scatter(&self.channels[c][start..start + length]) > SOLID_DPS);
            let force = (start..start + length).map(|i| self.force(i)).sum::<Vector3<f64>>() * share;
            (mean.amax() < 2.0 && !rough).then_some(force)
        };
        let mut rests = Vec::new();
        let mut run: Option<(usize, usize, Vector3<f64>)> = None;
        for start in (0..self.len().saturating_sub(length)).step_by(length) {
            let force = quiet(start);
            run = match (run, force) {
                (Some((first, _, up)), Some(force)) if force.angle(&up) < 0.044 => Some((first, start + length, up)),
                (before, force) => {
                    rests.extend(
                        before.filter(|run| run.1 - run.0 >= 4 * length).and_then(|run| self.rest(run.0..run.1)),
                    );
                    force.map(|force| (start, start + length, force))
                }
            };
        }
        rests.extend(run.filter(|run| run.1 - run.0 >= 4 * length).and_then(|run| self.rest(run.0..run.1)));
        rests
    }

    fn rest(&self, samples: Range<usize>) -> Option<Rest> {
        let start = samples.start + self.count(SETTLING_S);
        let end = samples.end.saturating_sub(self.count(LEAVING_S));
        if end < start + self.count(BLOCK_S).max(8) {
            return None;
        }
        let share = 1.0 / (end - start) as f64;
        let rate = (start..end).map(|i| self.rate(i)).sum::<Vector3<f64>>() * share;
        let force = (start..end).map(|i| self.force(i)).sum::<Vector3<f64>>() * share;
        Some(Rest { samples: start..end, rate, force })
    }

    /// Median over blocks of the scatter about the block's mean; without rests, of the quietest blocks.
    fn noise(&self, channel: usize) -> f64 {
        let length = self.count(BLOCK_S).max(4);
        let rests = self.rests.iter().map(|rest| &self.channels[channel][rest.samples.clone()]);
        if self.rests.is_empty() {
            let mut all: Vec<f64> = self.channels[channel].chunks_exact(length).map(scatter).collect();
            return quantile(&mut all, 0.05);
        }
        median(rests.flat_map(|values| values.chunks_exact(length)).map(scatter).collect())
    }
}

/// Standard deviation.
pub fn scatter(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt()
}

/// The usual spacing of values that occur three times or more; zero where readings hardly repeat. One decimal of the text is a
/// step as well, and a coarse grid may lie on a finer one unevenly: whether a step is coarse is for gates to say.
fn step(channel: &[f64]) -> f64 {
    let mut values = channel.to_vec();
    values.sort_by(f64::total_cmp);
    let visited: Vec<f64> = values.chunk_by(|a, b| a == b).filter(|same| same.len() >= 3).map(|same| same[0]).collect();
    let mut gaps: Vec<f64> = visited.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if gaps.len() < 2 {
        return 0.0;
    }
    // The densest part's spacing; text decimals blur it, and the mean of those near it is sharper.
    let usual = quantile(&mut gaps, 0.2);
    let near: Vec<f64> = gaps.into_iter().filter(|gap| (gap / usual - 1.0).abs() < 0.2).collect();
    near.iter().sum::<f64>() / near.len() as f64
}

#[cfg(test)]
mod tests {
    use super::usual_spacing_s;

    #[test]
    fn batches_have_the_spacing_of_their_samples_and_losses_do_not_lengthen_it() {
        let batched: Vec<f64> = (0..6400).map(|k| 0.32 * f64::from(k / 32) + 0.001 * f64::from(k % 32)).collect();
        assert!((usual_spacing_s(&batched) - 0.01).abs() < 1e-4, "{}", usual_spacing_s(&batched));
        let lossy: Vec<f64> = (0..640).filter(|k| k % 4 != 0).map(|k| 0.01 * f64::from(k)).collect();
        assert!((usual_spacing_s(&lossy) - 0.01).abs() < 1e-9, "{}", usual_spacing_s(&lossy));
    }
}
