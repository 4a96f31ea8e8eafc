//! The full maximum a posteriori problem of `docs/method.md` §4 in one piece, `f64`, from the samples.
//!
//! Unknown are both corrections, the lever, for every rest its attitude and both biases (random walks between rests), for
//! every turn its pivot, for every turn its wobble, every visit of a face its facet and its first stop's error, for every unbroken chain of segments
//! the table and the Earth's rate. Rotation between rests is integrated anew from the samples at every step of the
//! solver, so nothing is linearised that the solver does not linearise. Noise is what the device found: the two are to
//! agree on the data, not on what noise is. What they still do differently: the device averages a twelfth of a second into
//! a record of 16-bit numbers, and takes half of a group's process noise as there from its beginning ([`MeanNoise::Halved`]), where here a
//! group's mean may see the exact share of it; a rest in the hand is carried by the gyroscope there and taken as one attitude here.

mod link;
mod unknowns;
mod visits;
mod walked;

use nalgebra::{Matrix3, SMatrix, Vector3};
use tumble_core::calibration::{Calibration, Frame};
use tumble_core::estimate::facets::LEANING;
use tumble_core::estimate::sums::SegmentNoise;
use tumble_core::estimate::{Conditions, Estimate, PARAMETERS, noise};
use tumble_core::face::FaceSet;
use tumble_core::tape::{ANGLE_UNIT_RAD, FORCE_UNIT_MPS2};

pub use walked::MeanNoise;

use super::data::Stretch;
use super::gravity::Fitted;
use super::solve::{Block, minimise};
use super::{ACCEL_BIAS_SIGMA, CORRECTION_SIGMA};
use unknowns::{ACCEL, GYRO, Globals, LEVER, Rest, Unknowns};

/// The device's further priors.
const GYRO_BIAS_SIGMA: f64 = 0.01;
const LEVER_SIGMA_M: f64 = 0.05;
const EARTH_SIGMA: f64 = 5e-5;
/// What is fixed by definition: far below every sigma, far above rounding.
const FIXED: f64 = 1e-7;

/// Both triads (accelerometer, gyroscope) and how well they fit.
#[derive(Clone, Debug)]
pub struct Batch {
    /// m/s².
    pub accel: Fitted,
    /// rad/s.
    pub gyro: Fitted,
    /// Of all 24, in the device's order.
    pub covariance: SMatrix<f64, PARAMETERS, PARAMETERS>,
    /// Twice the cost over residuals less unknowns: 1 if noise is what the device took it for.
    pub chi_square_per_dof: f64,
}

/// What the problem is made of.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    pub stretches: &'a [Stretch],
    pub conditions: &'a Conditions,
    pub noise: &'a noise::Noise,
    pub segments: &'a [SegmentNoise],
    pub mean_noise: MeanNoise,
}

impl Setting<'_> {
    /// Is the plate believed in the turns that follow a rest? As on the device: of a box called square, three faces seen.
    fn plate_known(&self, rest: Rest) -> bool {
        let faces = self.stretches.iter().filter(|stretch| stretch.is_rest()).filter_map(|rest| rest.face);
        let seen = faces.fold(FaceSet::EMPTY, FaceSet::with);
        let leaning = rest.leaning(self.stretches[rest.stretch].face);
        self.noise.facet_sigma_rad.is_some() && seen.len() >= 3 && leaning < LEANING
    }
}

/// Starts where the device ended. None without rests, or if the problem is singular.
pub fn estimate(
    stretches: &[Stretch],
    conditions: &Conditions,
    device: &Estimate,
    segments: &[SegmentNoise],
    mean_noise: MeanNoise,
) -> Option<Batch> {
    let setting = Setting { stretches, conditions, noise: &device.noise, segments, mean_noise };
    let mut unknowns = Unknowns::new(&device.calibration);
    let rests = unknowns.place(&setting);
    let last = *rests.last()?;
    let mut blocks = priors(&unknowns, &device.calibration, &rests);
    blocks.extend(rests.iter().flat_map(|rest| still(&setting, *rest)));
    let (visits, facets) = visits::visits(&setting, &mut unknowns, &rests);
    blocks.extend(visits);
    for (pair, facet) in rests.windows(2).zip(facets).filter(|(pair, _)| pair[0].chain == pair[1].chain) {
        blocks.extend(walk(&setting, pair[0], pair[1]));
        blocks.push(link::link(&setting, &mut unknowns, pair[0], pair[1], facet));
    }
    blocks.extend(unknowns.priors());
    let solution = minimise(&blocks, unknowns.x, &unknowns.steps);
    let covariance = solution.covariance?;
    let order = |correction: usize, bias: usize| (bias..bias + 3).chain(correction..correction + 9);
    let (accel, gyro) = (order(ACCEL, last.force_bias()), order(GYRO, last.rate_bias()));
    let order: Vec<usize> = accel.chain(gyro).collect();
    let covariance: SMatrix<f64, PARAMETERS, PARAMETERS> = SMatrix::from_fn(|i, j| covariance[(order[i], order[j])]);
    let fitted = |correction: usize, bias: usize, first: usize| {
        let own = covariance.fixed_view::<12, 12>(first, first).into_owned();
        let bias = Vector3::from_column_slice(&solution.x[bias..bias + 3]);
        Fitted::new(bias, Matrix3::from_row_slice(&solution.x[correction..correction + 9]), own)
    };
    let mut gyro = fitted(GYRO, last.rate_bias(), 12);
    // The last rest's; the session's is that of its middle.
    gyro.bias -= device.noise.bias_slope.cast::<f64>() * since_middle_s(stretches, last);
    let dof = solution.residuals.saturating_sub(solution.x.len()).max(1);
    Some(Batch {
        accel: fitted(ACCEL, last.force_bias(), 0),
        gyro,
        covariance,
        chi_square_per_dof: 2.0 * solution.cost / dof as f64,
    })
}

/// From the session's middle to a rest's, s.
fn since_middle_s(stretches: &[Stretch], rest: Rest) -> f64 {
    let middle_us = |first: &Stretch, last: &Stretch| 0.5 * (first.segment.start_us + last.segment.end_us) as f64;
    let own = &stretches[rest.stretch];
    stretches
        .first()
        .zip(stretches.last())
        .map_or(0.0, |(first, last)| 1e-6 * (middle_us(own, own) - middle_us(first, last)))
}

fn priors<'a>(unknowns: &Unknowns, start: &Calibration, rests: &[Rest]) -> Vec<Block<'a>> {
    let x = &unknowns.x;
    let mut blocks = Vec::new();
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let offset = 3 * i + j;
        blocks.push(Block::prior(GYRO + offset, x[GYRO + offset], CORRECTION_SIGMA));
        let fixed = j > i && start.frame == Frame::Accelerometer;
        blocks.push(Block::prior(ACCEL + offset, x[ACCEL + offset], if fixed { FIXED } else { CORRECTION_SIGMA }));
    }
    blocks.extend((LEVER..LEVER + 3).map(|index| Block::prior(index, 0.0, LEVER_SIGMA_M)));
    for (k, rest) in rests.iter().enumerate() {
        if k > 0 && rests[k - 1].chain == rest.chain {
            continue;
        }
        // Heading is zero by definition where a chain begins.
        blocks.push(Block::prior(rest.attitude() + 2, 0.0, FIXED));
        for axis in 0..3 {
            blocks.push(Block::prior(rest.earth + axis, 0.0, EARTH_SIGMA));
            blocks.push(Block::prior(rest.rate_bias() + axis, x[rest.rate_bias() + axis], GYRO_BIAS_SIGMA));
            blocks.push(Block::prior(rest.force_bias() + axis, x[rest.force_bias() + axis], ACCEL_BIAS_SIGMA));
        }
    }
    blocks
}

/// Gravity, and the rate where the rest is on something solid.
fn still<'a>(setting: &Setting<'a>, rest: Rest) -> Vec<Block<'a>> {
    let stretch = &setting.stretches[rest.stretch];
    let scale = f64::from(setting.segments.get(stretch.number).map_or(1.0, |noise| noise.force_scale));
    // The device takes in the rest's records one by one, each with its rounding.
    let rounded = |unit: f32| f64::from(unit * unit * noise::ROUNDED * noise::REST_RECORD_S) / stretch.duration_s;
    let force_variance = f64::from(setting.noise.force_density) * scale / stretch.duration_s;
    let force_sigma = (force_variance + rounded(FORCE_UNIT_MPS2)).sqrt();
    let gravity = Vector3::new(0.0, 0.0, f64::from(setting.conditions.gravity_mps2));
    let unknowns = (ACCEL..ACCEL + 9).chain(rest.all());
    let mut blocks = vec![Block::new(unknowns, move |x| {
        let force = rest.rotation(x) * (Globals::accel(x) * (stretch.mean_force - rest.vector(x, rest.force_bias())));
        ((force - gravity) / force_sigma).iter().copied().collect()
    })];
    if noise::is_solid(&stretch.segment, setting.noise.quiet_variance) {
        let rate_variance = f64::from(setting.noise.rate_density) / stretch.duration_s;
        let rate_sigma = (rate_variance + rounded(ANGLE_UNIT_RAD / noise::REST_RECORD_S)).sqrt();
        let unknowns = (GYRO..GYRO + 9).chain(rest.all()).chain(rest.earth..rest.earth + 3);
        blocks.push(Block::new(unknowns, move |x| {
            let rate = Globals::gyro(x) * (stretch.mean_rate - rest.vector(x, rest.rate_bias()));
            let earth = rest.rotation(x).inverse_transform_vector(&rest.vector(x, rest.earth));
            ((rate - earth) / rate_sigma).iter().copied().collect()
        }));
    }
    blocks
}

/// Both biases from one rest to the next, middle to middle.
fn walk<'a>(setting: &Setting<'a>, from: Rest, to: Rest) -> Vec<Block<'a>> {
    let segment = |rest: Rest| &setting.stretches[rest.stretch].segment;
    let middle_s = |rest: Rest| 0.5e-6 * (segment(rest).start_us + segment(rest).end_us) as f64;
    let time_s = middle_s(to) - middle_s(from);
    let biases = [
        (from.rate_bias(), to.rate_bias(), setting.noise.total_bias_walk(), setting.noise.bias_slope.cast::<f64>()),
        (from.force_bias(), to.force_bias(), setting.noise.force_walk, Vector3::zeros()),
    ];
    let block = |(from, to, density, slope): (usize, usize, f32, Vector3<f64>)| {
        let sigma = (f64::from(density) * time_s).sqrt();
        Block::new((from..from + 3).chain(to..to + 3), move |x| {
            (0..3).map(|axis| (x[to + axis] - x[from + axis] - slope[axis] * time_s) / sigma).collect()
        })
    };
    biases.into_iter().map(block).collect()
}
