//! Spectra of rests, each rest taken whole, and what triads have in common there.

use std::f64::consts::{PI, TAU};

use nalgebra::Matrix3;

use super::chance::median;
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

/// By channel and bin, real and imaginary part.
type Transforms = Vec<Vec<(f64, f64)>>;

/// Of all channels over the pieces that rests are cut into.
pub struct Spectra {
    /// Spacing of the grid, Hz; finer than the resolution, so that a line between bins loses 10 % at most.
    pub bin_hz: f64,
    /// One over the median piece's length, Hz.
    pub resolution_hz: f64,
    /// How many pieces.
    pub pieces: f64,
    /// (Σw)²/Σw², mean over pieces: samples that a line's power has over noise of the same variance.
    pub gain: f64,
    /// By bin and triad, Re Σ X·X†/Σw², mean over pieces: of white noise its variance (unit²) on the diagonal.
    pub cross: Vec<[Matrix3<f64>; 2]>,
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
        let mut gain = 0.0;
        let transformed: Vec<Transforms> = pieces
            .iter()
            .map(|piece| {
                let shape = taper(piece.len(), TAPER);
                let (sum, squares) = shape.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
                gain += sum * sum / squares / pieces.len() as f64;
                let scaled: Vec<f64> = shape.iter().map(|w| w / squares.sqrt()).collect();
                transforms(view, piece.clone(), &scaled, size)
            })
            .collect();
        let cross = (0..size / 2).map(|bin| [0, 1].map(|triad| together(&transformed, bin, triad))).collect();
        let bin_hz = 1.0 / (size as f64 * view.dt_s);
        Some(Self { bin_hz, resolution_hz: 1.0 / (typical * view.dt_s), pieces: pieces.len() as f64, gain, cross })
    }

    /// The nearest bin.
    pub fn bin(&self, hz: f64) -> usize {
        ((hz / self.bin_hz).round().max(0.0) as usize).min(self.cross.len() - 1)
    }
}

/// The mean over pieces of Re X·X†, in which no piece counts for more than [`ALONE`] times the usual one.
fn together(transformed: &[Transforms], bin: usize, triad: usize) -> Matrix3<f64> {
    let power = |of: &Transforms| (0..3).map(|a| of[3 * triad + a][bin]).map(|x| x.0 * x.0 + x.1 * x.1).sum::<f64>();
    let most = ALONE * median(transformed.iter().map(power).collect());
    transformed.iter().fold(Matrix3::zeros(), |sum, of| {
        let x = |axis: usize| of[3 * triad + axis][bin];
        let weight = (most / power(of).max(1e-30)).min(1.0) / transformed.len() as f64;
        sum + Matrix3::from_fn(|a, b| x(a).0 * x(b).0 + x(a).1 * x(b).1) * weight
    })
}

/// Rests, cut evenly where they are too long.
fn pieces(view: &View) -> Vec<std::ops::Range<usize>> {
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
pub fn taper(length: usize, share: f64) -> Vec<f64> {
    let edge = (share * length as f64).max(1.0);
    let weight = |k: usize| {
        let from_end = (k as f64 + 0.5).min(length as f64 - k as f64 - 0.5);
        if from_end < edge { 0.5 - 0.5 * (PI * from_end / edge).cos() } else { 1.0 }
    };
    (0..length).map(weight).collect()
}

/// The lower halves of the Fourier transforms of all six channels, two in one.
fn transforms(view: &View, piece: std::ops::Range<usize>, shape: &[f64], size: usize) -> Transforms {
    let mut halves = Vec::with_capacity(6);
    for pair in [0, 2, 4] {
        let straight = [pair, pair + 1].map(|c| levelled(&view.channels[c][piece.clone()]));
        let mut both = vec![(0.0, 0.0); size];
        for (k, weight) in shape.iter().enumerate() {
            both[k] = (straight[0][k] * weight, straight[1][k] * weight);
        }
        fourier(&mut both);
        let split = |sign: f64| {
            move |k: usize, both: &[(f64, f64)]| {
                let (a, b) = (both[k], both[(size - k) % size]);
                if sign > 0.0 { (0.5 * (a.0 + b.0), 0.5 * (a.1 - b.1)) } else { (0.5 * (a.1 + b.1), 0.5 * (b.0 - a.0)) }
            }
        };
        for sign in [1.0, -1.0] {
            let of = split(sign);
            halves.push((0..size / 2).map(|k| of(k, &both)).collect());
        }
    }
    halves
}

/// Less its straight line.
fn levelled(values: &[f64]) -> Vec<f64> {
    let count = values.len() as f64;
    let (middle, mean) = (0.5 * (count - 1.0), values.iter().sum::<f64>() / count);
    let moment: f64 = values.iter().enumerate().map(|(k, v)| (k as f64 - middle) * (v - mean)).sum();
    let slope = moment / (count * (count * count - 1.0) / 12.0).max(1.0);
    values.iter().enumerate().map(|(k, v)| v - mean - slope * (k as f64 - middle)).collect()
}

/// Σ x e^(−2πikn/N), in place, N a power of two (Cooley and Tukey).
fn fourier(x: &mut [(f64, f64)]) {
    let size = x.len();
    let bits = size.trailing_zeros();
    for k in 0..size {
        let mirrored = k.reverse_bits() >> (usize::BITS - bits);
        if k < mirrored {
            x.swap(k, mirrored);
        }
    }
    let wave: Vec<(f64, f64)> = (0..size / 2).map(|k| (-TAU * k as f64 / size as f64).sin_cos()).collect();
    let mut half = 1;
    while half < size {
        for start in (0..size).step_by(2 * half) {
            for k in 0..half {
                let (sin, cos) = wave[k * (size / (2 * half))];
                let (a, b) = (x[start + k], x[start + k + half]);
                let turned = (b.0 * cos - b.1 * sin, b.0 * sin + b.1 * cos);
                x[start + k] = (a.0 + turned.0, a.1 + turned.1);
                x[start + k + half] = (a.0 - turned.0, a.1 - turned.1);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transform_is_the_sum_that_it_stands_for() {
        let values: Vec<f64> = (0..16).map(|k| (1.3 * k as f64).sin() + 0.1 * k as f64).collect();
        let mut fast: Vec<(f64, f64)> = values.iter().map(|v| (*v, 0.0)).collect();
        fourier(&mut fast);
        for (k, (re, im)) in fast.iter().enumerate() {
            let angle = |n: usize| -TAU * (k * n) as f64 / 16.0;
            let sum = |f: fn(f64) -> f64| values.iter().enumerate().map(|(n, v)| v * f(angle(n))).sum::<f64>();
            assert!((re - sum(f64::cos)).abs() < 1e-12 && (im - sum(f64::sin)).abs() < 1e-12, "bin {k}");
        }
    }

    #[test]
    fn a_straight_line_is_taken_out() {
        assert!(levelled(&[1.0, 2.5, 4.0, 5.5]).iter().all(|v| v.abs() < 1e-12));
    }
}
