//! The twin: a simulated session that follows a recording, predicts every channel from nothing but the nominal sensor and
//! the motion it found, and says by how much each prediction failed, in sigmas.
//!
//! The rows it returns are innovations of a Kalman filter over the full error state. Under the nominal model they are
//! independent standard normals, with every nuisance (calibration, attitude, lever arm, stops) already marginalised; a
//! candidate effect of size θ shifts them by `responses · θ`. That makes every test a linear regression.

pub mod column;
pub mod data;
pub mod edges;
pub mod influence;
mod nodes;
pub mod noise;
pub mod rows;
mod scatter;
pub mod state;
pub mod step;
pub mod steps;
pub mod trajectory;
pub mod visit;
mod walk;

use tumble_core::estimate::Conditions;
use tumble_core::setup::{BoxFaces, TurnStops};

use column::Column;
use data::{Arrival, Deed, Raw, Stretch};
use noise::Noise;
use rows::Rows;
use state::State;
use steps::Steps;
use trajectory::{Nominal, Trajectory};

/// Passes until nothing moves: each is a Gauss–Newton step from the device's result, which is near. They converge by a factor
/// of 10 to 20 each.
const PASSES: usize = 5;
/// What is small against every sigma: an element of a matrix is known to 2e-5 at best.
const CONVERGED: f64 = 1e-7;

/// What was known before, about the start.
#[derive(Clone, Copy, Debug)]
pub struct Prior {
    /// Where it stands.
    pub start: Nominal,
    /// Frame "accelerometer": elements above the diagonal are zero by definition.
    pub triangular: bool,
    /// Earth's rate, each component, rad/s.
    pub earth_sigma: f64,
    /// A lever arm that is nothing to speak of, each component, m.
    pub lever_sigma_m: f64,
}

/// A table leans by less than this, rad (6°), and so does what lies on it.
const LYING_RAD: f64 = 0.105;
/// Prior of a correction's element (`docs/method.md`, "Priors and observability").
const CORRECTION_SIGMA: f64 = 0.06;
const GYRO_BIAS_SIGMA: f64 = 0.1;
const ACCEL_BIAS_SIGMA: f64 = 0.8;
/// Earth's rate may point anywhere: 7.29e-5 rad/s over √3.
const EARTH_SIGMA: f64 = 4.2e-5;

impl Prior {
    /// Mean and covariance of the parameters about `nominal`.
    fn apply(&self, mut state: State, nominal: &Nominal) -> State {
        state.reset(state::GYRO, 9, CORRECTION_SIGMA);
        state.reset(state::ACCEL, 9, CORRECTION_SIGMA);
        state.reset(state::GYRO_BIAS, 3, GYRO_BIAS_SIGMA);
        state.reset(state::ACCEL_BIAS, 3, ACCEL_BIAS_SIGMA);
        state.reset(state::LEVER, 3, self.lever_sigma_m);
        let difference = [
            (state::GYRO, state::by_rows(&(self.start.gyro - nominal.gyro)).collect()),
            (state::ACCEL, state::by_rows(&(self.start.accel - nominal.accel)).collect::<Vec<_>>()),
            (state::GYRO_BIAS, (self.start.gyro_bias - nominal.gyro_bias).as_slice().to_vec()),
            (state::ACCEL_BIAS, (self.start.accel_bias - nominal.accel_bias).as_slice().to_vec()),
        ];
        for (first, values) in difference {
            values.iter().enumerate().for_each(|(offset, value)| state.mean[first + offset] = *value);
        }
        if self.triangular {
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                state.reset(state::ACCEL + 3 * i + j, 1, 0.0);
            }
        }
        state
    }
}

/// What a pass works on.
struct Pass<'a> {
    stretches: &'a [Stretch],
    trajectory: &'a Trajectory,
    steps: &'a Steps,
    nominal: &'a Nominal,
    noise: &'a Noise,
    force_scale: &'a [f64],
    prior: &'a Prior,
}

/// A recording with its fitted nominal sensor.
pub struct Twin {
    /// As read, less what accepted effects put in.
    pub samples: Vec<Raw>,
    /// What happened when.
    pub stretches: Vec<Stretch>,
    /// Fitted.
    pub nominal: Nominal,
    /// About it.
    pub trajectory: Trajectory,
    /// Of the filter, about it.
    pub steps: Steps,
    /// In force.
    pub noise: Noise,
    /// How turns end.
    pub stops: TurnStops,
    /// m/s².
    pub gravity_mps2: f64,
    /// How moves ended, as the device's estimator saw it.
    pub arrivals: Vec<Arrival>,
    /// Per segment: how much noisier than in the quiet rests its specific force is.
    pub force_scale: Vec<f64>,
    prior: Prior,
}

impl Twin {
    /// From a start near the truth, such as the device's estimate.
    pub fn new(
        samples: Vec<Raw>,
        stretches: Vec<Stretch>,
        start: Nominal,
        (noise, arrivals): (Noise, Vec<Arrival>),
        conditions: &Conditions,
    ) -> Self {
        let gravity_mps2 = f64::from(conditions.gravity_mps2);
        let triangular = conditions.faces == BoxFaces::Unknown;
        let lever_sigma_m = noise::LEVER_SIGMA_M;
        let prior = Prior { start, triangular, earth_sigma: EARTH_SIGMA, lever_sigma_m };
        let trajectory = Trajectory::new(&samples, &stretches, &start, gravity_mps2);
        let mut twin = Self {
            samples,
            stretches,
            nominal: start,
            trajectory,
            steps: Steps::default(),
            noise,
            stops: conditions.stops,
            gravity_mps2,
            arrivals,
            force_scale: Vec::new(),
            prior,
        };
        if !twin.lies_on_a_table() {
            twin.noise.facet_sigma_rad = None;
            // Nor does what looks like a turn happen on one: a hand's own accelerations are in it.
            for stretch in twin.stretches.iter_mut().filter(|stretch| matches!(stretch.deed, Deed::Turn { .. })) {
                stretch.deed = Deed::Move;
            }
            twin.trajectory = Trajectory::new(&twin.samples, &twin.stretches, &start, twin.gravity_mps2);
        }
        twin.force_scale = scatter::force_scales(&twin);
        twin.fit();
        twin
    }

    /// Do the rests lie on faces, as against poses that come near one by chance? A random direction is within `LYING_RAD`
    /// of one of six in 1 case of 80.
    fn lies_on_a_table(&self) -> bool {
        let (mut lying, mut all) = (0, 0);
        for stretch in self.stretches.iter().filter(|stretch| stretch.is_rest()) {
            let force = self.trajectory.moments[stretch.samples.start].force;
            let largest = force.amax() / force.norm();
            all += 1;
            lying += usize::from(largest > LYING_RAD.cos());
        }
        5 * lying >= 4 * all
    }

    /// Trajectory and steps about the nominal.
    fn follow(&mut self) {
        self.trajectory = Trajectory::new(&self.samples, &self.stretches, &self.nominal, self.gravity_mps2);
        self.steps = Steps::new(&self.samples, &self.stretches, &self.trajectory, &self.nominal, self.gravity_mps2);
    }

    /// Lever arm and Earth as the calibration's own states, as ever, or (`named`) as an effect's numbers and nothing else.
    pub fn leave_to_effect(&mut self, id: &str, named: bool) {
        match id {
            "accel_lever_arm" => self.prior.lever_sigma_m = if named { 0.0 } else { noise::LEVER_SIGMA_M },
            "earth_rotation" => self.prior.earth_sigma = if named { 0.0 } else { EARTH_SIGMA },
            _ => {}
        }
    }

    /// Gauss–Newton from where it stands.
    pub fn fit(&mut self) {
        self.fit_beside(&mut [], &[], |_| Vec::new());
    }

    /// The same beside effects that cannot be taken out of the readings: those of `columns` in `chosen`, at the sizes that each pass's rows
    /// say. (A table that leans anew by 4° would else bend the sensor's axes by a milliradian and more.)
    pub fn fit_beside(&mut self, columns: &mut [Column], chosen: &[usize], sizes: impl Fn(&Rows) -> Vec<f64>) {
        self.follow();
        for _ in 0..PASSES {
            columns.iter_mut().for_each(Column::forget);
            chosen.iter().for_each(|&index| columns[index].make(self));
            let beside: Vec<&Column> = chosen.iter().map(|&index| &columns[index]).collect();
            let (rows, mut state) = self.pass(&beside);
            state.allow_for(&sizes(&rows));
            let step = self.take(&state);
            self.follow();
            if step < CONVERGED {
                break;
            }
        }
        self.force_scale = scatter::force_scales(self);
    }

    /// Adds a pass's mean to the nominal; the largest change.
    fn take(&mut self, state: &State) -> f64 {
        let before = self.nominal;
        let matrix = |first: usize| nalgebra::Matrix3::from_fn(|i, j| state.mean[first + 3 * i + j]);
        self.nominal.gyro += matrix(state::GYRO);
        self.nominal.accel += matrix(state::ACCEL);
        self.nominal.gyro_bias += state.vector(state::GYRO_BIAS);
        self.nominal.accel_bias += state.vector(state::ACCEL_BIAS);
        (self.nominal.gyro - before.gyro).amax().max((self.nominal.accel - before.accel).amax())
    }

    /// Rows about the nominal with the responses of all columns, and where the filter ended.
    fn pass(&self, columns: &[&Column]) -> (Rows, State) {
        let pass = Pass {
            stretches: &self.stretches,
            trajectory: &self.trajectory,
            steps: &self.steps,
            nominal: &self.nominal,
            noise: &self.noise,
            force_scale: &self.force_scale,
            prior: &self.prior,
        };
        walk::Walk::new(&pass, columns).run()
    }

    /// Rows of the nominal with the responses of columns that were made about it ([`Column::make`]).
    pub fn rows(&self, columns: &[&Column]) -> Rows {
        self.pass(columns).0
    }
}
