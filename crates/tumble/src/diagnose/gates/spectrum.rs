//! Spectra of rests, each rest taken whole, and what triads have in common there.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::Matrix3;
use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

use super::chance::{median, quantile};
use super::view::View;

/// Longest piece that is taken coherently, s and samples: what hums keeps its phase for some seconds, not for minutes.
const LONGEST_S: f64 = 10.5;
const LONGEST: usize = 4096;
/// Rests are taken with a cosine taper over an eighth at either end: it keeps (Σw)²/(N·Σw²) = 0.907 of a line's information, and
/// three bins off a line has fallen to 3 % in power.
const TAPER: f64 = 0.125;

/// What hums steadily does so in every rest: power that one piece has alone (a hand that held the box, a motor that ran once) is
/// counted up to six times the median piece's. Noise, χ² of 6 over three axes, is above that once in 5 million (32 of a median of 5.3).
const ALONE: f64 = 6.0;

/// By channel and bin.
type Transforms = Vec<Vec<Complex<f64>>>;

/// Of all channels over the pieces that rests are cut into.
pub struct Spectra {
    /// Spacing of the grid, Hz; finer than the resolution, so that a line between bins loses 10 % at most.
    pub bin_hz: f64,
    /// One over the median piece's length, Hz.
    pub resolution_hz: f64,
    /// How many pieces.
    pub pieces: f64,
    /// [`Taper::gain`], mean over pieces.
    pub gain: f64,
    /// By bin and triad, Re Σ X·X†/Σw², mean over pieces: of white noise its variance (unit²) on the diagonal.
    pub cross: Vec<[Matrix3<f64>; 2]>,
    /// By triad and axis: variance (unit²) that a tenth of the bins exceeds, the noise within the sensor's bandwidth if that is a tenth of the
    /// band at least.
    pub level: [[f64; 3]; 2],
}

impl Spectra {
    /// None without rests of a second or more.
    pub fn new(view: &View) -> Option<Self> {
        let pieces = pieces(view);
        let lengths: Vec<f64> = pieces.iter().map(|piece| piece.len() as f64).collect();
        let (typical, longest) = (median(lengths.clone()), lengths.iter().fold(0.0_f64, |max, n| max.max(*n)));
        if pieces.is_empty() || typical * view.dt_s < 1.0 {
            return None;
        }
        // Pieces far shorter than usual would blur what the others resolve.
        let pieces: Vec<_> = pieces.into_iter().filter(|piece| piece.len() as f64 >= 0.5 * typical).collect();
        let size = (1.5 * longest).ceil() as usize;
        let size = size.next_power_of_two();
        let transform = RealFftPlanner::new().plan_fft_forward(size);
        let mut gain = 0.0;
        let transformed: Vec<Transforms> = pieces
            .iter()
            .map(|piece| {
                let taper = Taper::new(piece.len(), TAPER);
                gain += taper.gain() / pieces.len() as f64;
                transforms(view, piece.clone(), &taper, &*transform)
            })
            .collect();
        let cross: Vec<_> = (0..size / 2).map(|bin| [0, 1].map(|triad| together(&transformed, bin, triad))).collect();
        let bin_hz = 1.0 / (size as f64 * view.dt_s);
        let level = [0, 1].map(|triad| [0, 1, 2].map(|axis| level(&cross, triad, axis)));
        Some(Self {
            bin_hz,
            resolution_hz: 1.0 / (typical * view.dt_s),
            pieces: pieces.len() as f64,
            gain,
            cross,
            level,
        })
    }

    /// The nearest bin.
    pub fn bin(&self, hz: f64) -> usize {
        ((hz / self.bin_hz).round().max(0.0) as usize).min(self.cross.len() - 1)
    }
}

fn level(cross: &[[Matrix3<f64>; 2]], triad: usize, axis: usize) -> f64 {
    let mut powers: Vec<f64> = cross.iter().map(|bin| bin[triad][(axis, axis)]).collect();
    quantile(&mut powers, 0.9)
}

/// The mean over pieces of Re X·X†, in which no piece counts for more than [`ALONE`] times the usual one.
fn together(transformed: &[Transforms], bin: usize, triad: usize) -> Matrix3<f64> {
    let power = |of: &Transforms| (0..3).map(|a| of[3 * triad + a][bin]).map(|x| x.norm_sqr()).sum::<f64>();
    let most = ALONE * median(transformed.iter().map(power).collect());
    transformed.iter().fold(Matrix3::zeros(), |sum, of| {
        let x = |axis: usize| of[3 * triad + axis][bin];
        let weight = (most / power(of).max(1e-30)).min(1.0) / transformed.len() as f64;
        sum + Matrix3::from_fn(|a, b| (x(a) * x(b).conj()).re) * weight
    })
}

/// Rests, cut evenly where they are too long.
fn pieces(view: &View) -> Vec<Range<usize>> {
    let most = view.count(LONGEST_S).min(LONGEST);
    let cut = |rest: &super::view::Rest| {
        let range = rest.samples.clone();
        let parts = range.len().div_ceil(most).max(1);
        let length = range.len() / parts;
        (0..parts).map(move |k| range.start + k * length..range.start + (k + 1) * length)
    };
    view.rests.iter().flat_map(cut).collect()
}

/// Ones, with half a cosine over a share of the length at either end.
pub struct Taper {
    /// By sample.
    pub weights: Vec<f64>,
    /// Σw.
    pub sum: f64,
    /// Σw².
    pub squares: f64,
}

impl Taper {
    /// `share` of `length` at either end.
    pub fn new(length: usize, share: f64) -> Self {
        let edge = (share * length as f64).max(1.0);
        let weight = |k: usize| {
            let from_end = (k as f64 + 0.5).min(length as f64 - k as f64 - 0.5);
            if from_end < edge { 0.5 - 0.5 * (PI * from_end / edge).cos() } else { 1.0 }
        };
        let weights: Vec<f64> = (0..length).map(weight).collect();
        let (sum, squares) = weights.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
        Self { weights, sum, squares }
    }

    /// (Σw)²/Σw²: samples that a line's power has over noise of the same variance.
    pub fn gain(&self) -> f64 {
        self.sum * self.sum / self.squares
    }
}

/// The lower halves of the Fourier transforms of all six channels, over √Σw².
fn transforms(view: &View, piece: Range<usize>, taper: &Taper, transform: &dyn RealToComplex<f64>) -> Transforms {
    let one = |channel: &Vec<f64>| {
        let mut values = transform.make_input_vec();
        for ((value, level), weight) in values.iter_mut().zip(levelled(&channel[piece.clone()])).zip(&taper.weights) {
            *value = level * weight / taper.squares.sqrt();
        }
        let mut halves = transform.make_output_vec();
        // Both buffers are the plan's own, and their lengths are all that it can refuse.
        if transform.process(&mut values, &mut halves).is_err() {
            halves.fill(Complex::new(0.0, 0.0));
        }
        halves
    };
    view.channels.iter().map(one).collect()
}

/// Less its straight line.
fn levelled(values: &[f64]) -> Vec<f64> {
    let count = values.len() as f64;
    let (middle, mean) = (0.5 * (count - 1.0), values.iter().sum::<f64>() / count);
    let moment: f64 = values.iter().enumerate().map(|(k, v)| (k as f64 - middle) * (v - mean)).sum();
    let slope = moment / (count * (count * count - 1.0) / 12.0).max(1.0);
    values.iter().enumerate().map(|(k, v)| v - mean - slope * (k as f64 - middle)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_is_taken_out() {
        assert!(levelled(&[1.0, 2.5, 4.0, 5.5]).iter().all(|v| v.abs() < 1e-12));
    }
}
