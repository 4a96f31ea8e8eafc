//! One pass of the filter over all turns.

use nalgebra::{Matrix3, Vector3};

use super::filter::{ATTITUDE, Covariance, Filter, GYRO, POSITION, State};
use super::leak::Source;
use super::nominal::Nominal;
use super::{Leak, Response, Step, Strapdown, Variant};
use crate::estimate::six_face::{EARTH_SIGMA, Instant, Real, Setting, SixFace, Visit, VisitFit, real, vector};
use crate::motion::means::mean_force;
use crate::tape::{Kind, Segment, Tape};

/// Position noise of one record, m, beside the lever arm's.
const POSITION_SIGMA_M: f32 = 5e-4;
/// How long the Earth's horizontal rate acts as if it were white, s: what the filter takes to follow the attitude.
const EARTH_MEMORY_S: f32 = 2.0;
/// Heading at a turn's start, rad: zero by definition.
const HEADING_SIGMA: f32 = 1e-5;

/// One pass of the filter.
pub(super) struct Pass<'a, T: Real> {
    first: &'a SixFace<T>,
    setting: &'a Setting,
    variant: Variant,
    correction: Matrix3<T>,
    /// After the last turn so far.
    pub filter: Filter<T>,
    /// Step 1's errors in it.
    pub leak: Leak<T>,
    /// Sum over the observations.
    pub nis: T,
    /// How many.
    pub observations: T,
}

impl<'a, T: Real> Pass<'a, T> {
    pub fn new(first: &'a SixFace<T>, setting: &'a Setting, variant: Variant, nominal: &Nominal<T>) -> Self {
        let (mut state, mut covariance) = (State::zeros(), Covariance::zeros());
        for k in 0..6 {
            state[GYRO + k] = nominal.prior[k] - nominal.gyro[k];
            covariance[(GYRO + k, GYRO + k)] = nominal.sigma[k] * nominal.sigma[k];
        }
        Self {
            first,
            setting,
            variant,
            correction: nominal.correction,
            filter: Filter::new(state, covariance),
            leak: Leak::new(),
            nis: T::zero(),
            observations: T::zero(),
        }
    }

    /// Navigates through each turn of a visit and the rest that follows it.
    pub fn visit<const R: usize, const S: usize>(&mut self, tape: &Tape<R, S>, visit: &Visit) -> Option<()> {
        let (rest, correction) = (&self.first.rest, self.correction);
        let tilt = self.variant.tilt();
        let fit = visit.gravity(tape, self.setting, rest, &correction, &self.first.accel, tilt)?;
        let [u, v] = visit.plane::<T>();
        let lever = u * fit.lever_m.x + v * fit.lever_m.y;
        let source = Source::new(self.setting, &self.first.accel, visit, &fit);
        let mut before: Option<(Segment, Response<T>)> = None;
        let mut navigation: Option<Strapdown<T>> = None;
        visit.for_each(tape, rest, &correction, |segment, instant| {
            let entered = usize::from(segment.first) == instant.index;
            if entered && matches!(segment.kind, Kind::OnTable { .. }) {
                navigation = before.and_then(|(still, response)| self.start(tape, &still, &response, &fit));
            }
            if entered && segment.is_usable_still() {
                before = Some((*segment, source.response(instant)));
            }
            if let Some(navigation) = &mut navigation {
                self.record(navigation, instant, &lever, &fit, &source.response(instant));
            }
        });
        Some(())
    }

    /// Level by a rest, v = p = 0; K is kept.
    fn start<const R: usize, const S: usize>(
        &mut self,
        tape: &Tape<R, S>,
        still: &Segment,
        response: &Response<T>,
        fit: &VisitFit<T>,
    ) -> Option<Strapdown<T>> {
        let raw = mean_force(tape, usize::from(still.first), usize::from(still.end));
        let force = self.first.accel.force(&vector(&raw));
        let navigation = Strapdown::level(&force)?;
        let gravity: T = real(self.setting.gravity_mps2);
        let white: T = real(self.setting.noise.force_density / still.duration_s());
        for index in 0..GYRO {
            self.filter.reset(index, T::zero(), T::zero());
        }
        let level = white * fit.force_scale[0] / (gravity * gravity);
        self.filter.reset(ATTITUDE, T::zero(), level);
        self.filter.reset(ATTITUDE + 1, T::zero(), level);
        self.filter.reset(ATTITUDE + 2, T::zero(), real(HEADING_SIGMA * HEADING_SIGMA));
        self.leak.restart(&navigation.start(), &force, response, gravity);
        Some(navigation)
    }

    fn record(
        &mut self,
        navigation: &mut Strapdown<T>,
        instant: &Instant<T>,
        lever: &Vector3<T>,
        fit: &VisitFit<T>,
        response: &Response<T>,
    ) {
        let (noise, dt_s) = (&self.setting.noise, instant.dt_s);
        let force = self.first.accel.force(&instant.raw_force_mps2);
        let gravity = real(self.setting.gravity_mps2);
        let Step { mut motion, middle } =
            navigation.step(&instant.rotation_rad, &force, dt_s, gravity, self.variant.pattern());
        let rate = noise.rate_density * noise.turn_scale + EARTH_MEMORY_S * EARTH_SIGMA * EARTH_SIGMA;
        motion.attitude_variance = dt_s * real(rate);
        motion.velocity_variance =
            dt_s * real::<T>(noise.force_density) * fit.force_scale[usize::from(instant.turning)];
        self.filter.predict(&motion);
        self.leak.predict(&motion, &middle, &force, response, dt_s);
        let position = navigation.position_error(&middle, lever);
        let variance = real::<T>(POSITION_SIGMA_M * POSITION_SIGMA_M) + fit.lever_variance * real(2.0);
        for axis in 0..3 {
            let innovation = self.filter.observe(POSITION + axis, position[axis], variance);
            self.leak.observe(POSITION + axis, &innovation);
            self.nis += innovation.nis();
            self.observations += T::one();
        }
    }
}
