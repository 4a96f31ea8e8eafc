//! The Cramér–Rao bound of a simulated session, in `f64`.
//!
//! For a linear Gaussian model the covariance of the Kalman filter *is* the inverse of the Fisher information, and a
//! model linearised about the truth gives the bound of the non-linear problem. So this is the covariance alone of the filter
//! of `docs/method.md` §4, run along the true trajectory:
//!
//! - frame n, `φ ← φ + R (δM M⁻¹ω − M δb) dt − δΩ dt`, with the gyroscope's true density as process noise, `R M Mᵀ Rᵀ q dt`;
//! - at rest the attitude stands, the rate is seen with density q and gravity with density r;
//! - in turns gravity is seen through the lever every `STEP_S`, in moves by hand not at all;
//! - faces of a square box lie on the plate exactly, and in turns as well where the simulation's hands do not wobble;
//!   stops have the simulation's own spread.
//!
//! Assumed known, which no estimator is told: both densities, that the hands do not wobble, when the box rests to the sample, that the axis of all turns
//! passes through one point of the box, that nothing trembles. Assumed unknown, though a person may know it: the lever
//! (5 cm prior), the Earth's rate (three components), headings of visits. Priors are the device's; without them the
//! bound would be larger by less than 1e-4.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use tumble_core::estimate::PARAMETERS;
use tumble_core::procedure::BoxFaces;
use tumble_sim::motion::{Kind, Segment, Stops};
use tumble_sim::sensor::FrameTruth;
use tumble_sim::{Recording, SchemeConfig};

use super::truth::{matrix, up_face};
use crate::reference::{ACCEL_BIAS_SIGMA, CORRECTION_SIGMA};

const PHI: usize = 0;
const GYRO: usize = 3;
const GYRO_BIAS: usize = 12;
const ACCEL: usize = 15;
const ACCEL_BIAS: usize = 24;
const LEVER: usize = 27;
const TABLE: usize = 30;
const EARTH: usize = 32;
const FENCE: usize = 35;
const STATES: usize = 36;
/// A lever that nobody measured, m: the device's prior.
const LEVER_SIGMA_M: f64 = 0.05;
/// Steps of motion, s: 1.8° of a turn.
const STEP_S: f64 = 0.05;
/// Variance of what is exact, rad²: 0.1 µrad, which `f64` still resolves against a prior of 0.1 rad.
const EXACT: f64 = 1e-14;

type Row = SVector<f64, STATES>;

/// Covariance of the 24 parameters in the order of [`PARAMETERS`]; rows of what the frame fixes are zero.
pub fn bound(config: &SchemeConfig, recording: &Recording, faces: BoxFaces) -> SMatrix<f64, PARAMETERS, PARAMETERS> {
    bound_knowing(config, recording, faces, Knowledge::default())
}

/// What is known of turns.
#[derive(Clone, Copy, Debug)]
pub struct Knowledge {
    /// Sigma of the lever, m.
    pub lever_sigma_m: f64,
    /// That a box on a table turns about its face's normal.
    pub axis: bool,
}

impl Default for Knowledge {
    fn default() -> Self {
        Self { lever_sigma_m: LEVER_SIGMA_M, axis: true }
    }
}

/// The same for one who knows more or less of turns.
pub fn bound_knowing(
    config: &SchemeConfig,
    recording: &Recording,
    faces: BoxFaces,
    knowledge: Knowledge,
) -> SMatrix<f64, PARAMETERS, PARAMETERS> {
    let mut bound = Bound::new(config, recording, faces);
    bound.axis = knowledge.axis && bound.square && config.world.motion.hands.wobble_deg == 0.0;
    let lever_sigma_m = knowledge.lever_sigma_m;
    bound.covariance.fixed_view_mut::<3, 3>(LEVER, LEVER).fill_diagonal(lever_sigma_m * lever_sigma_m);
    for segment in recording.world.motion.segments() {
        bound.walk(segment);
    }
    let order: Vec<usize> =
        (ACCEL_BIAS..LEVER).chain(ACCEL..ACCEL_BIAS).chain(GYRO_BIAS..ACCEL).chain(GYRO..GYRO_BIAS).collect();
    SMatrix::from_fn(|i, j| bound.covariance[(order[i], order[j])])
}

struct Bound<'a> {
    recording: &'a Recording,
    covariance: SMatrix<f64, STATES, STATES>,
    square: bool,
    /// Do faces stay on the plate in turns?
    axis: bool,
    /// Of the result's frame in the box.
    rotation_b_from_f: Matrix3<f64>,
    gyro: Matrix3<f64>,
    accel: Matrix3<f64>,
    rate_density: f64,
    force_density: f64,
    stop_variance: f64,
    gravity: f64,
    end_s: f64,
    visited: Option<usize>,
}

impl<'a> Bound<'a> {
    fn new(config: &SchemeConfig, recording: &'a Recording, faces: BoxFaces) -> Self {
        let square = faces == BoxFaces::Square;
        let truth = &recording.truth;
        let frame: &FrameTruth = if square { &truth.in_box } else { &truth.in_accelerometer_frame };
        let rotation_a_from_b = matrix(&truth.rotation_accelerometer_from_box);
        let noise = config.world.sensor.noise;
        Self {
            recording,
            covariance: prior(square),
            square,
            axis: false,
            rotation_b_from_f: if square { Matrix3::identity() } else { rotation_a_from_b.transpose() },
            gyro: matrix(&frame.gyroscope.correction),
            accel: matrix(&frame.accelerometer.correction),
            // One-sided densities: the variance of a mean over T is half of their square over T.
            rate_density: 0.5 * noise.gyro_density().powi(2),
            force_density: 0.5 * noise.accel_density().powi(2),
            stop_variance: stop_variance(config.world.motion.hands.stops).max(EXACT),
            gravity: config.world.gravity_mps2,
            end_s: recording.samples.last().map_or(0.0, |sample| sample.t_s),
            visited: None,
        }
    }

    fn walk(&mut self, segment: &Segment) {
        let (start_s, end_s) = (segment.start_s.max(0.0), segment.end_s().min(self.end_s));
        if end_s - start_s < 1e-6 {
            return;
        }
        if segment.kind() == Kind::Rest {
            self.rest(start_s, end_s);
            return;
        }
        let steps = ((end_s - start_s) / STEP_S).ceil();
        let dt = (end_s - start_s) / steps;
        for step in 0..steps as usize {
            let middle_s = start_s + (step as f64 + 0.5) * dt;
            self.drive(middle_s, dt);
            if segment.kind() == Kind::Turn {
                self.gravity(middle_s, dt, true);
                if let Some((_, normal_n)) = self.lying_face(middle_s).filter(|_| self.axis) {
                    self.plate(&normal_n);
                }
            }
        }
        if segment.kind() != Kind::Turn {
            self.visited = None;
        }
    }

    fn rest(&mut self, start_s: f64, end_s: f64) {
        let (middle_s, duration_s) = (0.5 * (start_s + end_s), end_s - start_s);
        self.gravity(middle_s, duration_s, false);
        self.rate(middle_s, duration_s);
        let Some((face, normal_n)) = self.lying_face(middle_s) else { return };
        if self.square {
            self.plate(&normal_n);
        }
        self.stop(face, &normal_n);
    }

    /// Which face is up, and its normal in frame n.
    fn lying_face(&self, t_s: f64) -> Option<(usize, Vector3<f64>)> {
        let up_f = self.rotation_n_from_f(t_s).row(2).transpose();
        let (face, normal_b) = up_face(&(self.rotation_b_from_f * up_f))?;
        Some((face, self.recording.world.true_attitude(t_s) * normal_b))
    }

    fn rotation_n_from_f(&self, t_s: f64) -> Matrix3<f64> {
        self.recording.world.true_attitude(t_s).to_rotation_matrix().into_inner() * self.rotation_b_from_f
    }

    /// Attitude takes up the gyroscope's errors and its noise.
    fn drive(&mut self, t_s: f64, dt: f64) {
        let to_n = self.rotation_n_from_f(t_s);
        let rate_b = self.recording.world.ideal(t_s).angular_rate_rad_s;
        let raw = solved(&self.gyro, &(self.rotation_b_from_f.transpose() * rate_b));
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        for (axis, column) in (0..3).flat_map(|axis| (0..3).map(move |column| (axis, column))) {
            let entry = to_n.column(axis) * raw[column] * dt;
            transition.fixed_view_mut::<3, 1>(PHI, GYRO + 3 * axis + column).copy_from(&entry);
        }
        let taken = to_n * self.gyro;
        transition.fixed_view_mut::<3, 3>(PHI, GYRO_BIAS).copy_from(&(taken * -dt));
        transition.fixed_view_mut::<3, 3>(PHI, EARTH).copy_from(&(Matrix3::identity() * -dt));
        // Only the rows of φ differ from the identity's.
        let rows = transition.fixed_rows::<3>(PHI) * self.covariance;
        let own =
            rows * transition.fixed_rows::<3>(PHI).transpose() + taken * taken.transpose() * (self.rate_density * dt);
        self.covariance.fixed_rows_mut::<3>(PHI).copy_from(&rows);
        self.covariance.fixed_columns_mut::<3>(PHI).copy_from(&rows.transpose());
        self.covariance.fixed_view_mut::<3, 3>(PHI, PHI).copy_from(&own);
    }

    /// `−R δA A⁻¹f + R A δa − g φ × ẑ + R L l`, seen along the accelerometer's own axes, whose noises are independent.
    fn gravity(&mut self, t_s: f64, dt: f64, turning: bool) {
        let to_n = self.rotation_n_from_f(t_s);
        let ideal = self.recording.world.ideal(t_s);
        let to_f = self.rotation_b_from_f.transpose();
        let raw = solved(&self.accel, &(to_f * ideal.specific_force_mps2));
        let mut rows = SMatrix::<f64, 3, STATES>::zeros();
        for (axis, column) in (0..3).flat_map(|axis| (0..3).map(move |column| (axis, column))) {
            rows.set_column(ACCEL + 3 * axis + column, &(to_n.column(axis) * -raw[column]));
        }
        rows.fixed_columns_mut::<3>(ACCEL_BIAS).copy_from(&(to_n * self.accel));
        rows.fixed_columns_mut::<3>(PHI).copy_from(&(Vector3::z().cross_matrix() * self.gravity));
        if turning {
            let rate = (to_f * ideal.angular_rate_rad_s).cross_matrix();
            let acceleration = (to_f * self.recording.world.motion.at(t_s).spin.accel).cross_matrix();
            rows.fixed_columns_mut::<3>(LEVER).copy_from(&(to_n * (rate * rate + acceleration)));
        }
        let to_sensor = (to_n * self.accel).try_inverse().unwrap_or_else(Matrix3::identity);
        self.observe_rows(&(to_sensor * rows), self.force_density / dt);
    }

    /// `M δb + Rᵀ δΩ`, seen along the gyroscope's axes.
    fn rate(&mut self, t_s: f64, dt: f64) {
        let mut rows = SMatrix::<f64, 3, STATES>::zeros();
        rows.fixed_columns_mut::<3>(GYRO_BIAS).copy_from(&Matrix3::identity());
        let to_sensor = self.gyro.try_inverse().unwrap_or_else(Matrix3::identity);
        rows.fixed_columns_mut::<3>(EARTH).copy_from(&(to_sensor * self.rotation_n_from_f(t_s).transpose()));
        self.observe_rows(&rows, self.rate_density / dt);
    }

    /// `p = (φ × n)ₓᵧ`.
    fn plate(&mut self, normal_n: &Vector3<f64>) {
        for axis in 0..2 {
            let mut row = Row::zeros();
            row[TABLE + axis] = 1.0;
            let turned = -normal_n.cross_matrix();
            (0..3).for_each(|i| row[PHI + i] = -turned[(axis, i)]);
            self.observe(&row, EXACT);
        }
    }

    /// A visit's first stop is remembered, a later one compared with it.
    fn stop(&mut self, face: usize, normal_n: &Vector3<f64>) {
        let mut row = Row::zeros();
        row.fixed_rows_mut::<3>(PHI).copy_from(normal_n);
        if self.visited == Some(face) {
            row[FENCE] = -1.0;
            self.observe(&row, self.stop_variance);
            return;
        }
        self.visited = Some(face);
        let copied = self.covariance * row;
        let own = row.dot(&copied) + self.stop_variance;
        self.covariance.set_column(FENCE, &copied);
        self.covariance.set_row(FENCE, &copied.transpose());
        self.covariance[(FENCE, FENCE)] = own;
    }

    fn observe_rows(&mut self, rows: &SMatrix<f64, 3, STATES>, variance: f64) {
        for axis in 0..3 {
            self.observe(&rows.row(axis).transpose(), variance);
        }
    }

    fn observe(&mut self, row: &Row, variance: f64) {
        let column = self.covariance * row;
        let innovation = row.dot(&column) + variance;
        self.covariance -= column * column.transpose() / innovation;
    }
}

/// The device's, with what the frame fixes at zero.
fn prior(square: bool) -> SMatrix<f64, STATES, STATES> {
    let mut sigma = Row::zeros();
    sigma.fixed_rows_mut::<2>(PHI).fill(0.1);
    sigma.fixed_rows_mut::<9>(GYRO).fill(CORRECTION_SIGMA);
    sigma.fixed_rows_mut::<3>(GYRO_BIAS).fill(0.1);
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        sigma[ACCEL + 3 * i + j] = if square || j <= i { CORRECTION_SIGMA } else { 0.0 };
    }
    sigma.fixed_rows_mut::<3>(ACCEL_BIAS).fill(ACCEL_BIAS_SIGMA);
    sigma.fixed_rows_mut::<3>(LEVER).fill(LEVER_SIGMA_M);
    sigma.fixed_rows_mut::<2>(TABLE).fill(0.1);
    sigma.fixed_rows_mut::<3>(EARTH).fill(5e-5);
    SMatrix::from_diagonal(&sigma.map(|sigma| sigma * sigma))
}

/// Of one stop, rad².
fn stop_variance(stops: Stops) -> f64 {
    match stops {
        Stops::Exact => 0.0,
        Stops::Fenced { half_width_deg } => half_width_deg.to_radians().powi(2) / 3.0,
        Stops::ByHand { closure_sigma_deg } => closure_sigma_deg.to_radians().powi(2) / 2.0,
    }
}

fn solved(matrix: &Matrix3<f64>, right: &Vector3<f64>) -> Vector3<f64> {
    matrix.lu().solve(right).unwrap_or(*right)
}
