//! The gyroscope's bias from rests.

use nalgebra::{SMatrix, SVector, Vector3};

use super::{EARTH_SIGMA, Real, Setting, real, vector};
use crate::estimate::noise;
use crate::motion::means::{mean_force, mean_rate};
use crate::tape::{Segment, Tape};

/// Three biases, three drifts, one Earth.
const UNKNOWNS: usize = 7;
/// Priors: a bias (10 °/s), its drift over the whole session (60 mdps), rad/s.
const BIAS_SIGMA: f32 = 0.17;
const DRIFT_SIGMA: f32 = 1e-3;

/// The raw rate at rest, sensor axes, rad/s:
///
/// ```text
/// rate(t, up) = b + d (t − t₀)/T + Ω_v up        b, d: 3, Ω_v: 1, up: 3 (unit, from the specific force)
/// ```
///
/// t₀ is the rests' mean time, T the session's length. Opposite faces tell Ω_v from b. The Earth's horizontal rate has an
/// unknown heading and counts as noise: 4.2e-5 rad/s on each component square to up, once for two rests on a face.
/// Errors: white noise over the rest, this horizontal rate, and what of the drift is not a straight line, by which the
/// covariance is inflated (χ² per degree of freedom where it is above 1).
#[derive(Clone, Debug, PartialEq)]
pub struct RestRates<T: Real> {
    /// b, d, Ω_v.
    pub unknowns: SVector<T, UNKNOWNS>,
    /// Of these.
    pub covariance: SMatrix<T, UNKNOWNS, UNKNOWNS>,
    /// Before inflation.
    pub chi2_per_dof: T,
    origin_us: u64,
    span_s: f32,
}

impl<T: Real> RestRates<T> {
    /// From all rests on something solid; none if there is no such rest.
    pub fn solve<const R: usize, const S: usize>(tape: &Tape<R, S>, setting: &Setting) -> Option<Self> {
        let rests = || {
            let solid = |s: &&Segment| s.is_usable_still() && noise::is_solid(s, setting.noise.quiet_variance);
            tape.segments().iter().filter(solid)
        };
        let (origin_us, span_s) = middle(rests())?;
        let mut fit = Self {
            unknowns: SVector::zeros(),
            covariance: SMatrix::zeros(),
            chi2_per_dof: T::one(),
            origin_us,
            span_s,
        };
        let mut information = SMatrix::<T, UNKNOWNS, UNKNOWNS>::zeros();
        for axis in 0..3 {
            information[(axis, axis)] = real(1.0 / (BIAS_SIGMA * BIAS_SIGMA));
            information[(3 + axis, 3 + axis)] = real(1.0 / (DRIFT_SIGMA * DRIFT_SIGMA));
        }
        information[(6, 6)] = real(1.0 / (EARTH_SIGMA * EARTH_SIGMA));
        let mut sums = SVector::<T, UNKNOWNS>::zeros();
        for segment in rests() {
            fit.for_each_axis(tape, segment, setting, |row, rate, variance| {
                information += row * row.transpose() / variance;
                sums += row * (rate / variance);
            });
        }
        fit.covariance = information.cholesky()?.inverse();
        fit.unknowns = fit.covariance * sums;
        fit.inflate(tape, setting, rests());
        Some(fit)
    }

    fn for_each_axis<const R: usize, const S: usize>(
        &self,
        tape: &Tape<R, S>,
        segment: &Segment,
        setting: &Setting,
        mut take: impl FnMut(SVector<T, UNKNOWNS>, T, T),
    ) {
        let (first, end) = (usize::from(segment.first), usize::from(segment.end));
        let rate = vector::<T>(&mean_rate(tape, first, end));
        let up = vector::<T>(&mean_force(tape, first, end)).normalize();
        let white: T = real(setting.noise.rate_density / segment.duration_s());
        let horizontal: T = real(2.0 * EARTH_SIGMA * EARTH_SIGMA);
        for axis in 0..3 {
            let row = self.row(axis, segment.start_us / 2 + segment.end_us / 2, &up);
            take(row, rate[axis], white + horizontal * (T::one() - up[axis] * up[axis]));
        }
    }

    fn inflate<'a, const R: usize, const S: usize>(
        &mut self,
        tape: &Tape<R, S>,
        setting: &Setting,
        rests: impl Iterator<Item = &'a Segment>,
    ) {
        let (mut chi2, mut count) = (T::zero(), T::zero());
        for segment in rests {
            self.for_each_axis(tape, segment, setting, |row, rate, variance| {
                let residual = rate - row.dot(&self.unknowns);
                chi2 += residual * residual / variance;
                count += T::one();
            });
        }
        self.chi2_per_dof = chi2 / (count - real(UNKNOWNS as f32)).max(T::one());
        self.covariance *= self.chi2_per_dof.max(T::one());
    }

    /// How one component of the rate depends on the unknowns.
    pub fn row(&self, axis: usize, t_us: u64, up: &Vector3<T>) -> SVector<T, UNKNOWNS> {
        let mut row = SVector::zeros();
        row[axis] = T::one();
        row[3 + axis] = real((t_us as i64 - self.origin_us as i64) as f32 * 1e-6 / self.span_s);
        row[6] = up[axis];
        row
    }

    /// The raw rate of a box at rest with `up` (unit, frame b), rad/s, sensor axes.
    pub fn rate(&self, t_us: u64, up: &Vector3<T>) -> Vector3<T> {
        Vector3::from_fn(|axis, _| self.row(axis, t_us, up).dot(&self.unknowns))
    }

    /// In the middle of the session, rad/s.
    pub fn bias(&self) -> Vector3<T> {
        self.unknowns.fixed_rows::<3>(0).into_owned()
    }

    /// Of [`Self::bias`].
    pub fn bias_variance(&self) -> Vector3<T> {
        self.covariance.diagonal().fixed_rows::<3>(0).into_owned()
    }
}

/// Mean time of the rests, µs, and the session's length, s.
fn middle<'a>(rests: impl Iterator<Item = &'a Segment>) -> Option<(u64, f32)> {
    let (mut first, mut last, mut sum_s, mut weight_s) = (None, 0, 0.0f32, 0.0f32);
    for rest in rests {
        let first = *first.get_or_insert(rest.start_us);
        last = rest.end_us;
        let middle_s = (rest.start_us / 2 + rest.end_us / 2).saturating_sub(first) as f32 * 1e-6;
        sum_s += middle_s * rest.duration_s();
        weight_s += rest.duration_s();
    }
    let first = first?;
    let origin_us = first + (sum_s / weight_s.max(1e-3) * 1e6) as u64;
    Some((origin_us, (last.saturating_sub(first) as f32 * 1e-6).max(1.0)))
}
