//! Where a rest truly begins and ends.
//!
//! The board's segmenter decides by quarters of a second and by what a hand feels; a box that settles back at 0.3 °/s for 0.3 s
//! after a turn passes it as still. That is 0.09° which the twin would lose, and a first rate at rest that is off by 11 sigma.
//! Here the edges are looked at again, by tenths of a second: what stands out of the rest belongs to the motion beside it.

use nalgebra::SVector;

use super::data::{Deed, Raw, Stretch};

/// Means that are compared, s.
const BLOCK_S: f64 = 0.1;
/// An edge moves by at most so many, 1 s: what lasts longer is no settling, and is for the search to explain.
const MOST_BLOCKS: usize = 10;
/// A rest that is left with fewer stays as it was.
const LEAST_BLOCKS: usize = 20;
/// χ² of 6 degrees that one quiet block in a hundred exceeds. A false alarm makes a rest 0.2 s shorter, which costs nothing;
/// a tail of 3 sigma that is left in every rest adds up to a memory of motion.
const STANDS_OUT: f64 = 16.81;

type Six = SVector<f64, 6>;

/// A rest in blocks.
struct Blocks {
    /// First sample of each; one more for the end.
    first: Vec<usize>,
    /// Rate and force.
    mean: Vec<Six>,
    /// Of the middle half.
    reference: Six,
}

impl Blocks {
    fn of(stretch: &Stretch, samples: &[Raw]) -> Option<Self> {
        let (mut first, mut mean) = (vec![stretch.samples.start], Vec::new());
        let (mut sum, mut count) = (Six::zeros(), 0.0);
        for index in stretch.samples.clone() {
            if samples[index].t_s - samples[first[mean.len()]].t_s >= BLOCK_S - 1e-6 {
                mean.push(sum / count);
                first.push(index);
                (sum, count) = (Six::zeros(), 0.0);
            }
            let (rate, force) = (samples[index].rate, samples[index].force);
            sum += Six::new(rate.x, rate.y, rate.z, force.x, force.y, force.z);
            count += 1.0;
        }
        if mean.len() < LEAST_BLOCKS {
            return None;
        }
        let middle = &mean[mean.len() / 4..mean.len() - mean.len() / 4];
        let reference = middle.iter().sum::<Six>() / middle.len() as f64;
        Some(Self { first, mean, reference })
    }

    /// Blocks to give away at an edge, whose blocks come outermost first.
    fn tail(&self, scatter: &Six, outermost: impl Iterator<Item = usize>) -> usize {
        let mut tail = 0;
        for (k, block) in outermost.take(MOST_BLOCKS).enumerate() {
            let off = (self.mean[block] - self.reference).component_div(scatter).norm_squared();
            if off > STANDS_OUT {
                // One more, in which it fades.
                tail = k + 2;
            } else if k >= tail {
                break;
            }
        }
        tail.min(MOST_BLOCKS)
    }
}

/// Moves the edges of all rests on something solid. Stretches beside them take what they give away.
pub fn refine(stretches: &mut [Stretch], samples: &[Raw]) {
    let solid = |stretch: &Stretch| matches!(stretch.deed, Deed::Rest { .. }) && !stretch.excluded;
    let blocks: Vec<Option<Blocks>> =
        stretches.iter().map(|s| solid(s).then(|| Blocks::of(s, samples)).flatten()).collect();
    let Some(scatter) = scatter(&blocks) else { return };
    for (k, blocks) in blocks.iter().enumerate() {
        let Some(blocks) = blocks else { continue };
        let count = blocks.mean.len();
        let (head, tail) = (blocks.tail(&scatter, 0..count), blocks.tail(&scatter, (0..count).rev()));
        if count - head - tail >= LEAST_BLOCKS {
            trim(stretches, k, blocks.first[head], (tail > 0).then(|| blocks.first[count - tail] + 1));
        }
    }
}

/// Of a block's mean about its neighbours', per channel: by the median of squared differences, which a tail does not move.
/// The median of χ² of one degree is 0.455; a difference has twice the variance.
fn scatter(blocks: &[Option<Blocks>]) -> Option<Six> {
    let mut squares: Vec<Six> = Vec::new();
    for blocks in blocks.iter().flatten() {
        squares.extend(blocks.mean.windows(2).map(|pair| (pair[1] - pair[0]).map(|v| v * v)));
    }
    if squares.len() < LEAST_BLOCKS {
        return None;
    }
    let median = |channel: usize| {
        let mut values: Vec<f64> = squares.iter().map(|square| square[channel]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let scatter = Six::from_fn(|channel, _| (median(channel) / (2.0 * 0.455)).sqrt());
    scatter.iter().all(|v| *v > 0.0).then_some(scatter)
}

/// New ends of a rest; the last sample of a stretch is the first of the next.
fn trim(stretches: &mut [Stretch], k: usize, start: usize, end: Option<usize>) {
    let old = stretches[k].samples.clone();
    let before = k.checked_sub(1).and_then(|before| stretches.get_mut(before));
    if let Some(before) = before.filter(|before| before.samples.end == old.start + 1) {
        before.samples.end = start + 1;
    }
    stretches[k].samples.start = start;
    if let Some(end) = end {
        if let Some(after) = stretches.get_mut(k + 1).filter(|after| after.samples.start + 1 == old.end) {
            after.samples.start = end - 1;
        }
        stretches[k].samples.end = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Ten seconds at rest after two of motion, 200 Hz; a hash's noise of 0.1 on every channel; `tail_s` of a tail of 1.
    fn session(tail_s: f64) -> (Vec<Stretch>, Vec<Raw>) {
        let mut state = 1_u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            0.1 * ((state >> 11) as f64 / 2f64.powi(53) - 0.5)
        };
        let samples = (0..2401)
            .map(|k| {
                let t_s = 0.005 * f64::from(k);
                let moves = if t_s < 2.0 + tail_s { 1.0 } else { 0.0 };
                let rate = Vector3::new(moves + noise(), noise(), noise());
                Raw { t_s, rate, force: Vector3::new(noise(), noise(), noise()), temperature_degc: f64::NAN }
            })
            .collect();
        let stretch = |number, deed, samples| Stretch { number, deed, samples, broken: false, excluded: false };
        (vec![stretch(0, Deed::Move, 0..401), stretch(1, Deed::Rest { face: None }, 400..2401)], samples)
    }

    #[test]
    fn a_tail_goes_to_the_motion() {
        let (mut stretches, samples) = session(0.33);
        refine(&mut stretches, &samples);
        // Four blocks stand out, one more is given away; both still share a sample.
        assert_eq!(stretches[0].samples, 0..501);
        assert_eq!(stretches[1].samples, 500..2401);
    }

    #[test]
    fn a_clean_rest_stays() {
        let (mut stretches, samples) = session(0.0);
        refine(&mut stretches, &samples);
        assert_eq!(stretches[0].samples, 0..401);
        assert_eq!(stretches[1].samples.start, 400);
    }

    #[test]
    fn what_lasts_is_left_to_the_search() {
        let (mut stretches, samples) = session(3.0);
        refine(&mut stretches, &samples);
        assert_eq!(stretches[1].samples.start, 600);
    }
}
