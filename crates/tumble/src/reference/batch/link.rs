//! From one rest to the next: the rotation between them, and gravity on the way where the box stood on the table.

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};

use super::Setting;
use super::unknowns::{GYRO, Globals, LEVER, Rest, Unknowns};
use crate::reference::data::{Stretch, turned};
use crate::reference::solve::Block;

/// Gravity in a turn is averaged over this, s, as on the device.
const GROUP_S: f64 = 0.5;

/// A motion between the rests.
#[derive(Clone, Copy)]
struct Leg<'a> {
    stretch: &'a Stretch,
    /// Unknowns of the turn's own pivot; none for a move by hand.
    pivot: Option<usize>,
    /// rad²/s.
    rate_density: f64,
    /// (m/s²)² s.
    force_density: f64,
    /// Intervals of one mean.
    group: usize,
}

/// The block of all residuals between two rests, whitened together: a mean of gravity and the attitude at the end share the
/// gyroscope's noise up to then.
pub(super) fn link<'a>(setting: &Setting<'a>, unknowns: &mut Unknowns, from: Rest, to: Rest) -> Block<'a> {
    let stretches = &setting.stretches[from.stretch + 1..to.stretch];
    let duration_s: f64 = stretches.iter().map(|stretch| stretch.duration_s).sum();
    let legs: Vec<Leg> = stretches.iter().map(|stretch| leg(setting, unknowns, stretch, duration_s)).collect();
    let gravity = f64::from(setting.conditions.gravity_mps2);
    let covariance = covariance(&legs, gravity);
    let whitener = covariance.cholesky().map(nalgebra::Cholesky::unpack);
    // All that is shared: both corrections and the lever.
    let depends = (GYRO..LEVER + 3).chain(from.all()).chain(to.all()).chain(from.earth..from.earth + 3);
    let pivots = legs.iter().filter_map(|leg| leg.pivot).flat_map(|first| first..first + 3);
    let depends: Vec<usize> = depends.chain(pivots).collect();
    Block::new(depends, move |x| {
        let residual = residual(&legs, x, from, to, gravity, duration_s);
        let white = whitener.as_ref().and_then(|whitener| whitener.solve_lower_triangular(&residual));
        white.unwrap_or(residual).as_slice().to_vec()
    })
}

fn leg<'a>(setting: &Setting<'a>, unknowns: &mut Unknowns, stretch: &'a Stretch, duration_s: f64) -> Leg<'a> {
    let noise = setting.noise;
    let own = setting.segments.get(stretch.number);
    let scale = f64::from(noise.motion_scale * own.map_or(1.0, |own| own.rate_scale));
    // A walking bias, taken as straight between two rests, bends by a Brownian bridge of area variance q T³/12.
    let bridge = f64::from(noise.total_bias_walk()) * duration_s * duration_s / 12.0;
    let dt_s = stretch.duration_s / stretch.intervals.len() as f64;
    Leg {
        stretch,
        pivot: stretch.is_turn().then(|| unknowns.add_with_prior(3, f64::from(noise.pivot_sigma_m))),
        rate_density: f64::from(noise.rate_density) * scale + bridge,
        force_density: f64::from(noise.force_density * own.map_or(1.0, |own| own.force_scale)),
        group: ((GROUP_S / dt_s).round() as usize).max(1),
    }
}

/// Attitude noise walks: variance `v` where a group begins and `o` more in it give its mean `v + o/3`, against
/// all that comes after `v + o/2`. Gravity sees it as `ε × g ẑ`.
fn covariance(legs: &[Leg], gravity: f64) -> DMatrix<f64> {
    // Per group: walk's variance of the mean, covariance with what is later, and the force's own.
    let mut groups: Vec<(f64, f64, f64)> = Vec::new();
    let mut walked = 0.0;
    for leg in legs {
        if leg.pivot.is_none() {
            walked += leg.rate_density * leg.stretch.duration_s;
            continue;
        }
        for group in leg.stretch.intervals.chunks(leg.group) {
            let seconds: f64 = group.iter().map(|interval| interval.dt_s).sum();
            let own = leg.rate_density * seconds;
            groups.push((walked + own / 3.0, walked + own / 2.0, leg.force_density / seconds));
            walked += own;
        }
    }
    let end = 3 * groups.len();
    let mut matrix = DMatrix::zeros(end + 3, end + 3);
    for (i, &(variance, later, force)) in groups.iter().enumerate() {
        for axis in 0..3 {
            matrix[(3 * i + axis, 3 * i + axis)] = force;
        }
        for j in i..groups.len() {
            let shared = gravity * gravity * if i == j { variance } else { later };
            for axis in 0..2 {
                matrix[(3 * i + axis, 3 * j + axis)] += shared;
                matrix[(3 * j + axis, 3 * i + axis)] = matrix[(3 * i + axis, 3 * j + axis)];
            }
        }
        for (row, column, sign) in [(3 * i, end + 1, 1.0), (3 * i + 1, end, -1.0)] {
            matrix[(row, column)] = sign * gravity * later;
            matrix[(column, row)] = matrix[(row, column)];
        }
    }
    (end..end + 3).for_each(|i| matrix[(i, i)] = walked);
    matrix
}

/// Mean `R (A (f − a) − L l) − g ẑ` of every group, then `log(R₁ R₂ᵀ)` of the carried against the next rest's attitude.
fn residual(legs: &[Leg], x: &[f64], from: Rest, to: Rest, gravity: f64, duration_s: f64) -> DVector<f64> {
    let (gyro, accel) = (Globals::gyro(x), Globals::accel(x));
    let biases = [from, to].map(|rest| rest.vector(x, rest.rate_bias()));
    let force_bias = 0.5 * (from.vector(x, from.force_bias()) + to.vector(x, to.force_bias()));
    let (earth, common) = (from.vector(x, from.earth), from.vector(x, LEVER));
    let mut rotation = from.rotation(x);
    let mut since_s = 0.0;
    let mut residual = Vec::new();
    for leg in legs {
        let lever = leg.pivot.map(|pivot| common + from.vector(x, pivot));
        for group in leg.stretch.intervals.chunks(leg.group) {
            let (mut impulse, mut seconds) = (Vector3::zeros(), 0.0);
            for interval in group {
                let dt_s = interval.dt_s;
                let bias = biases[0] + (biases[1] - biases[0]) * ((since_s + 0.5 * dt_s) / duration_s);
                let [a, b] = interval.rates.map(|rate| gyro * (rate - bias));
                let turn = turned(&a, &b, dt_s);
                let earth = UnitQuaternion::from_scaled_axis(earth * -dt_s);
                if let Some(lever) = &lever {
                    let (rate, slope) = (gyro * (interval.smooth_rate - bias), gyro * interval.slope);
                    let swung = rate.cross(&rate.cross(lever)) + slope.cross(lever);
                    let middle = rotation * turn.powf(0.5);
                    impulse += middle * (accel * (interval.force - force_bias) - swung) * dt_s;
                }
                rotation = earth * rotation * turn;
                since_s += dt_s;
                seconds += dt_s;
            }
            if lever.is_some() {
                residual.extend_from_slice((impulse / seconds - Vector3::z() * gravity).as_slice());
            }
        }
    }
    residual.extend_from_slice((rotation * to.rotation(x).inverse()).scaled_axis().as_slice());
    DVector::from_vec(residual)
}
