//! The paper's second step in `f64`: a 15-state error filter `[φ δv δp κ]` with "the position has not changed".
//!
//! `R̂ = exp(φ×) R`, `φ̇ = R̂ N(κ) ω̂`, `δv̇ = φ × f`, `δṗ = δv`, `κ̇ = 0`, with N the matrix of κ, the six off-diagonal
//! elements. What is estimated is fed back at every observation, as a navigation filter usually does (the device's own code
//! is linear about its first step instead: the two share nothing but the equations). While the box is carried its position does change, and nothing is observed.

use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};
use tumble_sim::motion::Kind;
use tumble_sim::{Recording, SchemeConfig};

use super::step_one::StepOne;

const STATES: usize = 15;
/// Samples to an observation: 20 a second.
const EVERY: usize = 10;
/// How well a turntable keeps the sensor's place, m.
const POSITION_SIGMA: f64 = 1e-3;
/// Prior of κ: twice the paper's truth.
const KAPPA_SIGMA: f64 = 0.02;
/// Of the first level, rad: what an accelerometer error of a table's tilt leaves.
const LEVEL_SIGMA: f64 = 0.02;

/// Places of k12 k13 k21 k23 k31 k32.
const PLACES: [(usize, usize); 6] = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];

/// The filter's state of knowledge at a time.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// s.
    pub t_s: f64,
    /// κ.
    pub kappa: SVector<f64, 6>,
    /// Its sigmas.
    pub sigma: SVector<f64, 6>,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Filtered {
    /// N of `ω₁ = (I + N) ω`, ω₁ the rate corrected by step one.
    pub matrix: Matrix3<f64>,
    /// Once a second.
    pub history: Vec<Instant>,
}

struct Filter<'a> {
    step_one: &'a StepOne,
    matrix: Matrix3<f64>,
    kappa: SVector<f64, 6>,
    attitude: UnitQuaternion<f64>,
    velocity: Vector3<f64>,
    position: Vector3<f64>,
    covariance: SMatrix<f64, STATES, STATES>,
    earth: Vector3<f64>,
    gravity: f64,
    densities: (f64, f64),
}

/// Runs it over a recording.
pub fn run(config: &SchemeConfig, recording: &Recording, step_one: &StepOne) -> Filtered {
    let mut filter = Filter::new(config, recording, step_one);
    let segments = recording.world.motion.segments();
    let carried = |t_s: f64| {
        segments
            .iter()
            .any(|segment| segment.kind() == Kind::Carry && (segment.start_s..=segment.end_s()).contains(&t_s))
    };
    let mut history = Vec::new();
    for (k, samples) in recording.samples.windows(EVERY + 1).step_by(EVERY).enumerate() {
        filter.propagate(samples);
        let t_s = samples[EVERY].t_s;
        if !carried(t_s) {
            filter.observe();
        }
        if k % 20 == 0 {
            let sigma = SVector::from_fn(|i, _| filter.covariance[(9 + i, 9 + i)].sqrt());
            history.push(Instant { t_s, kappa: filter.kappa, sigma });
        }
    }
    Filtered { matrix: filter.matrix, history }
}

impl<'a> Filter<'a> {
    fn new(config: &SchemeConfig, recording: &Recording, step_one: &'a StepOne) -> Self {
        let mut sigma = SVector::<f64, STATES>::repeat(1e-4);
        sigma.fixed_rows_mut::<2>(0).fill(LEVEL_SIGMA);
        sigma[2] = 1e-6;
        sigma.fixed_rows_mut::<6>(9).fill(KAPPA_SIGMA);
        let noise = config.world.sensor.noise;
        let truth = recording.world.true_attitude(0.0);
        let first = recording.samples.iter().take_while(|sample| sample.t_s < 0.8 * config.timing.still_s);
        let force: Vector3<f64> = first.map(|sample| step_one.accel.apply(&sample.specific_force_mps2)).sum();
        let level = UnitQuaternion::rotation_between(&(truth * force), &Vector3::z()).unwrap_or_default();
        Self {
            step_one,
            matrix: Matrix3::zeros(),
            kappa: SVector::zeros(),
            attitude: level * truth,
            velocity: Vector3::zeros(),
            position: Vector3::zeros(),
            covariance: SMatrix::from_diagonal(&sigma.map(|sigma| sigma * sigma)),
            earth: recording.world.earth_rate_n(),
            gravity: config.world.gravity_mps2,
            densities: (0.5 * noise.gyro_density().powi(2), 0.5 * noise.accel_density().powi(2)),
        }
    }

    /// Inertial navigation over the samples, and the covariance over all of them at once.
    fn propagate(&mut self, samples: &[tumble_sim::Sample]) {
        let undo = (Matrix3::identity() + self.matrix).try_inverse().unwrap_or_else(Matrix3::identity);
        let mut drive = SMatrix::<f64, 3, 6>::zeros();
        let (mut impulse, mut time_s) = (Vector3::zeros(), 0.0);
        for pair in samples.windows(2) {
            let dt = pair[1].t_s - pair[0].t_s;
            let raw = 0.5 * (pair[0].angular_rate_rad_s + pair[1].angular_rate_rad_s) - self.step_one.gyro_bias;
            let rate = undo * raw.component_div(&self.step_one.scale);
            let force = 0.5 * (pair[0].specific_force_mps2 + pair[1].specific_force_mps2);
            let turn = UnitQuaternion::from_scaled_axis(rate * dt);
            let middle = self.attitude * turn.powf(0.5);
            for (m, (row, column)) in PLACES.into_iter().enumerate() {
                let mut taken = drive.column_mut(m);
                taken += (middle * Vector3::ith(row, rate[column])) * dt;
            }
            let force_n = middle * self.step_one.accel.apply(&force);
            let earth = UnitQuaternion::from_scaled_axis(self.earth * -dt);
            self.attitude = UnitQuaternion::new_normalize((earth * self.attitude * turn).into_inner());
            let acceleration = force_n - Vector3::z() * self.gravity;
            self.position += self.velocity * dt + acceleration * (0.5 * dt * dt);
            self.velocity += acceleration * dt;
            impulse += force_n * dt;
            time_s += dt;
        }
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        transition.fixed_view_mut::<3, 6>(0, 9).copy_from(&drive);
        transition.fixed_view_mut::<3, 3>(3, 0).copy_from(&-impulse.cross_matrix());
        transition.fixed_view_mut::<3, 3>(6, 0).copy_from(&(impulse.cross_matrix() * (-0.5 * time_s)));
        transition.fixed_view_mut::<3, 3>(6, 3).copy_from(&(Matrix3::identity() * time_s));
        self.covariance = transition * self.covariance * transition.transpose();
        for axis in 0..3 {
            self.covariance[(axis, axis)] += self.densities.0 * time_s;
            self.covariance[(3 + axis, 3 + axis)] += self.densities.1 * time_s;
        }
    }

    /// The position has not changed.
    fn observe(&mut self) {
        let mut error = SVector::<f64, STATES>::zeros();
        for axis in 0..3 {
            let column: SVector<f64, STATES> = self.covariance.column(6 + axis).into_owned();
            let variance = column[6 + axis] + POSITION_SIGMA * POSITION_SIGMA;
            let innovation = self.position[axis] - error[6 + axis];
            error += column * (innovation / variance);
            self.covariance -= column * column.transpose() / variance;
        }
        let part = |first: usize| error.fixed_rows::<3>(first).into_owned();
        self.attitude = UnitQuaternion::from_scaled_axis(-part(0)) * self.attitude;
        self.velocity -= part(3);
        self.position -= part(6);
        let kappa = error.fixed_rows::<6>(9).into_owned();
        self.kappa += kappa;
        PLACES.into_iter().zip(kappa.iter()).for_each(|(place, k)| self.matrix[place] += k);
    }
}
