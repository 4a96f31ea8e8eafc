//! The prior of each pass, and what a pass makes of the nominal.

use nalgebra::Matrix3;

use super::conditions::Conditions;
use super::filter::Filter;
use super::model::Nominal;
use super::state::{Block, STATES};
use crate::calibration::{Frame, Triad};

/// Prior of a correction element, 1: sheet scale 3 %, cross-axis 2 %, and a chip that sits askew in its box by 3°.
pub const CORRECTION_SIGMA: f32 = 0.06;
/// Prior of an accelerometer bias, m/s²: sheet 80 mg.
const ACCEL_BIAS_SIGMA: f32 = 0.8;
/// Prior of a gyroscope bias about the mean of all rests, rad/s: far wider than what rests leave (0.1 mrad/s).
const GYRO_BIAS_SIGMA: f32 = 0.01;
/// Prior of the lever arm, m: a sensor sits in a box of some 10 cm.
const LEVER_SIGMA_M: f32 = 0.05;
/// Width of a narrowed prior in sigmas, and the least sigma (1 or SI) that is believed of an early pass.
const NARROWED: f32 = 30.0;
const NARROWEST: f32 = 2e-5;

/// Makes of a filter the prior about a nominal: its mean stays at the start, whatever the nominal has become. In place: a second filter
/// would take 8 KB of a microcontroller's stack.
pub fn begin(filter: &mut Filter, conditions: &Conditions, start: &Nominal, nominal: &Nominal) {
    filter.clear();
    let mut set = |block, sigma: f32, start: &Triad, now: &Triad| {
        for i in 0..3 {
            for j in 0..3 {
                // Frame b is the accelerometer's own where no box gives one: its correction is lower-triangular.
                let fixed = block == Block::AccelCorrection && j > i && conditions.frame() == Frame::Accelerometer;
                let mean = start.correction[(i, j)] - now.correction[(i, j)];
                filter.reset(block, 3 * i + j, mean, if fixed { 0.0 } else { sigma });
            }
        }
    };
    set(Block::GyroCorrection, CORRECTION_SIGMA, &start.gyro, &nominal.gyro);
    set(Block::AccelCorrection, CORRECTION_SIGMA, &start.accel, &nominal.accel);
    for axis in 0..3 {
        filter.reset(Block::GyroBias, axis, start.gyro.bias[axis] - nominal.gyro.bias[axis], GYRO_BIAS_SIGMA);
        filter.reset(Block::AccelBias, axis, start.accel.bias[axis] - nominal.accel.bias[axis], ACCEL_BIAS_SIGMA);
        filter.reset(Block::Lever, axis, 0.0, LEVER_SIGMA_M);
    }
}

/// As [`begin`], but of what is well determined the prior is one about the last pass's result, `NARROWED` times its sigma wide: it adds a
/// thousandth to what the data say, and spares `f32` the collapse of a variance by seven orders of magnitude.
pub fn begin_narrow(filter: &mut Filter, conditions: &Conditions, start: &Nominal, nominal: &Nominal) {
    let mut found = [0.0f32; STATES];
    found.iter_mut().zip(filter.covariance().diagonal()).for_each(|(found, variance)| *found = variance.max(0.0));
    begin(filter, conditions, start, nominal);
    for block in [Block::GyroCorrection, Block::AccelCorrection, Block::AccelBias, Block::GyroBias] {
        for (offset, index) in block.range().enumerate() {
            let narrowed = NARROWED * libm::sqrtf(found[index]).max(NARROWEST);
            if narrowed * narrowed < filter.covariance()[(index, index)] {
                filter.reset(block, offset, 0.0, narrowed);
            }
        }
    }
}

/// The nominal with a pass's mean added.
pub fn improved(nominal: &Nominal, filter: &Filter) -> Nominal {
    let triad = |triad: &Triad, correction: Block, bias: Block| Triad {
        bias: triad.bias + filter.vector(bias, 0),
        correction: Matrix3::from_fn(|i, j| triad.correction[(i, j)] + filter.state()[correction.start() + 3 * i + j]),
    };
    Nominal {
        gyro: triad(&nominal.gyro, Block::GyroCorrection, Block::GyroBias),
        accel: triad(&nominal.accel, Block::AccelCorrection, Block::AccelBias),
        earth_rad_s: nominal.earth_rad_s + filter.vector(Block::Earth, 0),
    }
}

/// Are all numbers numbers?
pub fn is_finite(nominal: &Nominal) -> bool {
    [nominal.gyro, nominal.accel]
        .iter()
        .all(|triad| triad.bias.iter().chain(triad.correction.iter()).all(|value| value.is_finite()))
}
