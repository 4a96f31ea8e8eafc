//! From one rest to the next: the rotation between them, and gravity on the way where the box stood on the table.

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};
use tumble_core::estimate::walk;
use tumble_core::face::Face;
use tumble_core::tape::Kind;

use super::Setting;
use super::unknowns::{GYRO, Globals, LEVER, Rest, Unknowns};
use super::walked::{self, MeanNoise, Reading, Walked};
use crate::reference::data::Stretch;
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
    /// The face it is made on, if it is known to stay in the table's plane.
    plated: Option<Plated>,
}

/// A turn's plate: `docs/method.md`, "plate in a turn".
#[derive(Clone, Copy)]
struct Plated {
    face: Face,
    /// Unknowns of the face's own error and of its wobble.
    facet: usize,
    wobble: usize,
    /// Of one component of a reading, rad².
    variance: f64,
}

impl Leg<'_> {
    /// The plate, in every third whole group.
    fn plate(&self, group: usize, intervals: usize) -> Option<&Plated> {
        let looked_at = (group + 1).is_multiple_of(usize::from(walk::PLATED)) && intervals == self.group;
        self.plated.as_ref().filter(|_| looked_at)
    }
}

impl Plated {
    /// The face's normal with its error and what turns with the box of a wobble, frame b.
    fn normal(&self, x: &[f64]) -> Vector3<f64> {
        let plane = self.face.plane();
        let leaning = |axis: usize| plane[axis].cast() * (x[self.facet + axis] + x[self.wobble + axis]);
        self.face.normal().cast() + leaning(0) + leaning(1)
    }
}

/// The block of all residuals between two rests, whitened together: a mean of gravity and the attitude at the end share the
/// gyroscope's noise up to then.
/// `facet`: unknowns of the error of the face that the first of them is on.
pub(super) fn link<'a>(
    setting: &Setting<'a>,
    unknowns: &mut Unknowns,
    from: Rest,
    to: Rest,
    facet: Option<usize>,
) -> Block<'a> {
    let stretches = &setting.stretches[from.stretch + 1..to.stretch];
    let duration_s: f64 = stretches.iter().map(|stretch| stretch.duration_s).sum();
    let mut face = setting.stretches[from.stretch].face.zip(facet).filter(|_| setting.plate_known(from));
    let mut legs: Vec<Leg> = Vec::new();
    for stretch in stretches {
        face = face.filter(|_| matches!(stretch.segment.kind, Kind::OnTable { .. }));
        let leg = leg(setting, unknowns, stretch, duration_s);
        let plated = face.filter(|_| leg.pivot.is_some()).map(|face| plated(setting, unknowns, face, &leg));
        legs.push(Leg { plated, ..leg });
    }
    let gravity = f64::from(setting.conditions.gravity_mps2);
    let covariance = covariance(&legs, gravity, setting.mean_noise);
    let whitener = covariance.cholesky().map(nalgebra::Cholesky::unpack);
    // All that is shared: both corrections and the lever.
    let depends = (GYRO..LEVER + 3).chain(from.all()).chain(to.all()).chain(from.earth..from.earth + 3);
    let depends = depends.chain(from.table..from.table + 2);
    let plates = legs.iter().filter_map(|leg| leg.plated);
    let wobbles = plates.flat_map(|plate| plate.wobble..plate.wobble + 2);
    let facets = legs.iter().find_map(|leg| leg.plated).into_iter().flat_map(|plate| plate.facet..plate.facet + 2);
    let pivots = legs.iter().filter_map(|leg| leg.pivot).flat_map(|first| first..first + 3);
    let depends: Vec<usize> = depends.chain(pivots).chain(facets).chain(wobbles).collect();
    Block::new(depends, move |x| {
        let residual = residual(&legs, x, from, to, gravity, duration_s);
        let white = whitener.as_ref().and_then(|whitener| whitener.solve_lower_triangular(&residual));
        white.unwrap_or(residual).as_slice().to_vec()
    })
}

fn leg<'a>(setting: &Setting<'a>, unknowns: &mut Unknowns, stretch: &'a Stretch, duration_s: f64) -> Leg<'a> {
    let noise = setting.noise;
    let own = setting.segments.get(stretch.number);
    let scale = f64::from(noise.moving(&stretch.segment) * own.map_or(1.0, |own| own.rate_scale));
    // A walking bias, taken as straight between two rests, bends by a Brownian bridge of area variance q T³/12.
    let bridge = f64::from(noise.total_bias_walk()) * duration_s * duration_s / 12.0;
    let dt_s = stretch.duration_s / stretch.intervals.len() as f64;
    Leg {
        stretch,
        pivot: stretch.is_turn().then(|| unknowns.add_with_prior(3, f64::from(noise.pivot_sigma_m))),
        rate_density: f64::from(noise.rate_density) * scale + bridge,
        force_density: f64::from(noise.force_density * own.map_or(1.0, |own| own.force_scale)),
        group: ((GROUP_S / dt_s).round() as usize).max(1),
        plated: None,
    }
}

/// What of a wobble does not turn with the box is coherent: its variance counts once for every reading of the turn (`walk.rs`).
fn plated(setting: &Setting, unknowns: &mut Unknowns, (face, facet): (Face, usize), leg: &Leg) -> Plated {
    let square = |sigma: f32| f64::from(sigma).powi(2);
    let wobble = square(setting.noise.wobble_sigma_rad);
    let coherent = square(setting.noise.rocking_sigma_rad) + f64::from(walk::UNSTEADY) * wobble;
    let readings = leg.stretch.intervals.len() as f64 / (leg.group * usize::from(walk::PLATED)) as f64;
    Plated {
        face,
        facet,
        wobble: unknowns.add_with_prior(2, wobble.sqrt()),
        variance: square(walk::WHITE) + coherent * readings.max(1.0),
    }
}

/// Whose noise each residual of [`residual`] has: gravity sees the attitude's error as `ε × g ẑ`, the plate as `ε × ẑ`.
fn covariance(legs: &[Leg], gravity: f64, kind: MeanNoise) -> DMatrix<f64> {
    let (mut readings, mut groups, mut walked) = (Vec::new(), Vec::new(), 0.0);
    for leg in legs {
        for (number, group) in leg.stretch.intervals.chunks(leg.group).enumerate() {
            let seconds: f64 = group.iter().map(|interval| interval.dt_s).sum();
            let (here, own) = (groups.len(), leg.rate_density * seconds);
            let mut read = |axis: Vector3<f64>, own: f64| readings.push(Reading { group: here, axis, own });
            if leg.pivot.is_some() {
                let axes = [Vector3::y() * gravity, Vector3::x() * -gravity, Vector3::zeros()];
                axes.into_iter().for_each(|axis| read(axis, leg.force_density / seconds));
            }
            if let Some(plate) = leg.plate(number, group.len()) {
                [Vector3::y(), -Vector3::x()].into_iter().for_each(|axis| read(axis, plate.variance));
            }
            groups.push(Walked { before: walked, own });
            walked += own;
        }
    }
    let end = [Vector3::x(), Vector3::y(), Vector3::z()];
    readings.extend(end.map(|axis| Reading { group: groups.len(), axis, own: 0.0 }));
    walked::covariance(&readings, &groups, walked, kind)
}

/// Of every group the mean of `R (A (f − a) − L l) − g ẑ` and, where the plate is looked at, of `(R (n + e + w))ₓᵧ − p`, then `log(R₁ R₂ᵀ)` of the carried against the next rest's attitude.
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
        for (number, group) in leg.stretch.intervals.chunks(leg.group).enumerate() {
            let (mut impulse, mut face, mut seconds) = (Vector3::zeros(), Vector3::zeros(), 0.0);
            for interval in group {
                let dt_s = interval.dt_s;
                let bias = biases[0] + (biases[1] - biases[0]) * ((since_s + 0.5 * dt_s) / duration_s);
                let turn = interval.turned(&gyro, &bias);
                let earth = UnitQuaternion::from_scaled_axis(earth * -dt_s);
                if let Some(lever) = &lever {
                    let middle = rotation * turn.powf(0.5);
                    face += leg.plated.map_or_else(Vector3::zeros, |plate| middle * plate.normal(x)) * dt_s;
                    let swung = swung(lever, &(gyro * (interval.smooth_rate - bias)), &(gyro * interval.slope));
                    impulse += middle * (accel * (interval.force - force_bias) - swung) * dt_s;
                }
                rotation = earth * rotation * turn;
                since_s += dt_s;
                seconds += dt_s;
            }
            if lever.is_some() {
                residual.extend_from_slice((impulse / seconds - Vector3::z() * gravity).as_slice());
            }
            if leg.plate(number, group.len()).is_some() {
                residual.extend((0..2).map(|axis| face[axis] / seconds - x[from.table + axis]));
            }
        }
    }
    residual.extend_from_slice((rotation * to.rotation(x).inverse()).scaled_axis().as_slice());
    DVector::from_vec(residual)
}

/// Acceleration of a point that turns about another, `ω × (ω × l) + ω̇ × l`.
fn swung(lever: &Vector3<f64>, rate: &Vector3<f64>, slope: &Vector3<f64>) -> Vector3<f64> {
    rate.cross(&rate.cross(lever)) + slope.cross(lever)
}
