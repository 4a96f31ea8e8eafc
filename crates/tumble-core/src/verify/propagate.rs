//! Gravity's direction carried along by the gyroscope.

use nalgebra::Vector3;

use crate::sample::Sample;

/// A step longer than this, s, is a gap: at 200 Hz ten samples are missing, and a hand turns by degrees in that time.
const GAP_S: f32 = 0.05;

/// A direction that is fixed in the room, in the box's axes: `u̇ = u × ω`, hence `u(t + dt) = exp(−[φ]×) u(t)` with the step's
/// rotation vector `φ = dt/2 (ω₀ + ω₁) + dt²/12 ω₀ × ω₁` (Magnus, exact to third order for a rate that is linear in time). At
/// 200 Hz this leaves 0.006 °/s of the coning of a hand that shakes at 2 rad/s and 2 Hz about two axes at once, and twice
/// that without the cross term; this worst case is as large as the bias instability that the limits allow.
#[derive(Clone, Debug, Default)]
pub struct Propagation {
    up: Option<Vector3<f32>>,
    start_variance: f32,
    last: Option<(u64, Vector3<f32>)>,
    gap: bool,
    duration_s: f32,
    path_rad: Vector3<f32>,
}

impl Propagation {
    /// Starts afresh from a measured direction, whose variance per axis is `start_variance` (rad²).
    pub fn restart(&mut self, up: Vector3<f32>, start_variance: f32) {
        *self = Self { up: Some(up), start_variance, last: self.last, ..Self::default() };
    }

    /// Carries the direction on to this sample; gives the step's length in s, 0 for the first and after a gap.
    pub fn step(&mut self, sample: &Sample) -> f32 {
        let rate = sample.angular_rate_rad_s;
        let Some((t_us, rate_before)) = self.last.replace((sample.t_us, rate)) else {
            return 0.0;
        };
        let dt_s = sample.t_us.saturating_sub(t_us) as f32 * 1e-6;
        if dt_s > GAP_S {
            self.gap = true;
            return 0.0;
        }
        let mean = (rate_before + rate) * 0.5;
        self.duration_s += dt_s;
        self.path_rad += mean.abs() * dt_s;
        let rotation = mean * dt_s + rate_before.cross(&rate) * (dt_s * dt_s / 12.0);
        self.up = self.up.map(|up| rotate(&up, &-rotation));
        dt_s
    }

    /// The angle between the direction carried here and one measured here, rad; none without a start or with a gap since.
    pub fn angle_to(&self, measured: &Vector3<f32>) -> Option<f32> {
        let up = self.up.filter(|_| !self.gap)?;
        Some(libm::atan2f(up.cross(measured).norm(), up.dot(measured)))
    }

    /// Since the start, s.
    pub fn duration_s(&self) -> f32 {
        self.duration_s
    }

    /// Sum of |rotation| about each axis since the start, rad.
    pub fn path_rad(&self) -> &Vector3<f32> {
        &self.path_rad
    }

    /// Variance of the start's direction per axis, rad².
    pub fn start_variance(&self) -> f32 {
        self.start_variance
    }
}

/// Rodrigues: `exp([φ]×) u = u + sin θ/θ φ×u + (1 − cos θ)/θ² φ×(φ×u)`. The second quotient is written with the half angle,
/// because `1 − cos θ` of a 200 Hz step keeps no digit in `f32`; below 1e-4 rad both quotients are their limits to 1e-9.
fn rotate(u: &Vector3<f32>, rotation: &Vector3<f32>) -> Vector3<f32> {
    let angle = rotation.norm();
    let (first, second) = if angle < 1e-4 {
        (1.0, 0.5)
    } else {
        let half = libm::sinf(angle * 0.5) / angle;
        (libm::sinf(angle) / angle, 2.0 * half * half)
    };
    let once = rotation.cross(u);
    u + once * first + rotation.cross(&once) * second
}
