//! What one stay on a face says of gravity.

use nalgebra::{SMatrix, SVector, Vector2, Vector3};

use super::gravity::TILT_SIGMA;
use super::{AccelMatrix, Instant, Real, RestRates, Setting, Tilt, Visit, real, vector};
use crate::motion::means::mean_force;
use crate::tape::{Segment, Tape};

/// Prior of the sensor's distance from the axis, m.
const LEVER_SIGMA_M: f32 = 0.05;
/// c (2), tilt (2), lever (2).
pub(crate) const UNKNOWNS: usize = 6;

/// What a visit says of gravity. In the box's plane (u, v) as complex numbers, θ the heading since the visit's start,
///
/// ```text
/// f = c + t e^(−iθ) + l (−ω² + i ω̇)
/// ```
///
/// c: what turns with the box, wanted; t: the table's tilt, `|t| = g sin τ`, prior 3°; l: from the axis to the sensor, prior
/// 5 cm. Rests say c + t; whole turns, or rests at several headings, tell c from t; and l from c is told by the rests
/// against the turn. Without a turn c is known as well as the tilt's prior. Least squares over the records, weight `dt`
/// over the force's density; turns are weighted by their own scatter (a hand's tremor).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisitFit<T: Real> {
    /// Mean specific force without tilt and lever arm, frame b, m/s².
    pub mean: Vector3<T>,
    /// Of each component, independent.
    pub variance: Vector3<T>,
    /// t, m/s², in (u, v).
    pub tilt: Vector2<T>,
    /// Of one component of t.
    pub tilt_variance: T,
    /// l, m, in (u, v).
    pub lever_m: Vector2<T>,
    /// Of one component of l.
    pub lever_variance: T,
    /// Factor on the specific force's noise at rest and while it turns, at least 1.
    pub force_scale: [T; 2],
    /// Covariance of c with (c, t, l) in (u, v): how a record's noise enters c.
    pub gain: SMatrix<T, 2, UNKNOWNS>,
}

/// Normal equations and the scatter at rest and in turns.
struct Normal<T: Real> {
    information: SMatrix<T, UNKNOWNS, UNKNOWNS>,
    sums: SVector<T, UNKNOWNS>,
    vertical: (T, T),
}

impl Visit {
    /// What this visit says of gravity about the accelerometer's present correction.
    pub fn gravity<T: Real, const R: usize, const S: usize>(
        &self,
        tape: &Tape<R, S>,
        setting: &Setting,
        rest: &RestRates<T>,
        gyro: &nalgebra::Matrix3<T>,
        accel: &AccelMatrix<T>,
        tilt: Tilt,
    ) -> Option<VisitFit<T>> {
        if tilt == Tilt::Leaking {
            return self.first_rest(tape, setting, accel);
        }
        let walk = |take: &mut dyn FnMut(&Segment, &Instant<T>)| self.for_each(tape, rest, gyro, take);
        let mut fit = self.solve(&walk, setting, accel, [T::one(); 2])?;
        let scale = self.scatter(&walk, setting, accel, &fit);
        fit = self.solve(&walk, setting, accel, scale)?;
        Some(fit)
    }

    /// The mean of the first rest, tilt and all.
    fn first_rest<T: Real, const R: usize, const S: usize>(
        &self,
        tape: &Tape<R, S>,
        setting: &Setting,
        accel: &AccelMatrix<T>,
    ) -> Option<VisitFit<T>> {
        let still = self.segments(tape).first()?;
        let raw = mean_force(tape, usize::from(still.first), usize::from(still.end));
        let white: T = real(setting.noise.force_density / still.duration_s());
        Some(VisitFit {
            mean: accel.force(&vector(&raw)),
            variance: Vector3::repeat(white),
            tilt: Vector2::zeros(),
            tilt_variance: T::one(),
            lever_m: Vector2::zeros(),
            lever_variance: T::zero(),
            force_scale: [T::one(); 2],
            gain: SMatrix::zeros(),
        })
    }

    fn solve<T: Real>(
        &self,
        walk: &impl Fn(&mut dyn FnMut(&Segment, &Instant<T>)),
        setting: &Setting,
        accel: &AccelMatrix<T>,
        scale: [T; 2],
    ) -> Option<VisitFit<T>> {
        let mut prior = SVector::<T, UNKNOWNS>::zeros();
        let tilt = TILT_SIGMA * setting.gravity_mps2;
        for (unknown, sigma) in [(2, tilt), (3, tilt), (4, LEVER_SIGMA_M), (5, LEVER_SIGMA_M)] {
            prior[unknown] = real(1.0 / (sigma * sigma));
        }
        let zero = T::zero();
        let mut normal =
            Normal { information: SMatrix::from_diagonal(&prior), sums: SVector::zeros(), vertical: (zero, zero) };
        walk(&mut |_, instant| {
            let weight = weight(setting, &scale, instant);
            let force = self.local(&accel.force(&instant.raw_force_mps2));
            for (row, observed) in rows(instant).iter().zip([force.x, force.y]) {
                normal.information += row * row.transpose() * weight;
                normal.sums += row * (weight * observed);
            }
            normal.vertical.0 += weight * force.z;
            normal.vertical.1 += weight;
        });
        self.fitted(&normal, scale)
    }

    fn fitted<T: Real>(&self, normal: &Normal<T>, scale: [T; 2]) -> Option<VisitFit<T>> {
        let covariance = normal.information.cholesky()?.inverse();
        let x = covariance * normal.sums;
        let [u, v] = self.plane::<T>();
        let up = self.up::<T>();
        let variances = covariance.diagonal();
        let squares = |axis: Vector3<T>| axis.component_mul(&axis);
        let vertical_variance = T::one() / normal.vertical.1;
        Some(VisitFit {
            mean: u * x[0] + v * x[1] + up * (normal.vertical.0 * vertical_variance),
            variance: squares(u) * variances[0] + squares(v) * variances[1] + squares(up) * vertical_variance,
            tilt: Vector2::new(x[2], x[3]),
            tilt_variance: variances[2],
            lever_m: Vector2::new(x[4], x[5]),
            lever_variance: variances[4],
            force_scale: scale,
            gain: covariance.fixed_rows::<2>(0).into_owned(),
        })
    }

    /// Mean squared residual over what noise explains, in the plane, at rest and in turns.
    fn scatter<T: Real>(
        &self,
        walk: &impl Fn(&mut dyn FnMut(&Segment, &Instant<T>)),
        setting: &Setting,
        accel: &AccelMatrix<T>,
        fit: &VisitFit<T>,
    ) -> [T; 2] {
        let c = self.local(&fit.mean);
        let x = SVector::<T, UNKNOWNS>::from([c.x, c.y, fit.tilt.x, fit.tilt.y, fit.lever_m.x, fit.lever_m.y]);
        let mut sums = [(T::zero(), T::zero()); 2];
        walk(&mut |_, instant| {
            let force = self.local(&accel.force(&instant.raw_force_mps2));
            let sum = &mut sums[usize::from(instant.turning)];
            for (row, observed) in rows(instant).iter().zip([force.x, force.y]) {
                let residual = observed - row.dot(&x);
                sum.0 += residual * residual * weight(setting, &[T::one(); 2], instant);
                sum.1 += T::one();
            }
        });
        sums.map(|(chi2, count)| (chi2 / count.max(T::one())).max(T::one()))
    }

    /// Components along u, v and up.
    fn local<T: Real>(&self, vector: &Vector3<T>) -> Vector3<T> {
        let [u, v] = self.plane::<T>();
        Vector3::new(u.dot(vector), v.dot(vector), self.up::<T>().dot(vector))
    }
}

fn weight<T: Real>(setting: &Setting, scale: &[T; 2], instant: &Instant<T>) -> T {
    instant.dt_s / (real::<T>(setting.noise.force_density) * scale[usize::from(instant.turning)])
}

/// The plane's two rows. A mean of e^(−iθ) over a record that turns by Δ is shorter by Δ²/24.
pub(crate) fn rows<T: Real>(instant: &Instant<T>) -> [SVector<T, UNKNOWNS>; 2] {
    let (sin, cos) = instant.heading_rad.sin_cos();
    let turned = instant.rate_rad_s * instant.dt_s;
    let shrink = T::one() - turned * turned / real(24.0);
    let (sin, cos) = (sin * shrink, cos * shrink);
    let square = instant.rate_rad_s * instant.rate_rad_s;
    let growth = instant.acceleration_rad_s2;
    let (one, zero) = (T::one(), T::zero());
    [SVector::from([one, zero, cos, sin, -square, -growth]), SVector::from([zero, one, -sin, cos, growth, -square])]
}
