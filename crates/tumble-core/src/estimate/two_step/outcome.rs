//! What comes out of both steps.

use nalgebra::{Matrix3, SMatrix, SVector};

use super::filter::Filter;
use super::{ERRORS, Leak, Variant, gyro_covariance, other};
use crate::calibration::{Calibration, Fit, Frame, TriadEstimate};
use crate::estimate::device::Breakdown;
use crate::estimate::prior::CORRECTION_SIGMA;
use crate::estimate::six_face::{Real, Setting, SixFace, single, turns, vector};
use crate::motion::means::mean_force;
use crate::tape::Tape;

/// The two-step method's result.
#[derive(Clone, Debug)]
pub struct Outcome<T: Real> {
    /// Step 1: closed forms of both sensors.
    pub first: SixFace<T>,
    /// K in the order of equation (12), 1: off-diagonal elements of `A_s^b`, box frame.
    pub gyro: SVector<T, 6>,
    /// Of K, step 1's share and the residuals' inflation included.
    pub gyro_covariance: SMatrix<T, 6, 6>,
    /// Of K by the filter alone.
    pub filter_covariance: SMatrix<T, 6, 6>,
    /// ∂K/∂(step 1's errors), columns as in [`Leak`].
    pub leak: SMatrix<T, 6, ERRORS>,
    /// Mean normalised innovation squared of the position.
    pub nis_per_dof: T,
    /// The gyroscope's 3×3.
    pub correction: Matrix3<T>,
    /// All of it as a calibration, frame b: the box.
    pub calibration: Calibration,
}

impl<T: Real> Outcome<T> {
    #[expect(clippy::too_many_arguments, reason = "the results of one run, put together in one place")]
    pub(super) fn new<const R: usize, const S: usize>(
        tape: &Tape<R, S>,
        setting: &Setting,
        variant: Variant,
        correction: Matrix3<T>,
        gyro: SVector<T, 6>,
        first: SixFace<T>,
        filter: &Filter<T>,
        leak: &Leak<T>,
        nis_per_dof: T,
    ) -> Result<Self, Breakdown> {
        let filter_covariance = gyro_covariance(filter.covariance());
        let gyro_covariance = filter_covariance * nis_per_dof.max(T::one()) + leak.covariance(&first);
        let mut gyroscope = first.gyroscope().ok_or(Breakdown("gyroscope matrix"))?;
        gyroscope.triad.correction = correction.map(single);
        state_sigmas(&mut gyroscope, variant, &gyro_covariance);
        let mut result = Self {
            calibration: Calibration {
                g_sensitivity: None,
                accelerometer: first.accelerometer(),
                gyroscope,
                frame: Frame::Box,
                temperature_degc: tape.temperature_degc(),
                fit: Fit { nis_per_dof: single(nis_per_dof), ..Fit::default() },
            },
            first,
            gyro,
            gyro_covariance,
            filter_covariance,
            leak: leak.of_gyro(),
            nis_per_dof,
            correction,
        };
        result.residuals(tape, setting);
        Ok(result)
    }

    /// Gravity at rest and closures of turns, compensated.
    fn residuals<const R: usize, const S: usize>(&mut self, tape: &Tape<R, S>, setting: &Setting) {
        let fit = &mut self.calibration.fit;
        let (mut squares, mut count) = (0.0f32, 0.0f32);
        for still in tape.segments().iter().filter(|segment| segment.is_usable_still()) {
            let raw = mean_force(tape, usize::from(still.first), usize::from(still.end));
            let error = single(self.first.accel.force(&vector(&raw)).norm()) - setting.gravity_mps2;
            squares += error * error;
            fit.gravity_max_mps2 = fit.gravity_max_mps2.max(libm::fabsf(error));
            count += 1.0;
        }
        fit.gravity_rms_mps2 = libm::sqrtf(squares / count.max(1.0));
        let (mut closures, mut closed) = (0.0f32, 0.0f32);
        turns(tape, &self.first.rest, |turn| {
            let angle = single((self.correction * turn.integral_rad).dot(&vector(&turn.face.normal())));
            let open = angle - turn.revolutions as f32 * core::f32::consts::TAU;
            closures += open * open;
            closed += 1.0;
        });
        fit.turn_closure_rms_rad = libm::sqrtf(closures / closed.max(1.0));
    }
}

/// Sigmas of the elements that K stands for.
fn state_sigmas<T: Real>(gyroscope: &mut TriadEstimate, variant: Variant, covariance: &SMatrix<T, 6, 6>) {
    for k in 0..6 {
        let sigma = libm::sqrtf(single(covariance[(k, k)]).max(0.0));
        let places = match variant {
            Variant::Traditional if k < 3 => [(k, k); 2],
            // a_x stands in row y, column z and, with the other sign, in row z, column y.
            Variant::Traditional => [((k + 1) % 3, (k + 2) % 3), ((k + 2) % 3, (k + 1) % 3)],
            _ => [(k / 2, other(k)); 2],
        };
        for (row, column) in places {
            gyroscope.correction_sigma[(row, column)] = sigma;
            gyroscope.observable[row][column] = sigma < 0.1 * CORRECTION_SIGMA;
        }
    }
}
