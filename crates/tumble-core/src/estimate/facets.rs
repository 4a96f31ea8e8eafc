//! How crooked a box that is called square is: the marginal likelihood of its faces' variance, where table, frame and shear are free.
//!
//! Over the rests of a visit the face's mean normal in frame n is `(R n)ₓᵧ = p + (R [n×] ρ)ₓᵧ − (R σ n)ₓᵧ − (R e)ₓᵧ`: p the table, ρ a common
//! rotation of the box's frame, which faces alone define, σ the accelerometer's shear (symmetric, no diagonal), e the face's own error.
//! The shear has to be free because the nominal's was fitted to these very faces: the plate tells it ten times as well as the turns
//! do, so that residuals have lost what looks like it. Six faces give twelve numbers for eight unknowns, and leave four.
//!
//! ρ and p are one where `R (n × ρ)` is the same for all six faces. With headings that are multiples of 90° that happens for a ρ along
//! a space diagonal, whose horizontal part every face has at one of four headings: 4 diagonals, 4 common directions, 4⁶ headings, once in
//! 256 sessions. Only turns tell them apart then (`model::plate_in_turn`), in which e is therefore a state.
//!
//! On a soft or uneven surface the box leans otherwise at each rest. Rests of one visit at one heading have all of the above in common
//! and differ by that alone.

use nalgebra::{Matrix3, Vector3};

use super::likelihood::{CERTAIN, Likelihood};
use super::normal::{Normal, Unknowns, mean_variance};
use crate::motion::path::WHOLE_TURN;

/// A face of a box that its owner calls square, rad: 0.5 µm on 5 cm.
pub const SQUARE: f32 = 5e-6;
/// How well a face's contact with a firm, even table repeats, rad: 0.25 µm over 5 cm, below all that shows.
pub const CONTACT: f32 = 5e-6;
/// The grid's sigmas grow by √2 from there, to 41 mrad (2.4°).
const GRID: usize = 25;
/// Unknowns: table 2 and frame 3, then shear 3.
const TABLE_AND_FRAME: usize = 5;
const UNKNOWNS: usize = 8;

/// No table leans by more than this, and no face by more from the first one, 1 (10° and 6°): what does is no face on a table.
pub const LEANING: f32 = 0.17;
const APART: f32 = 0.1;

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Facets {
    normal: Normal<9>,
    first: Option<Vector3<f32>>,
    noise: f32,
    count: f32,
    visit: Option<Visit>,
    contact: Likelihood,
}

/// A stay on one face: its normal, the attitude at the first rest, sums over rests of the normal in frame n and of its variance.
#[derive(Clone, Copy, Debug)]
struct Visit {
    normal_b: Vector3<f32>,
    to_n: Matrix3<f32>,
    sum: Vector3<f32>,
    noise: f32,
    rests: f32,
}

impl Facets {
    /// Can a face with this normal lie on the table?
    pub fn admits(&self, normal_n: &Vector3<f32>) -> bool {
        let apart = self.first.map_or(0.0, |first| (normal_n - first).xy().norm());
        normal_n.xy().norm() < LEANING && apart < APART
    }

    /// A rest on a face, whose normal in frame n the levelled attitude has with a variance of `noise` a component. `anew`: the face came to
    /// lie on the table since the last rest. `sigmas`: of a face and of its contact, as they are in force.
    pub fn take(&mut self, anew: bool, normal_b: &Vector3<f32>, to_n: &Matrix3<f32>, noise: f32, sigmas: [f32; 2]) {
        let [facet, contact] = sigmas.map(|sigma| sigma * sigma);
        if anew {
            self.end_visit();
        }
        let normal_n = to_n * normal_b;
        // About the first one, so that `f32` does not lose the residuals beside the table's tilt.
        let left = normal_n - *self.first.get_or_insert(normal_n);
        let new = Visit { normal_b: *normal_b, to_n: *to_n, sum: Vector3::zeros(), noise: 0.0, rests: 0.0 };
        let visit = self.visit.get_or_insert(new);
        let along_b = normal_b.yzx();
        let turned = (to_n * along_b - visit.to_n * along_b).norm_squared();
        if visit.rests > 0.0 && turned < WHOLE_TURN * WHOLE_TURN {
            // Less the mean of those before it; scaled to the variance of one.
            let scale = libm::sqrtf(visit.rests / (visit.rests + 1.0));
            let apart = (left - visit.sum / visit.rests).xy() * scale;
            apart.iter().for_each(|value| self.contact.take(*value, noise + facet * turned, CONTACT));
        }
        visit.sum += left;
        visit.noise += noise + contact;
        visit.rests += 1.0;
    }

    /// Variance by which a face's contact with the table differs from rest to rest, rad², if it certainly does.
    pub fn contact(&self) -> Option<f32> {
        self.contact.mean(CONTACT).filter(|_| self.contact.is_certain())
    }

    fn end_visit(&mut self) {
        let Some(Visit { normal_b, to_n, sum, noise, rests }) = self.visit.take() else { return };
        let left = sum / rests;
        let frame = to_n * normal_b.cross_matrix();
        let [x, y, z] = [normal_b.x, normal_b.y, normal_b.z];
        let shear = to_n * Matrix3::new(0.0, z, y, z, 0.0, x, y, x, 0.0);
        for axis in 0..2 {
            let mut row = [0.0; 9];
            row[axis] = 1.0;
            for unknown in 0..3 {
                row[2 + unknown] = frame[(axis, unknown)];
                row[5 + unknown] = shear[(axis, unknown)];
            }
            row[8] = left[axis];
            self.normal.take(&row, 1.0);
        }
        self.noise += 2.0 * noise / (rests * rests);
        self.count += 2.0;
    }

    /// Are there faces enough to tell if they agree?
    pub fn agree_or_not(&self) -> bool {
        self.count + if self.visit.is_some() { 2.0 } else { 0.0 } >= 6.0
    }

    /// Mean of the posterior of a face's variance, rad², a square box being as likely as a crooked one before, and whether it is certain
    /// that faces err at all. Faces that err by less than the rests' levels are known (0.02° is 200 µrad, a rest of 2.5 s knows 130) are not
    /// told from square ones for certain; their variance is believed by the odds. `sigma` is a face's in force, `shear` the filter's variance of
    /// the nominal's shear, 1.
    ///
    /// What is not the plate's of the information on shear stays the shear's prior, be it a hundredth: what is told by less than that
    /// is lost in `f32`, and a direction of table, frame and shear together is told by almost nothing.
    pub fn variance(&self, sigma: f32, shear: f32) -> Option<(f32, bool)> {
        let mut all = *self;
        all.end_visit();
        let noise = all.noise / all.count;
        if all.count - (all.normal.clone().eliminate(Unknowns::range(0, TABLE_AND_FRAME)).0 as f32) < 1.0 {
            return None;
        }
        let prior = (1.0 / shear - 4.0 / (noise + sigma * sigma)).max(0.01 / shear);
        let variances = (0..GRID).map(|step| SQUARE * SQUARE * libm::exp2f(step as f32));
        let mut logs = [0.0f32; GRID];
        for (log, variance) in logs.iter_mut().zip(variances.clone()) {
            *log = all.log_likelihood(noise + variance, prior);
        }
        let best = logs.iter().fold(f32::NEG_INFINITY, |best, log| best.max(*log));
        let certain = 2.0 * (best - logs[0]) > CERTAIN;
        Some((mean_variance(variances, noise, 1.0, |index, _| logs[index]), certain))
    }

    /// Of a variance of each number, where `prior` is known of the shear.
    fn log_likelihood(&self, variance: f32, prior: f32) -> f32 {
        let mut normal = self.normal;
        let sigma = 1.0 / libm::sqrtf(variance * prior);
        (TABLE_AND_FRAME..UNKNOWNS).for_each(|shear| normal.expect(shear, sigma));
        let (rank, log_determinant) = normal.eliminate(Unknowns::range(0, UNKNOWNS));
        let squares = normal.at(UNKNOWNS, UNKNOWNS) / variance;
        -0.5 * ((self.count - rank as f32) * libm::logf(variance) + log_determinant + squares)
    }
}
