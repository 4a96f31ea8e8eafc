//! Sums of a few sinusoids: tremor, wandering speed, tumbling.

use crate::kinematics::{Jet, Path, Spin};
use crate::motion::setting::Hands;
use crate::rng::Rng;
use core::f64::consts::TAU;
use nalgebra::Vector3;

/// Physiological tremor of an outstretched hand, Hz (Elble & Koller, *Tremor*, 1990: 8–12 Hz).
const TREMOR_HZ: (f64, f64) = (8.0, 12.0);

/// `Σ a_k sin(ω_k t + φ_k)`: five random tones are band-limited noise to the eye and have exact derivatives.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tones([(f64, f64, f64); 5]);

impl Tones {
    /// Tones spread over a band (Hz) with this rms.
    pub(super) fn band(low_hz: f64, high_hz: f64, rms: f64, rng: &mut Rng) -> Self {
        let step = (high_hz - low_hz) / 5.0;
        let amplitude = rms * (2.0f64 / 5.0).sqrt();
        Self(core::array::from_fn(|k| (amplitude, TAU * (low_hz + step * (k as f64 + rng.unit())), rng.phase())))
    }

    /// Like [`Tones::band`], but with the rms of the *rate*: slow tones are then larger.
    pub(super) fn band_of_rate(low_hz: f64, high_hz: f64, rate_rms: f64, rng: &mut Rng) -> Self {
        let mut tones = Self::band(low_hz, high_hz, rate_rms, rng);
        tones.0.iter_mut().for_each(|tone| tone.0 /= tone.1);
        tones
    }

    /// Value and derivatives at `t_s`.
    pub(super) fn at(&self, t_s: f64) -> Jet {
        self.0.iter().fold(Jet::default(), |sum, &(amplitude, omega, phase)| {
            sum + Jet::phase(omega, phase, t_s).sin() * amplitude
        })
    }
}

/// Tremor of the hands that hold the box: three small angles and three small displacements.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tremor {
    angles: [Tones; 3],
    positions: [Tones; 3],
    on_table: Option<Vector3<f64>>,
}

impl Tremor {
    /// Of a box held in the air.
    pub(super) fn in_air(hands: &Hands, rng: &mut Rng) -> Self {
        Self::draw(hands, 1.0, None, rng)
    }

    /// Of a box that slides on a plate with this normal (in `n`): smaller, within the plate, and about its normal only.
    pub(super) fn on_table(hands: &Hands, normal_n: Vector3<f64>, rng: &mut Rng) -> Self {
        Self::draw(hands, hands.tremor_on_table, Some(normal_n), rng)
    }

    fn draw(hands: &Hands, share: f64, on_table: Option<Vector3<f64>>, rng: &mut Rng) -> Self {
        let (low, high) = TREMOR_HZ;
        let mut band = |rms: f64| core::array::from_fn(|_| Tones::band(low, high, rms * share, rng));
        Self { angles: band(hands.tremor_angle_deg.to_radians()), positions: band(hands.tremor_position_m), on_table }
    }

    /// Adds the tremor, faded by `grip` (0 free, 1 held), to a motion.
    pub(super) fn shake(&self, t_s: f64, grip: Jet, spin: Spin, path: &mut Path) -> Spin {
        if grip == Jet::default() {
            return spin;
        }
        for (axis, tones) in self.positions.iter().enumerate() {
            let axis = Vector3::ith(axis, 1.0);
            let within = self.on_table.map_or(axis, |normal| axis - normal * normal.dot(&axis));
            *path += Path::along(&within, tones.at(t_s) * grip);
        }
        match self.on_table {
            None => spin.then_small(core::array::from_fn(|i| self.angles[i].at(t_s) * grip)),
            Some(normal_n) => Spin::about(&normal_n, self.angles[0].at(t_s) * grip).then(spin),
        }
    }
}
