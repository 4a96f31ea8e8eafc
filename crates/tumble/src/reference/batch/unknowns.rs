//! Which unknown stands where, and where all start.

use std::ops::Range;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use tumble_core::calibration::Calibration;
use tumble_core::face::Face;

use super::Setting;
use crate::reference::data::Stretch;
use crate::reference::solve::Block;

/// Gyroscope's correction by rows.
pub(super) const GYRO: usize = 0;
/// Accelerometer's.
pub(super) const ACCEL: usize = 9;
/// From the turns' common axis to the sensor, m.
pub(super) const LEVER: usize = 18;
const GLOBALS: usize = 21;
/// Attitude, gyroscope bias and accelerometer bias of a rest.
const PER_REST: usize = 9;

/// Steps of the differences: rad and 1, rad/s, m/s².
const STEP: f64 = 1e-6;

/// Reads what all of the recording shares.
pub(super) struct Globals;

impl Globals {
    pub fn gyro(x: &[f64]) -> Matrix3<f64> {
        Matrix3::from_row_slice(&x[GYRO..GYRO + 9])
    }

    pub fn accel(x: &[f64]) -> Matrix3<f64> {
        Matrix3::from_row_slice(&x[ACCEL..ACCEL + 9])
    }
}

/// A rest's place among stretches and unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rest {
    pub stretch: usize,
    pub first: usize,
    pub chain: usize,
    /// Unknowns of its chain: the Earth's rate, and the table's two.
    pub earth: usize,
    pub table: usize,
    nominal: UnitQuaternion<f64>,
}

impl Rest {
    pub fn attitude(self) -> usize {
        self.first
    }

    pub fn rate_bias(self) -> usize {
        self.first + 3
    }

    pub fn force_bias(self) -> usize {
        self.first + 6
    }

    pub fn all(self) -> Range<usize> {
        self.first..self.first + PER_REST
    }

    pub fn vector(self, x: &[f64], first: usize) -> Vector3<f64> {
        Vector3::from_column_slice(&x[first..first + 3])
    }

    /// How far a face's normal lies from the vertical, 1; of no face infinitely far.
    pub fn leaning(self, face: Option<Face>) -> f32 {
        face.map_or(f32::INFINITY, |face| (self.nominal * face.normal().cast::<f64>()).xy().norm() as f32)
    }

    /// `exp(x) · nominal`.
    pub fn rotation(self, x: &[f64]) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(self.vector(x, self.first)) * self.nominal
    }
}

/// All of them.
pub(super) struct Unknowns {
    pub x: Vec<f64>,
    pub steps: Vec<f64>,
    priors: Vec<(usize, f64)>,
    /// The device's.
    force_bias: Vector3<f64>,
}

impl Unknowns {
    /// What is shared, at the device's result.
    pub fn new(start: &Calibration) -> Self {
        let by_rows = |matrix: &Matrix3<f32>| matrix.transpose().iter().map(|v| f64::from(*v)).collect::<Vec<_>>();
        let mut x = by_rows(&start.gyroscope.triad.correction);
        x.extend(by_rows(&start.accelerometer.triad.correction));
        x.extend([0.0; 3]);
        let force_bias = start.accelerometer.triad.bias.cast();
        Self { steps: vec![STEP; GLOBALS], x, priors: Vec::new(), force_bias }
    }

    /// New unknowns, zero at first; returns the first of them.
    pub fn add(&mut self, count: usize, step: f64) -> usize {
        let first = self.x.len();
        self.x.resize(first + count, 0.0);
        self.steps.resize(first + count, step);
        first
    }

    /// New unknowns about zero with a sigma.
    pub fn add_with_prior(&mut self, count: usize, sigma: f64) -> usize {
        let first = self.add(count, STEP);
        self.priors.extend((first..first + count).map(|index| (index, sigma)));
        first
    }

    /// What [`Self::add_with_prior`] promised.
    pub fn priors<'a>(&self) -> Vec<Block<'a>> {
        self.priors.iter().map(|&(index, sigma)| Block::prior(index, 0.0, sigma)).collect()
    }

    /// Unknowns for all rests: level by the accelerometer, headings by the gyroscope.
    pub fn place(&mut self, setting: &Setting) -> Vec<Rest> {
        let (gyro, accel) = (Globals::gyro(&self.x), Globals::accel(&self.x));
        let rest_stretches = || setting.stretches.iter().filter(|stretch| stretch.is_rest());
        let time_s: f64 = rest_stretches().map(|rest| rest.duration_s).sum();
        let rate_bias = rest_stretches().map(|rest| rest.mean_rate * rest.duration_s).sum::<Vector3<f64>>() / time_s;
        let force_bias = self.force_bias;
        let mut rests: Vec<Rest> = Vec::new();
        let mut rotation = UnitQuaternion::identity();
        let (mut broken, mut chain) = (true, 0);
        let (mut earth, mut table) = (0, 0);
        for (index, stretch) in setting.stretches.iter().enumerate() {
            if !stretch.is_rest() {
                broken |= stretch.is_broken();
                rotation *= carried(stretch, &gyro, &rate_bias);
                continue;
            }
            if std::mem::take(&mut broken) {
                chain += 1;
                // A table may lean by some degrees; without a square box nothing else tells.
                (earth, table) = (self.add(3, 1e-8), self.add_with_prior(2, 0.1));
            }
            let force = accel * (stretch.mean_force - force_bias);
            rotation = levelled(rotation, &force);
            let first = self.add(PER_REST, STEP);
            for axis in 0..3 {
                self.x[first + 3 + axis] = rate_bias[axis];
                self.x[first + 6 + axis] = force_bias[axis];
            }
            rests.push(Rest { stretch: index, first, chain, earth, table, nominal: rotation });
        }
        rests
    }
}

fn carried(stretch: &Stretch, gyro: &Matrix3<f64>, bias: &Vector3<f64>) -> UnitQuaternion<f64> {
    stretch
        .intervals
        .iter()
        .fold(UnitQuaternion::identity(), |rotation, interval| rotation * interval.turned(gyro, bias))
}

fn levelled(rotation: UnitQuaternion<f64>, force: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&(rotation * force), &Vector3::z()).unwrap_or_default() * rotation
}
