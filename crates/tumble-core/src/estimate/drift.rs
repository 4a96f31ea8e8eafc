//! The gyroscope's bias over the session as a straight line, by the rates at rest alone.
//!
//! A warming sensor drifts one way. From rest to rest that is lost in noise (2 mdps against 5), over a session it is
//! eight sigma: taken for a walk, it costs all that hangs on the bias between rests. In sensor axes a rest's mean rate is
//! `b + s t + Rᵀ Ω`; b and the Earth's Ω are eliminated. The three slopes' common variance is their mean square less
//! what noise makes of it (empirical Bayes): without a drift they shrink to nothing.

use nalgebra::{Matrix3, Vector3};

use super::normal::Normal;

/// Unit of time, s: with it and weights in seconds `f32` holds the determinant.
const UNIT_S: f32 = 100.0;
/// Upper 5 % and 0.1 % points of χ²₃: a slope is used from the first on, and said from the second.
const LIKELY: f32 = 7.815;
const CERTAIN: f32 = 16.27;

/// A line through the session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slope {
    /// (rad/s)/s.
    pub rate: Vector3<f32>,
    /// Of one component, ((rad/s)/s)².
    pub variance: f32,
    /// Is it certain that there is one?
    pub certain: bool,
}

/// Sums over a pass: bias 3, Earth 3, slope 3, observed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drift {
    normal: Normal<10>,
}

impl Drift {
    /// Mean rate of a rest of `duration_s` less the nominal bias, `to_b = Rᵀ`, at `t_s` from the session's middle.
    pub fn take(&mut self, rate: &Vector3<f32>, to_b: &Matrix3<f32>, t_s: f32, duration_s: f32) {
        for axis in 0..3 {
            let mut row = [0.0; 10];
            row[axis] = 1.0;
            (0..3).for_each(|component| row[3 + component] = to_b[(axis, component)]);
            row[6 + axis] = t_s / UNIT_S;
            row[9] = rate[axis];
            self.normal.take(&row, duration_s);
        }
    }

    /// What it comes to; none where rests do not tell. The rates' noise has a density, the Earth's rate a prior.
    pub fn slope(&self, rate_density: f32, earth_sigma: f32) -> Option<Slope> {
        let mut normal = self.normal;
        (3..6).for_each(|unknown| normal.expect(unknown, earth_sigma / libm::sqrtf(rate_density)));
        normal.eliminate(6);
        let information = Matrix3::from_fn(|i, j| normal.at(6 + i, 6 + j));
        let product = Vector3::from_fn(|i, _| normal.at(6 + i, 9));
        let covariance = information.try_inverse().filter(|inverse| inverse.diagonal().min() > 0.0)?;
        let found = covariance * product;
        let square = found.dot(&product) / rate_density;
        if square < LIKELY {
            return Some(Slope::default());
        }
        let noise = covariance.trace() / 3.0 * rate_density;
        let own = (found.norm_squared() / 3.0 - noise).max(0.0);
        // The three slopes are equally well known to a few per cent, so that one factor shrinks them all.
        let share = own / (own + noise);
        Some(Slope {
            rate: found * (share / UNIT_S),
            variance: share * noise / (UNIT_S * UNIT_S),
            certain: square > CERTAIN,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(slope: f32, noise: f32) -> Slope {
        let mut drift = Drift::default();
        for rest in 0..18 {
            let t_s = 11.0 * rest as f32 - 93.5;
            // Fixed, and of unit variance.
            let draw = |axis: usize| libm::sinf((7 * rest + 3 * axis) as f32 * 1.7) * core::f32::consts::SQRT_2;
            let rate = Vector3::from_fn(|axis, _| slope * t_s + noise * draw(axis));
            drift.take(&rate, &Matrix3::identity(), t_s, 2.5);
        }
        drift.slope(2.5 * noise * noise, 5e-5).expect("rests")
    }

    #[test]
    fn a_drift_is_found_and_noise_is_not() {
        let steep = seen(2.6e-6, 8e-5);
        assert!(steep.certain && (steep.rate / 2.6e-6 - Vector3::repeat(1.0)).amax() < 0.3, "{steep:?}");
        let none = seen(0.0, 8e-5);
        assert!(!none.certain && none.rate.amax() < 3e-7, "{none:?}");
        assert_eq!(Drift::default().slope(1e-8, 5e-5), None);
    }
}
