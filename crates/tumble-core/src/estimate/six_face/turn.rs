//! The gyroscope's 3×3 from whole turns.

use nalgebra::{Matrix3, SVector, Vector3};

use super::{CORRECTION_SIGMA, EARTH_SIGMA, Real, RestRates, Setting, Visit, real, vector, visits};
use crate::face::Face;
use crate::motion::path::whole_turns;
use crate::tape::{Kind, Segment, Tape};

/// Share of a turn's time by which the Earth's horizontal rate does not average out: the box is slow where it starts and stops.
const EARTH_SHARE: f32 = 0.25;

/// One or more whole turns between two stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<T: Real> {
    /// Which axis was up.
    pub face: Face,
    /// Counter-clockwise from above positive.
    pub revolutions: i32,
    /// `∫ raw dt` less the rate at rest, sensor axes, rad.
    pub integral_rad: Vector3<T>,
    /// Time in motion, s: what noise and bias errors were integrated over.
    pub seconds: f32,
    /// Its middle.
    pub middle_us: u64,
    /// Index of the visit it belongs to: stops are shared within one.
    pub visit: usize,
}

#[derive(Clone, Copy)]
struct Path<T: Real> {
    angle_rad: f32,
    integral_rad: Vector3<T>,
    seconds: f32,
    start_us: Option<u64>,
}

impl<T: Real> Path<T> {
    fn none() -> Self {
        Self { angle_rad: 0.0, integral_rad: Vector3::zeros(), seconds: 0.0, start_us: None }
    }

    fn add(&mut self, other: &Self) {
        self.angle_rad += other.angle_rad;
        self.integral_rad += other.integral_rad;
        self.seconds += other.seconds;
        self.start_us = self.start_us.or(other.start_us);
    }
}

/// Calls `take` for every whole turn; one made in steps, with rests between, is a turn.
pub fn turns<T: Real, const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    rest: &RestRates<T>,
    mut take: impl FnMut(&Turn<T>),
) {
    let whole = |angle_rad: f32| whole_turns(angle_rad).filter(|revolutions| *revolutions != 0);
    for (visit_index, visit) in visits(tape).enumerate() {
        let mut open = Path::none();
        for segment in visit.segments(tape) {
            let Kind::OnTable { angle_rad, .. } = segment.kind else { continue };
            let path = integrate(tape, &visit, segment, angle_rad, rest);
            open.add(&path);
            // A whole turn counts whatever was left open before it.
            let found = whole(path.angle_rad).map(|k| (k, path)).or_else(|| whole(open.angle_rad).map(|k| (k, open)));
            let Some((revolutions, path)) = found else { continue };
            take(&Turn {
                face: visit.face,
                revolutions,
                integral_rad: path.integral_rad,
                seconds: path.seconds,
                middle_us: path.start_us.unwrap_or(segment.start_us) / 2 + segment.end_us / 2,
                visit: visit_index,
            });
            open = Path::none();
        }
    }
}

fn integrate<T: Real, const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    visit: &Visit,
    segment: &Segment,
    angle_rad: f32,
    rest: &RestRates<T>,
) -> Path<T> {
    let still = rest.rate(segment.start_us / 2 + segment.end_us / 2, &visit.up());
    let (mut integral_rad, mut seconds) = (Vector3::zeros(), 0.0);
    for record in (usize::from(segment.first)..usize::from(segment.end)).filter_map(|index| tape.record(index)) {
        integral_rad += vector::<T>(&record.rotation_rad) - still * real::<T>(record.dt_s);
        seconds += record.dt_s;
    }
    Path { angle_rad, integral_rad, seconds, start_us: Some(segment.start_us) }
}

/// `raw = S ω + b`, S 3×3 dimensionless, raw in sensor axes, ω in frame b.
///
/// A box on a table turns about its face's normal n, fixed in frame b, at any speed: ω_b = n ψ̇. So
/// `∫ S ω_b dt = S n ∫ ψ̇ dt = S n (2πk + stop error)`: the misaligned axes integrate to `S_ij 2πk` exactly, although
/// each of their readings also contains the turn's whole speed profile, and column j follows by least squares over faces
/// ±j and directions. Nothing else in it needs gravity.
///
/// * The table's **tilt** does nothing at all: n is a direction in the box. Dividing by cos τ is a slip.
/// * A **wobble** of the axis by α is what this form cannot bear: the attitude still comes back, but `∫ ω_b dt` is no
///   rotation. A wobble that goes once a turn over the table is in part constant in the box, where it looks like an
///   off-diagonal element of up to α: 1° leaves 5.7 mrad (sim, rms), and the sigma here does not know of it. Along the axis
///   it costs ½ α², 150 ppm. The same holds for a face that is not square, by [`Setting::facet_sigma_rad`]. Where the axis
///   may wobble, use [`crate::estimate::device`], which follows the attitude through the turn.
/// * The **Earth**'s vertical rate is in [`RestRates`]; the horizontal leaves up to a quarter of its 10 s, 20 µrad.
///
/// Variance of element (i, j): rate noise (variance per second times seconds), the resting rates' covariance with the sign
/// that each turn's direction gives it, the Earth, one face's direction, and on the diagonal the stops: the one between two
/// turns on a face enters both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroMatrix<T: Real> {
    /// S.
    pub matrix: Matrix3<T>,
    /// Of each element.
    pub variance: Matrix3<T>,
    /// Turns that each column stands on.
    pub turns: [u32; 3],
}

/// Sums of one element's regression on turns of angle x: `Σ w x y / Σ w x²`, and how errors enter them.
#[derive(Clone, Copy)]
struct Sums<T: Real> {
    squares: T,
    products: T,
    white: T,
    rest: SVector<T, 7>,
    visit: usize,
    open_stop: T,
    stops: T,
    open_facet: T,
    facets: T,
}

impl<T: Real> Sums<T> {
    fn none() -> Self {
        let zero = T::zero();
        Self {
            squares: zero,
            products: zero,
            white: zero,
            rest: SVector::zeros(),
            visit: usize::MAX,
            open_stop: zero,
            stops: zero,
            open_facet: zero,
            facets: zero,
        }
    }

    fn close_visit(&mut self) {
        self.stops += self.open_stop * self.open_stop;
        self.facets += self.open_facet * self.open_facet;
        self.open_stop = T::zero();
        self.open_facet = T::zero();
    }

    fn take(&mut self, turn: &Turn<T>, axis: usize, noise: T, stop: T, row: &SVector<T, 7>) {
        if turn.visit != self.visit {
            self.close_visit();
            self.visit = turn.visit;
        }
        let angle = T::two_pi() * real(turn.revolutions as f32 * turn.face.sign());
        let weight = angle / (noise + stop);
        self.squares += weight * angle;
        self.products += weight * turn.integral_rad[axis];
        self.white += weight * weight * noise;
        self.rest += row * (weight * real(turn.seconds));
        let from = self.open_stop - weight;
        self.stops += from * from;
        self.open_stop = weight;
        self.open_facet += weight * angle;
    }
}

impl<T: Real> GyroMatrix<T> {
    /// From all turns. A column without any is the identity's, with the prior's sigma.
    pub fn solve<const R: usize, const S: usize>(tape: &Tape<R, S>, setting: &Setting, rest: &RestRates<T>) -> Self {
        let mut sums = [[Sums::none(); 3]; 3];
        let mut count = [0; 3];
        turns(tape, rest, |turn| {
            let column = turn.face.axis();
            count[column] += 1;
            let up = vector::<T>(&turn.face.normal());
            for (row, sums) in sums.iter_mut().enumerate() {
                let white = setting.noise.rate_density * setting.noise.turn_scale * turn.seconds;
                let earth = EARTH_SIGMA * EARTH_SHARE * turn.seconds;
                let stop = 2.0 * setting.stop_sigma_rad * setting.stop_sigma_rad;
                let (noise, stop) = if row == column { (white, stop) } else { (white + earth * earth, 0.0) };
                sums[column].take(turn, row, real(noise), real(stop), &rest.row(row, turn.middle_us, &up));
            }
        });
        let mut result = Self { matrix: Matrix3::identity(), variance: Matrix3::zeros(), turns: count };
        for (row, sums) in sums.iter_mut().enumerate() {
            for (column, sums) in sums.iter_mut().enumerate() {
                result.element(row, column, sums, setting, rest);
            }
        }
        result
    }

    fn element(&mut self, row: usize, column: usize, sums: &mut Sums<T>, setting: &Setting, rest: &RestRates<T>) {
        sums.close_visit();
        if sums.squares <= T::zero() {
            self.variance[(row, column)] = real(CORRECTION_SIGMA * CORRECTION_SIGMA);
            return;
        }
        self.matrix[(row, column)] = sums.products / sums.squares;
        let square = |sigma: f32| real::<T>(sigma * sigma);
        let own = if row == column {
            sums.stops * square(setting.stop_sigma_rad)
        } else {
            sums.facets * square(setting.facet_sigma_rad)
        };
        let resting = sums.rest.dot(&(rest.covariance * sums.rest));
        self.variance[(row, column)] = (sums.white + resting + own) / (sums.squares * sums.squares);
    }
}
