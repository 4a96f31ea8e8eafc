//! What rates at rest say of the gyroscope's bias over the session: a straight drift, and a part that follows the specific force.
//!
//! In sensor axes a rest's mean rate is `b + s t + G f + Rᵀ Ω`. A warming sensor drifts one way: from rest to rest that is lost in noise
//! (2 mdps against 5), over a session it is eight sigma, and taken for a walk it costs all that hangs on the bias between rests.
//! The slopes' common variance is their mean square less what noise makes of it (empirical Bayes): without a drift they shrink
//! to nothing. G, the sensitivity to force, is 0.1 °/s a g on a sibling of this sensor (MPU-6000 sheet): six faces then show six
//! rates. It is one of two accounts of the same rests, and which of them stands is for their likelihoods to say (`wander.rs`),
//! because a bias that walks differs from face to face as well.

use nalgebra::{Matrix3, Vector3};

use super::normal::{Normal, Unknowns};
use crate::DEGREE_RAD;
use crate::calibration::GSensitivity;

/// Unit of time, s.
const UNIT_S: f32 = 100.0;
/// Upper 5 % and 0.1 % points of χ²₃: a slope is used from the first on, and said from the second.
const LIKELY: f32 = 7.815;
const CERTAIN: f32 = 16.27;
/// Upper 0.1 % point of χ²₉: what twice the logarithm of the likelihoods' ratio must exceed for the account with G to stand.
pub const FELT: f32 = 27.88;
/// Prior of an element of G, (rad/s)/g: twice the sheet's. It is taken where the data leave at most a tenth of that.
const SENSITIVITY_SIGMA: f32 = 0.2 * DEGREE_RAD;
const DETERMINED: f32 = 0.1;

/// Where the unknowns stand: bias, Earth, slope, sensitivity by rows, and what was observed.
const EARTH: usize = 3;
const SLOPE: usize = 6;
const FORCE: usize = 9;
const SEEN: usize = 18;
const SLOPES: Unknowns = Unknowns::range(SLOPE, FORCE);

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

/// One account of the rates at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// How the bias drifts.
    pub slope: Slope,
    /// How it follows the specific force; zero in the account that leaves it out.
    pub sensitivity: GSensitivity,
    /// Bias at the session's middle less the nominal one, rad/s, and its sigma.
    pub bias: Vector3<f32>,
    /// See [`Self::bias`].
    pub bias_sigma: Vector3<f32>,
}

impl Account {
    /// What a rate at rest has of it at this time from the session's middle, under this specific force (m/s²).
    pub fn rate(&self, t_s: f32, force: &Vector3<f32>) -> Vector3<f32> {
        self.slope.rate * t_s + self.sensitivity.matrix * force
    }
}

/// Sums over a pass: bias 3, Earth 3, slope 3, sensitivity 9 by rows, observed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resting {
    normal: Normal<19>,
    /// Stays on a face or in a pose.
    pub visits: f32,
}

impl Resting {
    /// Mean rate of a rest less the nominal bias, with its variance; `to_b = Rᵀ`, at `t_s` from the session's middle, the specific force
    /// in g. `anew`: the first of a stay.
    pub fn take(
        &mut self,
        (rate, variance): (&Vector3<f32>, f32),
        to_b: &Matrix3<f32>,
        t_s: f32,
        force: &Vector3<f32>,
        anew: bool,
    ) {
        for axis in 0..3 {
            let mut row = [0.0; 19];
            row[axis] = 1.0;
            for component in 0..3 {
                row[EARTH + component] = to_b[(axis, component)];
                row[FORCE + 3 * axis + component] = force[component];
            }
            row[SLOPE + axis] = t_s / UNIT_S;
            row[SEEN] = rate[axis];
            self.normal.take(&row, 1.0 / variance);
        }
        self.visits += if anew { 1.0 } else { 0.0 };
    }

    /// What they come to without a sensitivity; none where rests do not tell. The Earth's rate has a prior.
    pub fn plain(&self, earth_sigma: f32) -> Option<Account> {
        let normal = self.expecting(earth_sigma);
        account(&normal, Unknowns::NONE, GSensitivity::default())
    }

    /// The same with a sensitivity to force, `gravity` in m/s²; none where it is not determined.
    pub fn felt(&self, earth_sigma: f32, gravity: f32) -> Option<Account> {
        let mut normal = self.expecting(earth_sigma);
        (FORCE..SEEN).for_each(|unknown| normal.expect(unknown, SENSITIVITY_SIGMA));
        let force = Unknowns::range(FORCE, SEEN);
        let free = model(significance(&normal, force), force);
        let mut sensitivity = GSensitivity::default();
        for (offset, unknown) in (FORCE..SEEN).enumerate() {
            let (value, variance) = normal.marginal(unknown, free)?;
            let sigma = Some(libm::sqrtf(variance)).filter(|sigma| *sigma < DETERMINED * SENSITIVITY_SIGMA)?;
            let place = (offset / 3, offset % 3);
            (sensitivity.matrix[place], sensitivity.sigma[place]) = (value / gravity, sigma / gravity);
        }
        account(&normal, force, sensitivity)
    }

    fn expecting(&self, earth_sigma: f32) -> Normal<19> {
        let mut normal = self.normal;
        (EARTH..SLOPE).for_each(|unknown| normal.expect(unknown, earth_sigma));
        normal
    }
}

/// Unknowns of a model, with slopes where they are significant.
fn model(square: f32, force: Unknowns) -> Unknowns {
    let slopes = if square >= LIKELY { SLOPES } else { Unknowns::NONE };
    Unknowns::range(0, SLOPE).and(slopes).and(force)
}

/// χ²₃ of the three slopes, all else free.
fn significance(normal: &Normal<19>, force: Unknowns) -> f32 {
    let mut left = *normal;
    left.eliminate(model(0.0, force));
    let without = left.at(SEEN, SEEN);
    let (rank, _) = left.eliminate(SLOPES);
    if rank == FORCE - SLOPE { without - left.at(SEEN, SEEN) } else { 0.0 }
}

#[inline(never)]
fn account(normal: &Normal<19>, force: Unknowns, sensitivity: GSensitivity) -> Option<Account> {
    let square = significance(normal, force);
    let free = model(square, force);
    let three = |first: usize| -> Option<[(f32, f32); 3]> {
        let [x, y, z] = [0, 1, 2].map(|axis| normal.marginal(first + axis, free));
        Some([x?, y?, z?])
    };
    let bias = three(0)?;
    let mut account = Account {
        sensitivity,
        bias: bias.map(|(value, _)| value).into(),
        bias_sigma: bias.map(|(_, variance)| libm::sqrtf(variance)).into(),
        slope: Slope::default(),
    };
    if square >= LIKELY {
        let slopes = three(SLOPE)?;
        let rate = Vector3::from(slopes.map(|(value, _)| value));
        let noise = slopes.map(|(_, variance)| variance).iter().sum::<f32>() / 3.0;
        let own = (rate.norm_squared() / 3.0 - noise).max(0.0);
        // The three slopes are equally well known to a few per cent, so that one factor shrinks them all.
        let share = own / (own + noise);
        account.slope = Slope {
            rate: rate * (share / UNIT_S),
            variance: share * noise / (UNIT_S * UNIT_S),
            certain: square > CERTAIN,
        };
    }
    Some(account)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three rests on each of six faces, 11 s apart; fixed noise of unit variance.
    fn seen(slope: f32, sensitivity: &Matrix3<f32>, noise: f32) -> Resting {
        let mut resting = Resting::default();
        for rest in 0..18 {
            let t_s = 11.0 * rest as f32 - 93.5;
            let draw = |axis: usize| libm::sinf((7 * rest + 3 * axis) as f32 * 1.7) * core::f32::consts::SQRT_2;
            let mut force = Vector3::zeros();
            force[(rest / 3) % 3] = if rest < 9 { 1.0 } else { -1.0 };
            let rate = Vector3::from_fn(|axis, _| slope * t_s + noise * draw(axis)) + sensitivity * force;
            resting.take((&rate, noise * noise), &Matrix3::identity(), t_s, &force, rest % 3 == 0);
        }
        resting
    }

    #[test]
    fn a_drift_is_found_and_noise_is_not() {
        let steep = seen(2.6e-6, &Matrix3::zeros(), 8e-5).plain(5e-5).expect("rests").slope;
        assert!(steep.certain && (steep.rate / 2.6e-6 - Vector3::repeat(1.0)).amax() < 0.3, "{steep:?}");
        let none = seen(0.0, &Matrix3::zeros(), 8e-5).plain(5e-5).expect("rests").slope;
        assert!(!none.certain && none.rate.amax() < 3e-7, "{none:?}");
        assert_eq!(Resting::default().plain(5e-5), None);
    }

    #[test]
    fn a_sensitivity_to_force_is_measured_beside_a_drift_and_needs_all_faces() {
        let truth = Matrix3::new(1.0, -0.5, 0.3, 0.2, -0.8, 0.6, -0.4, 0.7, 0.9) * 1e-3;
        let found = seen(2.6e-6, &truth, 8e-5).felt(5e-5, 9.8).expect("six faces");
        let sigmas = (found.sensitivity.matrix * 9.8 - truth).component_div(&(found.sensitivity.sigma * 9.8));
        // 5e-5 rad/s of the Earth's rate about the vertical look like a multiple of the identity, hence the sigmas on the diagonal.
        assert!(sigmas.amax() < 3.0 && found.sensitivity.sigma.max() * 9.8 < 8e-5, "{sigmas} {found:?}");
        assert!(found.slope.certain);
        let mut one_face = Resting::default();
        (0..9).for_each(|rest| {
            let force = Vector3::z();
            one_face.take((&Vector3::zeros(), 6e-9), &Matrix3::identity(), 11.0 * rest as f32, &force, rest == 0);
        });
        assert_eq!(one_face.felt(5e-5, 9.8), None);
        assert!(one_face.plain(5e-5).is_some());
    }
}
