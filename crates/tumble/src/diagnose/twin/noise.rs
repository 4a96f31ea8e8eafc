//! Noise of the nominal model: what scatters fast enough that no physics worth naming can be behind it.

use tumble_core::estimate::noise::Noise as Device;
use tumble_core::setup::TurnStops;

/// A turn against a fence ends no worse than this unless something is wrong with it, rad (0.3°).
const FENCE_CAP_RAD: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// A lever arm that is nothing to speak of, each axis, m: (3, 2, 1) cm is how a sensor sits in a box (`docs/diagnosis.md`).
pub const LEVER_SIGMA_M: f64 = 1.2e-2;
/// How far a turn's axis is from where other turns have it, m; more where the device found more: a hand that pushes a corner turns the box
/// about another.
pub const PIVOT_SIGMA_M: f64 = 5e-3;
/// How well a face's contact with a firm table repeats, rad: 1.5 µm on 5 cm.
const CONTACT_RAD: f64 = 30e-6;

/// Densities and sigmas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// rad²/s.
    pub rate_density: f64,
    /// (m/s²)² s.
    pub force_density: f64,
    /// (rad/s)²/s.
    pub bias_walk: f64,
    /// (m/s²)²/s.
    pub force_walk: f64,
    /// Factors on both while the box moves, gyroscope's first: 1 for what wanders with time alone.
    pub walk_in_motion: [f64; 2],
    /// Factor on the rate density in turns on the table …
    pub turn_scale: f64,
    /// … and in a hand.
    pub hand_scale: f64,
    /// rad.
    pub stop_sigma_rad: f64,
    /// rad; none where the box is not known to be square.
    pub facet_sigma_rad: Option<f64>,
    /// How well a face's contact with the table repeats from rest to rest, rad.
    pub contact_sigma_rad: f64,
    /// How far a turn's axis is from where other turns have it, m.
    pub pivot_sigma_m: f64,
    /// How a hand pushes the box about in a turn: its horizontal acceleration over gravity, 1. A Gauss–Markov process in frame n; none
    /// unless the turns show it.
    pub slide_rad: f64,
    /// Its time constant, s.
    pub slide_s: f64,
}

/// Least wander that is taken for granted: 1 mdps and 10 µg in 100 s.
pub const BIAS_WALK_FLOOR: f64 = 3.046e-12;
/// Likewise, (m/s²)²/s.
pub const FORCE_WALK_FLOOR: f64 = 1e-10;

/// A stop against a fence, rad, and a face of a square box, before any recording: the device's expectations.
const FENCE_RAD: f64 = 0.05 * std::f64::consts::PI / 180.0;
const SQUARE_RAD: f64 = 20e-6;

/// Length of the means whose differences the device tells white noise by, s: half-second records.
const RECORD_S: f64 = 0.5;
/// White noise is not believed to be less than this share of what was measured.
const LEAST_WHITE: f64 = 0.1;

/// The gyroscope's or the accelerometer's.
pub fn walk_floor(gyro: bool) -> f64 {
    if gyro { BIAS_WALK_FLOOR } else { FORCE_WALK_FLOOR }
}

impl Noise {
    /// How the gyroscope's bias wanders, (rad/s)²/s, or the accelerometer's, (m/s²)²/s.
    pub fn walk(&self, gyro: bool) -> f64 {
        if gyro { self.bias_walk } else { self.force_walk }
    }

    /// The same with one triad's bias wandering as said.
    #[must_use]
    pub fn with_walk(&self, gyro: bool, walk: f64) -> Self {
        if gyro { Self { bias_walk: walk, ..*self } } else { Self { force_walk: walk, ..*self } }
    }

    /// Variance of a mean rate over `duration_s` about the bias in its middle, (rad/s)².
    pub fn rate_mean(&self, duration_s: f64) -> f64 {
        of_mean(self.rate_density, self.bias_walk, duration_s)
    }

    /// Likewise of a mean force, (m/s²)²; `scale` is how much noisier the force is than at rest.
    pub fn force_mean(&self, duration_s: f64, scale: f64) -> f64 {
        of_mean(self.force_density * scale, self.force_walk, duration_s)
    }

    /// The same with stops and faces as good as their owner says. What the device found of them may be an effect that it
    /// took for sloppiness: which of the two is the case is for the evidence to say.
    #[must_use]
    pub fn trusting(&self, stops: TurnStops) -> Self {
        Self {
            stop_sigma_rad: if stops == TurnStops::Fenced {
                self.stop_sigma_rad.min(FENCE_RAD)
            } else {
                self.stop_sigma_rad
            },
            facet_sigma_rad: self.facet_sigma_rad.map(|sigma| sigma.min(SQUARE_RAD)),
            contact_sigma_rad: CONTACT_RAD,
            pivot_sigma_m: PIVOT_SIGMA_M,
            turn_scale: 1.0,
            hand_scale: 1.0,
            slide_rad: 0.0,
            slide_s: 1.0,
            ..*self
        }
    }

    /// White densities and stops as the device's estimator found them; nothing that wanders beyond the floor, because what
    /// wanders is what the search explains.
    pub fn new(device: &Device, stops: TurnStops) -> Self {
        let stop_sigma_rad = f64::from(device.stop_sigma_rad);
        Self {
            rate_density: f64::from(device.rate_density),
            force_density: f64::from(device.force_density),
            bias_walk: BIAS_WALK_FLOOR,
            force_walk: FORCE_WALK_FLOOR,
            walk_in_motion: [1.0; 2],
            turn_scale: f64::from(device.turn_scale),
            hand_scale: f64::from(device.hand_scale),
            stop_sigma_rad: if stops == TurnStops::Fenced { stop_sigma_rad.min(FENCE_CAP_RAD) } else { stop_sigma_rad },
            facet_sigma_rad: device.facet_sigma_rad.map(f64::from),
            contact_sigma_rad: f64::from(device.contact_sigma_rad).max(CONTACT_RAD),
            pivot_sigma_m: f64::from(device.pivot_sigma_m).max(PIVOT_SIGMA_M),
            slide_rad: 0.0,
            slide_s: 1.0,
        }
    }
}

/// A walk's mean over T, given the walk at both ends, is their mean with a variance of `qT/12` (Brownian bridge). With b before, b + w after,
/// `Var w = qT`, and y = b + w/2 + bridge + noise of variance r: `Var y = P + qT/3 + r`, `Cov(b + w, y) = P + qT/2`. A filter that lets b wander
/// by `qT/2`, takes y as an observation of b with the variance `r − qT/6`, and lets it wander by `qT/2` again comes to the very same.
/// (The whole of qT before each mean took a tenth off the size of a walk that stands out of the noise.)
///
/// r itself was measured by differences of neighbouring means, whose variance is `2r + 2qT/3`: it is less by `qT/3`.
fn of_mean(density: f64, walk: f64, duration_s: f64) -> f64 {
    let white = (density - walk * RECORD_S * RECORD_S / 3.0).max(LEAST_WHITE * density);
    white / duration_s - walk * duration_s / 6.0
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// ln p of means of a walk with noise, by their covariance and by the filter: a walk far above the noise, and one far below.
    #[test]
    fn a_walk_s_mean_by_halves_is_exact() {
        let (count, before) = (12, 3.0);
        let values = DVector::from_fn(count, |i, _| (7.3 * i as f64).sin() * (1.0 + i as f64));
        for (walk, white) in [(4.0, 0.5), (0.02, 2.0), (1.0, 1.0)] {
            let covariance = DMatrix::from_fn(count, count, |i, j| {
                let since = if i == j { RECORD_S / 3.0 } else { RECORD_S / 2.0 };
                before + walk * (i.min(j) as f64 * RECORD_S + since) + if i == j { white } else { 0.0 }
            });
            let factor = covariance.cholesky().expect("positive");
            let exact = -0.5 * values.dot(&factor.solve(&values)) - factor.l().diagonal().map(f64::ln).sum();

            // As differences of neighbouring means show it.
            let measured = (white + walk * RECORD_S / 3.0) * RECORD_S;
            let (mut mean, mut variance, mut filtered) = (0.0, before, 0.0);
            for value in values.iter() {
                variance += 0.5 * walk * RECORD_S;
                let innovation = variance + of_mean(measured, walk, RECORD_S);
                filtered -= 0.5 * ((value - mean) * (value - mean) / innovation + innovation.ln());
                mean += variance / innovation * (value - mean);
                variance -= variance * variance / innovation;
                variance += 0.5 * walk * RECORD_S;
            }
            assert!((filtered - exact).abs() < 1e-9 * exact.abs(), "{walk} {white}: {filtered} {exact}");
        }
    }
}
