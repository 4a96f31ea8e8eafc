//! White noise of a given density behind a second-order low-pass.

use crate::rng::Rng;
use core::f64::consts::{PI, SQRT_2};
use nalgebra::Vector3;

/// Butterworth low-pass of second order by the bilinear transform with the cut-off pre-warped; gain 1 at 0 Hz, so that the
/// density in the pass band is that of the white noise going in.
#[derive(Debug, Clone)]
struct LowPass {
    b: [f64; 3],
    a: [f64; 2],
    state: [Vector3<f64>; 2],
}

impl LowPass {
    fn new(cut_off_hz: f64, rate_hz: f64) -> Self {
        let k = (PI * cut_off_hz / rate_hz).tan();
        let norm = 1.0 / (1.0 + SQRT_2 * k + k * k);
        let b0 = k * k * norm;
        Self {
            b: [b0, 2.0 * b0, b0],
            a: [2.0 * (k * k - 1.0) * norm, (1.0 - SQRT_2 * k + k * k) * norm],
            state: [Vector3::zeros(); 2],
        }
    }

    /// Transposed direct form II.
    fn step(&mut self, input: Vector3<f64>) -> Vector3<f64> {
        let output = input * self.b[0] + self.state[0];
        self.state[0] = input * self.b[1] - output * self.a[0] + self.state[1];
        self.state[1] = input * self.b[2] - output * self.a[1];
        output
    }
}

/// The noise of one triad.
///
/// White samples at rate `f_s` with one-sided density `N` (unit/√Hz) have `σ = N·√(f_s/2)`; the low-pass then leaves the
/// density as it is below its cut-off. Averages over `T` seconds have `σ = N/√(2T)`.
#[derive(Debug, Clone)]
pub struct ShapedNoise {
    sigma: f64,
    low_pass: Option<LowPass>,
}

impl ShapedNoise {
    /// Of this density at this sample rate. A bandwidth beyond 0.45 of the rate leaves it white.
    pub fn new(density: f64, rate_hz: f64, bandwidth_hz: Option<f64>, rng: &mut Rng) -> Self {
        let low_pass = bandwidth_hz.filter(|hz| *hz < 0.45 * rate_hz).map(|hz| LowPass::new(hz, rate_hz));
        let mut noise = Self { sigma: density * (0.5 * rate_hz).sqrt(), low_pass };
        // Fill the filter, so that the first sample is as noisy as the rest.
        if let Some(hz) = bandwidth_hz.filter(|_| noise.low_pass.is_some()) {
            for _ in 0..(3.0 * rate_hz / hz) as usize {
                noise.step(rng);
            }
        }
        noise
    }

    /// The next sample.
    pub fn step(&mut self, rng: &mut Rng) -> Vector3<f64> {
        let white = rng.normal3() * self.sigma;
        self.low_pass.as_mut().map_or(white, |filter| filter.step(white))
    }
}
