//! Seeded chance, one independent stream per purpose.
//!
//! Each purpose draws from its own PCG stream, so that, say, a change of the noise leaves the motion as it was.

use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng as _;

/// What a stream of chance is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// The hands: paths, tremor, stop errors.
    Hands = 1,
    /// The sensor's true parameters.
    Truth = 2,
    /// The sensor's noise.
    Noise = 3,
    /// The person's decisions and reaction times.
    Person = 4,
    /// The order and the poses of an offline scheme.
    Scheme = 5,
    /// The box's faces.
    Box = 6,
    /// What an effect leaves open: axes, directions, signs, times.
    Effect = 7,
}

/// A deterministic generator: the same seed and purpose give the same numbers on every machine.
#[derive(Debug, Clone)]
pub struct Rng(Pcg64);

impl Rng {
    /// The stream of `seed` for `purpose`.
    pub fn new(seed: u64, purpose: Purpose) -> Self {
        // PCG streams with near seeds are correlated at the start: spread the seed by the golden ratio (splitmix64).
        let spread = seed.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mut pcg = Pcg64::new(u128::from(spread) << 64 | u128::from(seed), purpose as u128);
        for _ in 0..4 {
            pcg.next_u64();
        }
        Self(pcg)
    }

    /// Uniform in `[0, 1)`, 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `[low, high)`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in `±half_width`.
    pub fn symmetric(&mut self, half_width: f64) -> f64 {
        self.uniform(-half_width, half_width)
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Three standard normals.
    pub fn normal3(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal())
    }

    /// A direction, uniform on the sphere.
    pub fn direction(&mut self) -> Vector3<f64> {
        loop {
            if let Some(unit) = self.normal3().try_normalize(1e-6) {
                return unit;
            }
        }
    }

    /// An angle, uniform on the circle.
    pub fn phase(&mut self) -> f64 {
        self.uniform(0.0, core::f64::consts::TAU)
    }

    /// An index below `count`; 0 if `count` is 0.
    pub fn index(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Puts `items` into a random order (Fisher–Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.index(i + 1));
        }
    }
}
