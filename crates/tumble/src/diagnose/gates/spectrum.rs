//! Mean periodograms over rests.

use std::f64::consts::TAU;

use super::view::View;

/// Longest window, samples, and most windows: 50 million products, a tenth of a second.
const LONGEST: usize = 512;
const MOST: usize = 64;

/// Of one channel, by Hann windows that overlap by half (their periodograms correlate by 1/36).
pub struct Spectrum {
    /// |Σ w x e^(−iωt)|² a bin, mean over windows.
    pub power: Vec<f64>,
}

/// What all channels share.
pub struct Windows {
    starts: Vec<usize>,
    length: usize,
    /// Hz a bin.
    pub bin_hz: f64,
    shape: Vec<f64>,
}

impl Windows {
    /// As long as the median rest allows; none without rests.
    pub fn new(view: &View) -> Option<Self> {
        let lengths: Vec<f64> = view.rests.iter().map(|rest| rest.samples.len() as f64).collect();
        let typical = super::chance::median(lengths);
        if typical.is_nan() || typical < 32.0 {
            return None;
        }
        let mut length = LONGEST;
        while length as f64 > typical {
            length /= 2;
        }
        let all = view.rests.iter().flat_map(|rest| {
            let last = rest.samples.end.saturating_sub(length);
            (rest.samples.start..=last).step_by(length / 2).filter(move |start| start + length <= rest.samples.end)
        });
        let all: Vec<usize> = all.collect();
        let starts: Vec<usize> = all.iter().copied().step_by(all.len().div_ceil(MOST).max(1)).collect();
        let shape = (0..length).map(|i| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / length as f64).cos()).collect();
        (!starts.is_empty()).then(|| Self { starts, length, bin_hz: 1.0 / (length as f64 * view.dt_s), shape })
    }

    /// How many windows.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// Of one channel.
    pub fn spectrum(&self, channel: &[f64]) -> Spectrum {
        let wave: Vec<(f64, f64)> = (0..self.length).map(|i| (TAU * i as f64 / self.length as f64).sin_cos()).collect();
        let mut power = vec![0.0; self.length / 2];
        let mut shaped = vec![0.0; self.length];
        for &start in &self.starts {
            let values = &channel[start..start + self.length];
            let mean = values.iter().zip(&self.shape).map(|(v, w)| v * w).sum::<f64>() / self.shape.iter().sum::<f64>();
            for ((shaped, value), weight) in shaped.iter_mut().zip(values).zip(&self.shape) {
                *shaped = (value - mean) * weight;
            }
            for (bin, power) in power.iter_mut().enumerate().skip(1) {
                let (mut re, mut im, mut at) = (0.0, 0.0, 0);
                for value in &shaped {
                    re += value * wave[at].1;
                    im += value * wave[at].0;
                    at = (at + bin) & (self.length - 1);
                }
                *power += (re * re + im * im) / self.starts.len() as f64;
            }
        }
        Spectrum { power }
    }

    /// Peak of a sine whose bins sum to this power (Parseval: half of A²/2 in the positive half).
    pub fn amplitude(&self, power: f64) -> f64 {
        let weight: f64 = self.shape.iter().map(|w| w * w).sum();
        (4.0 * power.max(0.0) / (self.length as f64 * weight)).sqrt()
    }
}
