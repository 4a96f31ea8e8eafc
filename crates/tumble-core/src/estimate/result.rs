//! What the last pass comes to: numbers, their covariance, and how well they explain the session.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::device::{Estimate, Estimator, PARAMETERS};
use super::model::Nominal;
use super::prior::CORRECTION_SIGMA;
use super::start;
use super::state::Block;
use super::walk::still::EARTH_SIGMA;
use super::wander::Found;
use crate::calibration::{Calibration, Fit, Triad, TriadEstimate};
use crate::motion::means::mean_force;
use crate::motion::standstill::RUN_S;
use crate::tape::Tape;

/// A number is "not observable" where the data bring less than 99 % of what is known of it.
const OBSERVABLE: f32 = 0.1 * CORRECTION_SIGMA;
/// Where the gyroscope's bias stands among the parameters.
const GYRO_BIAS: usize = 12;

impl<const S: usize> Estimator<S> {
    /// What comes out after the last pass.
    pub(super) fn estimate<const R: usize>(&self, tape: &Tape<R, S>, nominal: &Nominal, converged: bool) -> Estimate {
        let mut covariance = self.covariance();
        let diagonal = covariance.diagonal();
        let sigma = |index: usize| libm::sqrtf(diagonal[index].max(0.0));
        let triad = |triad: &Triad, first: usize| {
            let correction_sigma = Matrix3::from_fn(|i, j| sigma(first + 3 + 3 * i + j));
            TriadEstimate {
                triad: *triad,
                bias_sigma: Vector3::from_fn(|i, _| sigma(first + i)),
                correction_sigma,
                observable: core::array::from_fn(|i| core::array::from_fn(|j| correction_sigma[(i, j)] < OBSERVABLE)),
            }
        };
        let mut gyroscope = triad(&nominal.gyro, GYRO_BIAS);
        self.settle_bias(tape, nominal, &mut gyroscope, &mut covariance);
        if tape.bias_jumps.any() {
            // The tape is less the jump, which the run that told it knows by its own noise and that of as short a rest.
            gyroscope.triad.bias += tape.bias_jumps.total_rad_s;
            let sigma = libm::sqrtf(2.0 * self.noise.rate_density / RUN_S);
            gyroscope.bias_sigma.apply(|each| *each = libm::hypotf(*each, sigma));
        }
        let mut accelerometer = triad(&nominal.accel, 0);
        // Twelve comparisons leave more possible than such a sensor does (0.4 mg a session), so that it takes a likely walk.
        let walk = self.walk.pass.force_walk.found().filter(Found::probable);
        widen(&mut accelerometer, walk, self.walk.pass.session_s());
        Estimate {
            calibration: Calibration {
                accelerometer,
                gyroscope,
                g_sensitivity: self.account().filter(|_| self.felt).map(|account| account.sensitivity),
                frame: self.conditions.frame(),
                temperature_degc: tape.temperature_degc(),
                fit: self.fit(tape, nominal),
            },
            covariance,
            noise: self.noise,
            outliers: (0u16..)
                .zip(&self.walk.noise)
                .filter(|(_, noise)| noise.rate_scale > 1.0)
                .map(|(segment, noise)| (segment, noise.rate_scale))
                .take(8)
                .collect(),
            plated: self.walk.pass.plated,
            passes: self.passes,
            converged,
            moved: self.largest_move(),
        }
    }

    /// The bias that is said of the session. With a sensitivity to force it is that of the rests' own account, for the filter's last one
    /// knows the last face best. One that wanders is its mean, because who subtracts it later wants to know: and the sigma that is said of it
    /// tells how far it went. What drifts straight is said at the session's middle. Else its sigma has the wandering that rests leave possible.
    ///
    /// Not inlined, as `weigh_accounts`.
    #[inline(never)]
    fn settle_bias<const R: usize>(
        &self,
        tape: &Tape<R, S>,
        nominal: &Nominal,
        gyroscope: &mut TriadEstimate,
        covariance: &mut SMatrix<f32, PARAMETERS, PARAMETERS>,
    ) {
        let resting = &self.walk.pass.resting;
        let felt = resting.felt(EARTH_SIGMA, self.conditions.gravity_mps2).filter(|_| self.felt);
        if let Some(account) = felt {
            gyroscope.triad.bias = self.walk.nominal().gyro.bias + account.bias;
            for axis in 0..3 {
                let factor = account.bias_sigma[axis] / gyroscope.bias_sigma[axis].max(f32::MIN_POSITIVE);
                covariance.row_mut(GYRO_BIAS + axis).scale_mut(factor);
                covariance.column_mut(GYRO_BIAS + axis).scale_mut(factor);
            }
            gyroscope.bias_sigma = account.bias_sigma;
        }
        if self.bias_wanders || self.account().is_some_and(|account| account.slope.certain) {
            let felt = |raw: &Vector3<f32>| self.noise.g_sensitivity * nominal.accel.compensate(raw);
            let (mean, spread) = start::resting_rate(tape, felt);
            if self.bias_wanders {
                gyroscope.triad.bias = mean;
            }
            gyroscope.bias_sigma = gyroscope.bias_sigma.zip_map(&spread, libm::hypotf);
        } else {
            let walk = self.walk.pass.rate_walks[usize::from(self.felt)].found();
            widen(gyroscope, walk, self.walk.pass.session_s());
        }
    }

    fn covariance(&self) -> SMatrix<f32, PARAMETERS, PARAMETERS> {
        let blocks = [Block::AccelBias, Block::AccelCorrection, Block::GyroBias, Block::GyroCorrection];
        let mut order = [0usize; PARAMETERS];
        for (to, from) in order.iter_mut().zip(blocks.into_iter().flat_map(Block::range)) {
            *to = from;
        }
        SMatrix::from_fn(|i, j| self.walk.filter.covariance()[(order[i], order[j])])
    }

    fn fit<const R: usize>(&self, tape: &Tape<R, S>, nominal: &Nominal) -> Fit {
        let (mut squares, mut largest, mut count) = (0.0f32, 0.0f32, 0.0f32);
        for segment in tape.segments().iter().filter(|segment| segment.is_usable_still()) {
            let raw = mean_force(tape, usize::from(segment.first), usize::from(segment.end));
            let error = nominal.accel.compensate(&raw).norm() - self.conditions.gravity_mps2;
            squares += error * error;
            largest = largest.max(libm::fabsf(error));
            count += 1.0;
        }
        let sums = self.walk.pass.sums;
        let moves = self.walk.noise.iter().filter_map(|noise| Some(noise.hinge?.nis(&self.noise) / noise.rate_scale));
        let (hinge, dof) = moves.fold((0.0, 0.0), |(sum, dof), nis| (sum + nis, dof + 2.0));
        Fit {
            nis_per_dof: (sums.rest.0 + hinge) / (sums.rest.1 + dof).max(1.0),
            gravity_rms_mps2: libm::sqrtf(squares / count.max(1.0)),
            gravity_max_mps2: largest,
            turn_closure_rms_rad: libm::sqrtf(sums.closed.0 / sums.closed.1.max(1.0)),
        }
    }
}

/// A bias's sigma with what a walk leaves possible: about its own mean over a session it has a mean square of q T/6, and where it is
/// certain, so that the filter follows it and says the last, that is q T/3 from the mean.
fn widen(triad: &mut TriadEstimate, walk: Option<Found>, session_s: f32) {
    let Some(walk) = walk else { return };
    let wandered = libm::sqrtf(walk.density * session_s / if walk.certain() { 3.0 } else { 6.0 });
    triad.bias_sigma = triad.bias_sigma.map(|sigma| libm::hypotf(sigma, wandered));
}
