//! Stays on one face: rests and turns in a row, between two re-orientations.

use nalgebra::{Matrix3, Vector3};

use super::{Real, RestRates, real, vector};
use crate::face::Face;
use crate::tape::{Exclusion, Kind, Record, Segment, Tape};

/// A stay on one face, from its first rest to its last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Visit {
    /// Which axis is up.
    pub face: Face,
    /// First segment.
    pub first: usize,
    /// One past the last segment.
    pub end: usize,
}

/// All stays, in order of time. What is excluded ends a stay.
pub fn visits<const R: usize, const S: usize>(tape: &Tape<R, S>) -> impl Iterator<Item = Visit> + '_ {
    let mut next = 0;
    core::iter::from_fn(move || {
        let left = tape.segments().get(next..)?;
        let skipped = left.iter().position(|segment| segment.is_usable_still() && segment.face().is_some())?;
        let first = next + skipped;
        let stay = left.get(skipped..)?;
        let face = stay.first()?.face()?;
        let on_it = |segment: &&Segment| segment.exclusion == Exclusion::None && segment.face() == Some(face);
        let mut length = stay.iter().take_while(on_it).count();
        next = first + length;
        while length > 1 && !stay.get(length - 1).is_some_and(Segment::is_usable_still) {
            length -= 1;
        }
        Some(Visit { face, first, end: first + length })
    })
}

/// A record on the way, calibrated, and where the box stood.
#[derive(Clone, Copy, Debug)]
pub struct Instant<T: Real> {
    /// Record's index.
    pub index: usize,
    /// Length, s.
    pub dt_s: T,
    /// Does the box turn?
    pub turning: bool,
    /// Rotation vector, frame b, the level frame's own rotation taken out, rad. Noise at rest.
    pub rotation_rad: Vector3<T>,
    /// Raw specific force, sensor axes, m/s².
    pub raw_force_mps2: Vector3<T>,
    /// Rotation about up since the stay began, at the record's middle, rad; rests add none.
    pub heading_rad: T,
    /// Its rate, rad/s.
    pub rate_rad_s: T,
    /// Its growth, rad/s².
    pub acceleration_rad_s2: T,
}

impl Visit {
    /// The upward direction, frame b.
    pub fn up<T: Real>(&self) -> Vector3<T> {
        vector(&self.face.normal())
    }

    /// Two box axes u, v that make a right-handed frame with up: u the next box axis, `v = up × u`.
    pub fn plane<T: Real>(&self) -> [Vector3<T>; 2] {
        let up = self.up::<T>();
        let u = Vector3::from_fn(|axis, _| if axis == (self.face.axis() + 1) % 3 { T::one() } else { T::zero() });
        [u, up.cross(&u)]
    }

    /// Its segments.
    pub fn segments<'a, const R: usize, const S: usize>(&self, tape: &'a Tape<R, S>) -> &'a [Segment] {
        tape.segments().get(self.first..self.end).unwrap_or_default()
    }

    /// Walks over all its records. `correction` is the gyroscope's.
    pub fn for_each<T: Real, const R: usize, const S: usize>(
        &self,
        tape: &Tape<R, S>,
        rest: &RestRates<T>,
        correction: &Matrix3<T>,
        mut take: impl FnMut(&Segment, &Instant<T>),
    ) {
        let up = self.up::<T>();
        let half: T = real(0.5);
        let mut heading_rad = T::zero();
        for segment in self.segments(tape) {
            let turning = matches!(segment.kind, Kind::OnTable { .. });
            let still = rest.rate(segment.start_us / 2 + segment.end_us / 2, &up);
            let turned = |record: &Record| {
                let raw = vector::<T>(&record.rotation_rad) - still * real::<T>(record.dt_s);
                correction * raw
            };
            for index in usize::from(segment.first)..usize::from(segment.end) {
                let Some(record) = tape.record(index) else { break };
                let dt_s: T = real(record.dt_s);
                let rotation_rad = turned(&record);
                let about_up = if turning { rotation_rad.dot(&up) } else { T::zero() };
                let growth = if turning { growth(tape, index, &record, |r| turned(r).dot(&up)) } else { T::zero() };
                let instant = Instant {
                    index,
                    dt_s,
                    turning,
                    rotation_rad,
                    raw_force_mps2: vector(&record.specific_force_mps2),
                    heading_rad: heading_rad + about_up * half,
                    rate_rad_s: about_up / dt_s,
                    acceleration_rad_s2: growth,
                };
                take(segment, &instant);
                heading_rad += about_up;
            }
        }
    }
}

/// The rate's growth over a record from its neighbours' rates.
fn growth<T: Real, const R: usize, const S: usize>(
    tape: &Tape<R, S>,
    index: usize,
    record: &Record,
    angle: impl Fn(&Record) -> T,
) -> T {
    let before = index.checked_sub(1).and_then(|index| tape.record(index)).unwrap_or(*record);
    let after = tape.record(index + 1).unwrap_or(*record);
    let rate = |record: &Record| angle(record) / real(record.dt_s);
    let span: T = real(0.5 * (before.dt_s + after.dt_s) + record.dt_s);
    (rate(&after) - rate(&before)) / span
}
