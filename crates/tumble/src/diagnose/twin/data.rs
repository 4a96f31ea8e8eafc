//! A recording as the twin takes it: raw samples in `f64` and SI, and the stretches that the board's own segmenter found.

use std::ops::Range;

use nalgebra::Vector3;
use tumble_core::estimate::hinge::Hinge;
use tumble_core::estimate::noise::{self, Noise};
use tumble_core::estimate::stand::standing;
use tumble_core::face::Face;
use tumble_core::tape::{Exclusion, Kind, Segment};

use crate::recording::{Row, STANDARD_GRAVITY_MPS2};

/// One raw reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raw {
    /// Since the first sample, s.
    pub t_s: f64,
    /// rad/s, sensor axes.
    pub rate: Vector3<f64>,
    /// m/s², sensor axes.
    pub force: Vector3<f64>,
    /// °C; NaN where the recording has none.
    pub temperature_degc: f64,
}

impl Raw {
    /// From the recording's own units.
    pub fn of(row: &Row, origin_s: f64) -> Self {
        Self {
            t_s: row.t_s - origin_s,
            rate: Vector3::from(row.gyro_dps.map(f64::to_radians)),
            force: Vector3::from(row.accel_g.map(|v| v * STANDARD_GRAVITY_MPS2)),
            temperature_degc: row.temp_c.unwrap_or(f64::NAN),
        }
    }
}

/// How a move ended, as the device's estimator saw it.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// The level after it.
    pub hinge: Hinge,
    /// What a walk of unit density of the gyroscope's bias makes of [`Hinge::walked`] …
    pub by_bias_walk: f64,
    /// … and one of the accelerometer's.
    pub by_force_walk: f64,
}

/// What happened in a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deed {
    /// At rest on something solid.
    Rest {
        /// The face that it stands on the table with, if any.
        face: Option<Face>,
    },
    /// At rest in a hand: attitude is carried by the gyroscope.
    Held,
    /// On the table, on one face; `angle_rad` about up, counter-clockwise from above positive.
    Turn {
        /// Which axis is up.
        face: Face,
        /// By the raw gyroscope.
        angle_rad: f64,
    },
    /// By hand through the air.
    Move,
}

/// A run of samples of one kind.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Its number among the recording's segments.
    pub number: usize,
    /// What.
    pub deed: Deed,
    /// Samples; the last is the next stretch's first.
    pub samples: Range<usize>,
    /// Rotation is lost in it: readings at the end of their range, or gaps.
    pub broken: bool,
    /// Not to be used for observations.
    pub excluded: bool,
}

impl Stretch {
    /// Is it a rest that counts?
    pub fn is_rest(&self) -> bool {
        matches!(self.deed, Deed::Rest { .. } | Deed::Held) && !self.excluded
    }

    /// The face that is up.
    pub fn face(&self) -> Option<Face> {
        match self.deed {
            Deed::Rest { face } => face,
            Deed::Turn { face, .. } => Some(face),
            _ => None,
        }
    }

    /// Length, s.
    pub fn duration_s(&self, samples: &[Raw]) -> f64 {
        samples[self.samples.end - 1].t_s - samples[self.samples.start].t_s
    }
}

/// Segments of a tape with their samples; those with fewer than three samples are left out.
pub fn stretches(segments: &[Segment], samples: &[Raw], noise: &Noise) -> Vec<Stretch> {
    let at = |t_us: u64| {
        let t_s = t_us as f64 * 1e-6 - 1e-6;
        samples.partition_point(|sample| sample.t_s < t_s)
    };
    let stretch = |(number, segment): (usize, &Segment)| {
        let range = at(segment.start_us)..(at(segment.end_us) + 1).min(samples.len());
        (range.len() >= 3).then(|| Stretch {
            number,
            deed: deed(segments, number, noise),
            samples: range,
            broken: matches!(segment.exclusion, Exclusion::Clipped | Exclusion::Gap | Exclusion::BiasJump),
            excluded: segment.exclusion != Exclusion::None,
        })
    };
    segments.iter().enumerate().filter_map(stretch).collect()
}

fn deed(segments: &[Segment], number: usize, noise: &Noise) -> Deed {
    let segment = &segments[number];
    match segment.kind {
        Kind::Still { .. } if noise::is_solid(segment, noise.quiet_variance) => {
            Deed::Rest { face: standing(segments, number) }
        }
        Kind::Still { .. } => Deed::Held,
        Kind::OnTable { face, angle_rad } => Deed::Turn { face, angle_rad: f64::from(angle_rad) },
        Kind::Hand => Deed::Move,
    }
}
