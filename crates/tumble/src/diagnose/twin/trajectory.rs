//! What the sensor went through, by the nominal parameters: attitude, rate, specific force and their changes at every sample.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use tumble_core::calibration::Triad;
use tumble_core::face::Face;

use super::data::{Deed, Raw, Stretch};
use crate::integrate;

/// Window of the angular acceleration's slope to either side, s: as in the `batch` reference.
pub const SLOPE_S: f64 = 1.0 / 12.0;

/// What the residuals are residuals of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nominal {
    /// M of `ω = M (raw − b)`.
    pub gyro: Matrix3<f64>,
    /// b, rad/s.
    pub gyro_bias: Vector3<f64>,
    /// A of `f = A (raw − a)`.
    pub accel: Matrix3<f64>,
    /// a, m/s².
    pub accel_bias: Vector3<f64>,
    /// Earth's rate, frame n, rad/s.
    pub earth: Vector3<f64>,
}

impl Nominal {
    /// From the estimator's triads.
    pub fn new(gyro: &Triad, accel: &Triad) -> Self {
        Self {
            gyro: gyro.correction.cast(),
            gyro_bias: gyro.bias.cast(),
            accel: accel.correction.cast(),
            accel_bias: accel.bias.cast(),
            earth: Vector3::zeros(),
        }
    }

    /// rad/s, frame b.
    pub fn rate(&self, raw: &Raw) -> Vector3<f64> {
        self.gyro * (raw.rate - self.gyro_bias)
    }

    /// m/s², frame b.
    pub fn force(&self, raw: &Raw) -> Vector3<f64> {
        self.accel * (raw.force - self.accel_bias)
    }
}

/// One instant, as a candidate sees it.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Of the sample.
    pub index: usize,
    /// Since the first sample, s.
    pub t_s: f64,
    /// `rotation_n_from_b`.
    pub attitude: UnitQuaternion<f64>,
    /// The same as a matrix.
    pub to_n: Matrix3<f64>,
    /// True rate by the nominal, rad/s, frame b.
    pub rate: Vector3<f64>,
    /// Its mean over a sixth of a second. An axis that hardly turns reads its own noise.
    pub mean_rate: Vector3<f64>,
    /// The same for what depends on its sign, which noise would turn; zero where it does not stand
    /// out. The residual is made of the same noise: a regressor that takes noise's sign explains noise (sign(x + n) and n correlate by 0.8 σ_n/σ,
    /// which 1400 windows of a session make thirty sigma for a rate that is noise alone).
    pub smooth_rate: Vector3<f64>,
    /// How far the true rate may be from that mean, 1 sigma: how it trembles about it beyond the noise, and how uncertain the
    /// mean is. Zero at rest on something solid.
    pub tremor: Vector3<f64>,
    /// Its derivative, rad/s².
    pub acceleration: Vector3<f64>,
    /// True specific force by the nominal, m/s², frame b: in rests and turns gravity alone, in the hand what was measured.
    pub force: Vector3<f64>,
    /// Its derivative, m/s³: `f × ω` where gravity alone acts.
    pub jerk: Vector3<f64>,
    /// The gyroscope's bias by the nominal, rad/s.
    pub zero: Vector3<f64>,
    /// The reading, rad/s, bias and all.
    pub raw_rate: Vector3<f64>,
    /// The reading, m/s².
    pub raw_force: Vector3<f64>,
    /// Above the recording's mean, °C; zero where there is none.
    pub warmth_degc: f64,
    /// Number of the stretch.
    pub stretch: usize,
    /// What happens.
    pub deed: Deed,
    /// Since the last motion ended, s; zero in motion.
    pub rested_s: f64,
    /// Turned about up since this turn began, rad.
    pub turned_rad: f64,
}

impl Moment {
    /// The face that is up.
    pub fn face(&self) -> Option<Face> {
        match self.deed {
            Deed::Rest { face } => face,
            Deed::Turn { face, .. } => Some(face),
            _ => None,
        }
    }
}

/// All of them, and where the nominal attitude was levelled anew.
pub struct Trajectory {
    /// One a sample.
    pub moments: Vec<Moment>,
    /// Per stretch: the rotation (frame n) by which levelling at its start moved the nominal attitude.
    pub levelled: Vec<Vector3<f64>>,
    /// Variance of noise in [`Moment::mean_rate`], (rad/s)².
    pub mean_rate_variance: Vector3<f64>,
    /// Variance of noise in [`Moment::rate`], (rad/s)².
    pub rate_variance: Vector3<f64>,
}

impl Trajectory {
    /// Integrates and levels. `gravity_mps2` is what rests feel.
    pub fn new(samples: &[Raw], stretches: &[Stretch], nominal: &Nominal, gravity_mps2: f64) -> Self {
        let rates: Vec<_> = samples.iter().map(|raw| nominal.rate(raw)).collect();
        let slopes = slopes(samples, &rates);
        let noise = Quiet::of(stretches, &slopes);
        let mut walker = Walker {
            samples,
            nominal,
            gravity_mps2,
            rates,
            slopes,
            noise,
            mean_degc: mean_temperature(samples),
            attitude: UnitQuaternion::identity(),
            moments: Vec::with_capacity(samples.len()),
        };
        let levelled = stretches.iter().map(|stretch| walker.walk(stretch)).collect();
        let Quiet { scatter: rate_variance, mean: mean_rate_variance, .. } = walker.noise;
        Self { levelled, mean_rate_variance, rate_variance, moments: walker.moments }
    }
}

/// Mean temperature over the recording, °C; NaN where there is none.
pub fn mean_temperature(samples: &[Raw]) -> f64 {
    let known = || samples.iter().map(|raw| raw.temperature_degc).filter(|t| t.is_finite());
    known().sum::<f64>() / known().count() as f64
}

struct Walker<'a> {
    samples: &'a [Raw],
    nominal: &'a Nominal,
    gravity_mps2: f64,
    rates: Vec<Vector3<f64>>,
    slopes: Vec<Window>,
    noise: Quiet,
    mean_degc: f64,
    attitude: UnitQuaternion<f64>,
    moments: Vec<Moment>,
}

impl Walker<'_> {
    fn walk(&mut self, stretch: &Stretch) -> Vector3<f64> {
        // A gap before this stretch: hold what was.
        while self.moments.len() < stretch.samples.start {
            let moment = self.moment(self.moments.len(), stretch, 0.0, 0.0);
            self.moments.push(moment);
        }
        let levelled = if stretch.is_rest() { self.level(stretch) } else { Vector3::zeros() };
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        let start = stretch.samples.start;
        let (mut rested_s, mut turned_rad) = (0.0, 0.0);
        for index in stretch.samples.clone() {
            if index > start {
                let dt_s = self.samples[index].t_s - self.samples[index - 1].t_s;
                rested_s += if solid { dt_s } else { 0.0 };
                if !solid {
                    turned_rad += self.turn(index, dt_s);
                }
            }
            if index < self.moments.len() {
                // Shared with the stretch before: belongs to this one from now on.
                self.moments.truncate(index);
            }
            let moment = self.moment(index, stretch, rested_s, turned_rad);
            self.moments.push(moment);
        }
        levelled
    }

    /// Carries attitude over one interval, and the Earth.
    fn turn(&mut self, index: usize, dt_s: f64) -> f64 {
        let (a, b) = (self.rates[index - 1], self.rates[index]);
        let bend = integrate::bend(index, self.rates.len(), |index| self.samples[index].t_s, |index| self.rates[index]);
        let rotation = integrate::rotation(&a, &b, &bend, dt_s);
        let earth = UnitQuaternion::from_scaled_axis(-self.nominal.earth * dt_s);
        let before = self.attitude;
        self.attitude = earth * before * rotation;
        (before * ((a + b) * (0.5 * dt_s) + bend)).z
    }

    fn level(&mut self, stretch: &Stretch) -> Vector3<f64> {
        // Held in a hand, attitude moves: what levels is the first half second.
        let samples = &self.samples[stretch.samples.clone()];
        let end_s = samples[0].t_s + 0.5;
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        let (mut sum, mut count) = (Vector3::zeros(), 0.0);
        for raw in samples.iter().take_while(|raw| solid || raw.t_s < end_s) {
            sum += self.nominal.force(raw);
            count += 1.0;
        }
        let up = self.attitude * (sum / count);
        let rotation = UnitQuaternion::rotation_between(&up, &Vector3::z())
            .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
        self.attitude = rotation * self.attitude;
        rotation.scaled_axis()
    }

    fn moment(&self, index: usize, stretch: &Stretch, rested_s: f64, turned_rad: f64) -> Moment {
        let raw = &self.samples[index];
        let rate = self.rates[index];
        let gravity = self.attitude.inverse_transform_vector(&(Vector3::z() * self.gravity_mps2));
        let (force, jerk) = match stretch.deed {
            Deed::Move => (self.nominal.force(raw), gravity.cross(&rate)),
            Deed::Rest { .. } => (gravity, Vector3::zeros()),
            _ => (gravity, gravity.cross(&rate)),
        };
        let warmth_degc = raw.temperature_degc - self.mean_degc;
        let solid = matches!(stretch.deed, Deed::Rest { .. });
        let tremor = if solid { Vector3::zeros() } else { self.noise.tremor(&self.slopes[index]) };
        let mean_rate = if solid { Vector3::zeros() } else { self.slopes[index].mean };
        Moment {
            index,
            t_s: raw.t_s,
            attitude: self.attitude,
            to_n: self.attitude.to_rotation_matrix().into_inner(),
            rate: if solid { Vector3::zeros() } else { rate },
            mean_rate,
            smooth_rate: standing_out(&mean_rate, &tremor),
            tremor,
            acceleration: if solid { Vector3::zeros() } else { self.slopes[index].slope },
            zero: self.nominal.gyro_bias,
            force,
            jerk,
            raw_rate: raw.rate,
            raw_force: raw.force,
            warmth_degc: if warmth_degc.is_finite() { warmth_degc } else { 0.0 },
            stretch: stretch.number,
            deed: stretch.deed,
            rested_s,
            turned_rad,
        }
    }
}

/// Components beyond six sigma, where noise does not turn a sign once in a session (2e-9 a window).
fn standing_out(mean: &Vector3<f64>, sigma: &Vector3<f64>) -> Vector3<f64> {
    mean.zip_map(sigma, |mean, sigma| if mean.abs() > 6.0 * sigma { mean } else { 0.0 })
}

/// The rate over `SLOPE_S` to either side.
#[derive(Clone, Copy)]
struct Window {
    mean: Vector3<f64>,
    /// By least squares.
    slope: Vector3<f64>,
    /// About the straight line, mean square.
    scatter: Vector3<f64>,
}

/// What windows show of a rate that is none: noise.
struct Quiet {
    /// Mean scatter.
    scatter: Vector3<f64>,
    /// What it may be by chance: five sigma above its mean.
    chance: Vector3<f64>,
    /// Variance of the means.
    mean: Vector3<f64>,
}

impl Quiet {
    fn of(stretches: &[Stretch], windows: &[Window]) -> Self {
        let (mut scatter, mut squares, mut mean) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        let mut count = 0.0;
        for stretch in stretches.iter().filter(|stretch| matches!(stretch.deed, Deed::Rest { .. })) {
            let windows = &windows[stretch.samples.clone()];
            let middle = windows.iter().map(|window| window.mean).sum::<Vector3<f64>>() / windows.len() as f64;
            for window in windows {
                scatter += window.scatter;
                squares += window.scatter.map(|v| v * v);
                mean += (window.mean - middle).map(|v| v * v);
                count += 1.0;
            }
        }
        let share = 1.0 / f64::max(count, 1.0);
        let scatter = scatter * share;
        let chance =
            scatter.zip_map(&(squares * share), |mean, square| mean + 5.0 * (square - mean * mean).max(0.0).sqrt());
        Self { scatter, chance, mean: mean * share }
    }

    /// Noise's own scatter differs from window to window by a third: taken for tremor, half of all windows trembled.
    fn tremor(&self, window: &Window) -> Vector3<f64> {
        Vector3::from_fn(|i, _| {
            let trembles = window.scatter[i] > self.chance[i];
            let beyond = if trembles { window.scatter[i] - self.scatter[i] } else { 0.0 };
            (beyond + self.mean[i]).sqrt()
        })
    }
}

fn slopes(samples: &[Raw], rates: &[Vector3<f64>]) -> Vec<Window> {
    let (mut first, mut end) = (0, 0);
    samples
        .iter()
        .map(|middle| {
            while samples[first].t_s < middle.t_s - SLOPE_S {
                first += 1;
            }
            while end < samples.len() && samples[end].t_s <= middle.t_s + SLOPE_S {
                end += 1;
            }
            window(&samples[first..end], &rates[first..end])
        })
        .collect()
}

fn window(samples: &[Raw], rates: &[Vector3<f64>]) -> Window {
    let count = samples.len() as f64;
    let mean_s = samples.iter().map(|raw| raw.t_s).sum::<f64>() / count;
    let (mut sum, mut moment, mut squares, mut inertia) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros(), 0.0);
    for (raw, rate) in samples.iter().zip(rates) {
        let lever_s = raw.t_s - mean_s;
        sum += rate;
        moment += rate * lever_s;
        squares += rate.component_mul(rate);
        inertia += lever_s * lever_s;
    }
    let mean = sum / count;
    let slope = if inertia > 0.0 { moment / inertia } else { Vector3::zeros() };
    let scatter = squares / count - mean.component_mul(&mean) - slope.component_mul(&slope) * (inertia / count);
    Window { mean, slope, scatter: scatter.map(|v| v.max(0.0)) }
}
