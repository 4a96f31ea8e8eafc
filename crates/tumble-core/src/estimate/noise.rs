//! What noise the session shows: from the scatter of its own rests first, from innovations later.

use heapless::Vec;
use nalgebra::{Matrix3, Vector3};

use super::facets::{CONTACT, SQUARE};
use super::resting::Account;
use super::scatter::{pooled, scatter};
use super::wobble::UNSEEN;
use crate::DEGREE_RAD;
use crate::motion::grain::SOLID;
use crate::setup::{BoxFaces, TurnStops};
use crate::tape::{ANGLE_UNIT_RAD, FORCE_UNIT_MPS2, Kind, Segment, Tape};

/// MPU-9250 sheet: 0.01 °/s/√Hz. The double-sided density of a rate is half of its square.
pub const SHEET_RATE_DENSITY: f32 = 0.01 * DEGREE_RAD * core::f32::consts::FRAC_1_SQRT_2;
/// MPU-9250 sheet: 300 µg/√Hz, likewise.
pub const SHEET_FORCE_DENSITY: f32 = 300e-6 * crate::STANDARD_GRAVITY_MPS2 * core::f32::consts::FRAC_1_SQRT_2;
/// Variance of a sum over records by the tape's rounding in its units squared: with its remainder carried into the next record it
/// is that of two roundings, one at each end, whatever the sum's length.
pub const ROUNDED: f32 = 1.0 / 6.0;
/// The same of a difference of neighbours, `−r₁ + 2 r₂ − r₃`: what the rests' scatter has of it.
const ROUNDED_DIFFERENCE: f32 = 0.5;
/// Length of a record at rest, and of the shortest sum whose rounding and whose quiet matter, s.
pub const REST_RECORD_S: f32 = 0.5;
const SHORTEST_S: f32 = 2.0;
/// A person who stops by eye (sim, `design.md` §2), before its closures are seen.
const BY_HAND: f32 = 2.0 * DEGREE_RAD;
/// What a stop against a fence is taken for before its innovations are seen.
const FENCED: f32 = 0.05 * DEGREE_RAD;
/// How far a hand moves a turn's axis from one turn to the next before innovations are seen, m, and the least that is believed of
/// it: 50 µm moves the specific force of a 36 °/s turn by 2 µg.
const PIVOT: f32 = 5e-3;
/// The least that a pivot moves by, m.
pub const PIVOT_FLOOR: f32 = 50e-6;
/// A bias wanders at least 0.1 mdps in 100 s and at most 60 mdps, (rad/s)²/s.
pub(super) const WALK_FLOOR: f32 = 0.01e-6 * DEGREE_RAD * DEGREE_RAD / 100.0;
const WALK_CAP: f32 = 3.6e-3 * DEGREE_RAD * DEGREE_RAD / 100.0;
/// Likewise 10 µg in 100 s and 3 mg, (m/s²)²/s.
pub(super) const FORCE_WALK_FLOOR: f32 = 1e-11;
const FORCE_WALK_CAP: f32 = 1e-5;

/// Densities and sigmas in force. The densities leave the tape's rounding of a single record out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Variance of a rotation per second of integration, rad²/s.
    pub rate_density: f32,
    /// Variance of a mean specific force times its duration, (m/s²)² s.
    pub force_density: f32,
    /// Growth of a gyroscope bias's variance, (rad/s)²/s.
    pub bias_walk: f32,
    /// Straight part of the gyroscope bias's drift, (rad/s)/s.
    pub bias_slope: Vector3<f32>,
    /// How the gyroscope's bias follows the specific force, (rad/s)/(m/s²); zero where nothing says that it does.
    pub g_sensitivity: Matrix3<f32>,
    /// What is added to `bias_walk` because neither is exactly known, (rad/s)²/s.
    pub account_walk: f32,
    /// Growth of an accelerometer bias's variance, (m/s²)²/s.
    pub force_walk: f32,
    /// Factor on `rate_density` in turns on the table …
    pub turn_scale: f32,
    /// … and in moves by hand, whose put-downs ring.
    pub hand_scale: f32,
    /// One stop of a turn, rad.
    pub stop_sigma_rad: f32,
    /// How far a turn's axis is from where it is in other turns, m.
    pub pivot_sigma_m: f32,
    /// One face of the box, rad; none where it is not known to be square.
    pub facet_sigma_rad: Option<f32>,
    /// How well a face's contact with the table repeats from rest to rest, rad.
    pub contact_sigma_rad: f32,
    /// Are faces certain not to be square?
    pub crooked: bool,
    /// How far the face that a turn is made on leaves the table during the turn, rad: what turns with the box …
    pub wobble_sigma_rad: f32,
    /// … and the rest.
    pub rocking_sigma_rad: f32,
    /// Rates' sample variance of the quietest rest, or half of what rounding alone can make of it, (rad/s)².
    pub quiet_variance: f32,
    /// Variance of what the rounding of the sensor's numbers leaves in a mean rate, (rad/s)² (`motion/grain.rs`).
    pub rate_rounding: f32,
    /// Length of all rests on something solid, s: they show the same reading, which errs the same way in all of them.
    pub solid_s: f32,
    /// As `rate_rounding`, of a mean specific force, times how many rests and turns a visit has, (m/s²)²: these show the same
    /// reading, and every face another.
    pub force_rounding: f32,
}

impl Noise {
    /// From the rests' scatter.
    pub fn from_rests<const R: usize, const S: usize>(tape: &Tape<R, S>, stops: TurnStops, faces: BoxFaces) -> Self {
        let quiet_variance = quietest(tape);
        let mut rate = Vec::<(f32, f32), S>::new();
        let mut force = Vec::<(f32, f32), S>::new();
        for segment in tape.segments().iter().filter(|segment| segment.is_usable_still()) {
            if is_solid(segment, quiet_variance) {
                let scatter = scatter(tape, segment);
                let _ = rate.push((scatter.rate, scatter.count));
                let _ = force.push((scatter.force, scatter.count));
            }
        }
        let [rate_rounding, force_rounding] = tape.grain.offset_variances();
        let (solid_s, visit) = lengths(tape, quiet_variance);
        Self {
            rate_rounding,
            solid_s,
            force_rounding: force_rounding * visit,
            rate_density: density(pooled(&mut rate), SHEET_RATE_DENSITY, ANGLE_UNIT_RAD),
            force_density: density(pooled(&mut force), SHEET_FORCE_DENSITY, FORCE_UNIT_MPS2 * REST_RECORD_S),
            bias_walk: WALK_FLOOR,
            bias_slope: Vector3::zeros(),
            g_sensitivity: Matrix3::zeros(),
            account_walk: 0.0,
            force_walk: FORCE_WALK_FLOOR,
            turn_scale: 1.0,
            hand_scale: 1.0,
            stop_sigma_rad: if stops == TurnStops::Fenced { FENCED } else { BY_HAND },
            pivot_sigma_m: PIVOT,
            contact_sigma_rad: CONTACT,
            crooked: false,
            facet_sigma_rad: (faces == BoxFaces::Square).then_some(SQUARE),
            wobble_sigma_rad: UNSEEN,
            rocking_sigma_rad: UNSEEN,
            quiet_variance,
        }
    }

    /// What a pass takes for noise at least: that of the sheet under the widest prior, and less in proportion under a narrower
    /// one, `width` being its share of the widest. Beside an attitude's prior of 0.1 rad `f32` keeps 24 µrad (a 6e-8th of the
    /// variance), where a rest of 2.5 s at the sheet's noise leaves 130 µrad and one of a sensor ten times as quiet 13.
    pub fn at_least(&self, width: f32) -> Self {
        let [rate, force] = [SHEET_RATE_DENSITY, SHEET_FORCE_DENSITY].map(|sheet| sheet * sheet * width * width);
        Self { rate_density: self.rate_density.max(rate), force_density: self.force_density.max(force), ..*self }
    }

    /// Do all parts agree to within a share?
    pub fn is_near(&self, other: &Self, share: f32) -> bool {
        let parts = |noise: &Self| {
            let facet = noise.facet_sigma_rad.unwrap_or_default();
            [
                noise.total_bias_walk(),
                noise.force_walk,
                noise.turn_scale,
                noise.hand_scale,
                noise.stop_sigma_rad,
                noise.pivot_sigma_m,
                facet,
                noise.contact_sigma_rad,
                noise.wobble_sigma_rad,
                noise.rocking_sigma_rad,
            ]
        };
        parts(self).iter().zip(parts(other)).all(|(a, b)| libm::fabsf(a - b) <= share * libm::fabsf(b))
    }

    /// Bias walk as rests show it.
    pub fn set_bias_walk(&mut self, found: f32) {
        self.bias_walk = found.clamp(WALK_FLOOR, WALK_CAP);
    }

    /// Likewise for the accelerometer.
    pub fn set_force_walk(&mut self, found: f32) {
        self.force_walk = found.clamp(FORCE_WALK_FLOOR, FORCE_WALK_CAP);
    }

    /// How crooked the box was found to be, rad, if it was called square and is certainly not. Sigmas have it whatever it is; a person is told
    /// from 0.02° on (17 µm over 5 cm), for what is less nobody can mend.
    pub fn crookedness_rad(&self) -> Option<f32> {
        const LEAST_RAD: f32 = 350e-6;
        self.facet_sigma_rad.filter(|sigma| self.crooked && *sigma > LEAST_RAD)
    }

    /// By how much the box leaned differently from rest to rest on one face, rad, if it certainly did. An accelerometer's bias that
    /// wanders by 100 µg looks like 0.1 mrad: three times that is the least that is told of the table.
    pub fn lean_rad(&self) -> Option<f32> {
        const LEAST_LEAN_RAD: f32 = 300e-6;
        Some(self.contact_sigma_rad).filter(|sigma| *sigma > LEAST_LEAN_RAD)
    }

    /// The account of the rates at rest that stands, of a session of this length with so many stays on faces. A slope's error δs grows
    /// with the time from the session's middle, with a mean square of δs² T²/12; a walk about its own mean has q T/6. Thus a walk of
    /// δs² T/2 stands for it; held by rests on both sides it errs by a quarter. An error δG shows as an offset of each stay by itself, `δG f`, which
    /// the stay's own rests tell as well as all rests together do: two stays T/n apart differ by 2 δG² g², and so does a walk.
    pub fn set_account(&mut self, account: &Account, session_s: f32, visits: f32, gravity_mps2: f32) {
        self.bias_slope = account.slope.rate;
        self.g_sensitivity = account.sensitivity.matrix;
        let offset = account.sensitivity.sigma.norm_squared() / 9.0 * gravity_mps2 * gravity_mps2;
        self.account_walk = 0.125 * account.slope.variance * session_s + 2.0 * offset * visits / session_s.max(1.0);
    }

    /// Factor on `rate_density` in this motion.
    pub fn moving(&self, segment: &Segment) -> f32 {
        if matches!(segment.kind, Kind::Hand) { self.hand_scale } else { self.turn_scale }
    }

    /// All that a gyroscope bias's variance grows by, (rad/s)²/s.
    pub fn total_bias_walk(&self) -> f32 {
        self.bias_walk + self.account_walk
    }
}

/// From the rests' scatter. Its share of rounding goes out and that of a sum comes in, which is the least there is: the sheet's sigma
/// over 14 for the gyroscope, over 30 for the accelerometer.
fn density(found: Option<f32>, sheet: f32, unit: f32) -> f32 {
    let scatter = 0.5 * ROUNDED_DIFFERENCE / REST_RECORD_S * unit * unit;
    let sum = ROUNDED / SHORTEST_S * unit * unit;
    let sheet = sheet * sheet;
    found.map_or(sheet, |found| (found - scatter).max(0.0) + sum).min(1e4 * sheet)
}

/// Length of all rests on something solid, s, and how many rests and turns a visit to a face has in the mean.
fn lengths<const R: usize, const S: usize>(tape: &Tape<R, S>, quiet_variance: f32) -> (f32, f32) {
    let (mut solid_s, mut parts, mut visits, mut stays) = (0.0, 0.0f32, 0.0f32, false);
    for segment in tape.segments() {
        let hand = matches!(segment.kind, Kind::Hand);
        if !hand {
            solid_s += if is_solid(segment, quiet_variance) { segment.duration_s() } else { 0.0 };
            parts += 1.0;
            visits += if stays { 0.0 } else { 1.0 };
        }
        stays = !hand;
    }
    (solid_s, parts / visits.max(1.0))
}

/// Rates' sample variance of the quietest rest, or half of what rounding alone can make of it. A moment within a tremor may be quiet by
/// chance, and a rest must last to be called so: one of a quarter second, taken for the table, put 54 mdps into a trembling session's bias.
fn quietest<const R: usize, const S: usize>(tape: &Tape<R, S>) -> f32 {
    let least = |shortest_s: f32| {
        let rests = tape.segments().iter().filter(|segment| segment.is_usable_still());
        let long = rests.filter(|segment| segment.duration_s() >= shortest_s);
        let variances = long.filter_map(|segment| match segment.kind {
            Kind::Still { rate_variance, .. } => Some(rate_variance.max(tape.grain.toggling())),
            _ => None,
        });
        variances.reduce(f32::min)
    };
    least(SHORTEST_S).or_else(|| least(0.0)).unwrap_or(f32::INFINITY)
}

/// A rest on something solid, as against one in the hand.
pub fn is_solid(segment: &Segment, quiet_variance: f32) -> bool {
    matches!(segment.kind, Kind::Still { rate_variance, .. } if rate_variance <= SOLID * quiet_variance)
}

#[cfg(test)]
mod tests;
