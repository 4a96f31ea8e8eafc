//! Gates: what the samples themselves show before any physics is fitted. They explain much that looks like exotic physics.
//!
//! One file a gate; each says its statistic and how its false alarms are bounded. Together they may fire on at most 0.2 % of
//! clean recordings, whatever the sensor's rate, rounding and noise, and however a person's hands shake.

mod aliasing;
pub(super) mod chance;
mod closure;
mod coarse;
mod frozen;
mod gaps;
mod hole;
mod leap;
mod line;
mod mapping;
mod pairs;
mod rocking;
mod saturation;
mod shock;
mod spectrum;
mod stale;
mod stamps;
mod tearing;
mod tell;
mod view;
mod wobble;

use super::catalogue::Card;
use super::diagnosis::{Found, Limit};
use super::twin::data::Raw;
use crate::recording::{Inference, Recording};
pub use aliasing::in_moves;
pub use leap::Leap;
use spectrum::Spectra;
use tell::Outcome;
use tumble_core::tape::Segment;
use view::View;

/// Less than this is no recording: five seconds, two hundred samples (40 Hz).
const LEAST_S: f64 = 5.0;
const LEAST_SAMPLES: usize = 200;
/// Evidence of clipping, at 15 a flat top, below which steps larger than the noise are the better explanation.
const MANY_FLATS: f64 = 100.0;

/// What gates look at.
pub struct Scene<'a> {
    /// The recording with its metadata and own units.
    pub recording: &'a Recording,
    /// What it says of its ranges and rate.
    pub inference: &'a Inference,
    /// SI, time from the first sample.
    pub samples: &'a [Raw],
    /// As the board's segmenter found them.
    pub segments: &'a [Segment],
    /// Effects that nobody is to know of: what is found of them is neither told nor mended.
    pub without: &'a [String],
}

/// What they found.
#[derive(Default)]
pub struct Gated {
    /// Effects.
    pub found: Vec<Found>,
    /// Samples to be corrected or masked: index and what to put there (None: linear from its neighbours).
    pub repaired: Vec<usize>,
    /// Samples that stand at a level, with their channels (bits as in `Reading::clipped`).
    pub clipped: Vec<(usize, u8)>,
    /// Reason why nothing further can be said, if so.
    pub stop: Option<String>,
    /// A constant matrix that raw rates (first) and forces (second) must be multiplied by before anything fits: axis
    /// mapping and full scale.
    pub remap: Option<(nalgebra::Matrix3<f64>, nalgebra::Matrix3<f64>)>,
    /// The gyroscope's bias jumped by more than rests may differ.
    pub leaps: Vec<Leap>,
    /// Structural effects that what was found here imitates: they are not to be named.
    pub imitated: Vec<String>,
    /// Detection limits.
    pub limits: Vec<Limit>,
    without: Vec<String>,
}

/// What each gate can name.
pub const CARDS: [&Card; 18] = [
    &aliasing::CARD,
    &closure::CARD,
    &coarse::CARD,
    &frozen::CARD,
    &gaps::CARD,
    &hole::CARD,
    &line::CARD,
    &mapping::AXES,
    &mapping::SCALE,
    &rocking::CARD,
    &saturation::GYRO,
    &saturation::ACCEL,
    &shock::CARD,
    &stale::CARD,
    &stamps::JITTER,
    &stamps::STEPS,
    &tearing::CARD,
    &wobble::CARD,
];

/// All gates.
pub fn examine(scene: &Scene) -> Gated {
    let mut gated = Gated { without: scene.without.to_vec(), ..Gated::default() };
    if let Some(reason) = unfit(scene) {
        gated.stop = Some(reason);
        return gated;
    }
    let view = View::new(scene);
    gated.look_at_stamps(&view);
    let torn = gated.look_at_spikes(&view);
    gated.look_at_values(&view);
    gated.look_for_a_leap(&view);
    gated.look_at_spectra(&view, torn);
    gated.take(aliasing::examine(&view));
    gated.look_at_rotation(&view);
    gated.repaired.sort_unstable();
    gated.repaired.dedup();
    gated.imitated.sort();
    gated.imitated.dedup();
    gated.found.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    gated
}

/// Why nothing can be said at all.
fn unfit(scene: &Scene) -> Option<String> {
    let samples = scene.samples;
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return Some("there are no samples".into());
    };
    let length_s = last.t_s - first.t_s;
    if samples.len() < LEAST_SAMPLES || length_s < LEAST_S {
        return Some(format!(
            "{} samples in {length_s:.1} s say nothing: record at least a minute with rests and motion",
            samples.len()
        ));
    }
    let dead = |of: fn(&Raw) -> nalgebra::Vector3<f64>| samples.iter().all(|raw| of(raw) == of(first));
    if dead(|raw| raw.rate) || dead(|raw| raw.force) {
        return Some("one triad never changes: it was not read".into());
    }
    None
}

impl Gated {
    fn look_at_stamps(&mut self, view: &View) {
        let (jitter, steps) = stamps::examine(view);
        self.take(gaps::examine(view, steps.found.is_some()));
        self.take(jitter);
        self.take(steps);
    }

    /// Whether readings are torn.
    fn look_at_spikes(&mut self, view: &View) -> bool {
        let tearing = tearing::examine(view);
        let torn = tearing.found.is_some();
        // Bytes torn in neighbouring samples look like knocks.
        if !torn {
            self.take(shock::examine(view));
        }
        self.take(tearing);
        torn
    }

    /// Values that readings take or miss, and what they say of axes and ranges.
    fn look_at_values(&mut self, view: &View) {
        let stale = stale::examine(view);
        let (gyro, accel) = saturation::examine(view, &stale.repaired);
        let clipped = [gyro.clipped.as_slice(), accel.clipped.as_slice()].concat();
        let frozen = frozen::examine(view, &stale.repaired, &clipped);
        self.take(stale);
        let mapped = mapping::examine(view, gyro.found.is_some(), accel.found.is_some());
        // Counts of a range too wide look coarse; the range says so already.
        let coarse = if mapped.scale.found.is_none() { coarse::examine(view) } else { Outcome::default() };
        // Coarse peaks look flat one by one: then only many of them count.
        let flat_by_steps = gyro.found.as_ref().is_some_and(|found| found.evidence < MANY_FLATS);
        if coarse.found.is_none() || !flat_by_steps {
            self.take(gyro);
        }
        self.take(accel);
        let hole = hole::examine(view);
        // Coarse counts and rates set to zero stand still of themselves.
        self.take(frozen.unless(coarse.found.is_some() || hole.found.is_some()));
        // Rates that a driver sets to zero have no scatter, as coarse ones have none.
        self.take(coarse.unless(hole.found.is_some()));
        self.take(hole);
        let hidden = self.hides(&mapped.axes) || self.hides(&mapped.scale);
        self.take(mapped.axes);
        self.take(mapped.scale);
        self.remap = mapped.remap.filter(|_| !hidden);
    }

    /// Means of readings that are torn, coarse, frozen or zeroed differ from rest to rest of themselves; stamps do them no harm.
    fn look_for_a_leap(&mut self, view: &View) {
        let stamps = ["dropped_samples", "timestamp_jitter", "timestamp_quantization"];
        if self.found.iter().all(|found| stamps.contains(&found.id.as_str())) {
            let (told, leaps) = leap::examine(view);
            if !self.hides(&told) {
                self.leaps = leaps;
            }
            self.take(told);
        }
    }

    /// What swings at rest.
    fn look_at_spectra(&mut self, view: &View, torn: bool) {
        let spectra = Spectra::new(view);
        let hand = spectra.as_ref().map(line::Hand::of).unwrap_or_default();
        // What sways at one frequency alone is a table: that gate sees for itself.
        let rocking = rocking::examine(view, hand.trembles);
        let parameters = rocking.found.iter().flat_map(|found| &found.parameters);
        let rocking_hz = parameters.filter(|parameter| parameter.name == "frequency").map(|hz| hz.value).next();
        let line = line::examine(view, spectra.as_ref(), hand, rocking_hz);
        self.take(rocking);
        // Torn readings are a few spikes of one channel: their spectrum is not the noise that lines are told from.
        self.take(line.unless(torn));
    }

    /// Rotation that clipped, coarse or mistaken readings got wrong says nothing of the person.
    fn look_at_rotation(&mut self, view: &View) {
        let wrong = [
            "gyro_saturation",
            "gyro_coarse_quantization",
            "axis_mapping",
            "wrong_full_scale",
            "undersampling",
            // Products of rates and wrong intervals tilt the axis of a turn: steps of 10 ms by more than a degree.
            "timestamp_jitter",
            "timestamp_quantization",
            // Rests that rock are found by wider limits, which take a slow turn's ends for rest.
            "table_rocking",
        ];
        if !self.found.iter().any(|found| wrong.contains(&found.id.as_str())) {
            self.take(wobble::examine(view));
            self.take(closure::examine(view));
        }
    }

    fn hides(&self, outcome: &Outcome) -> bool {
        outcome.found.iter().any(|found| self.without.contains(&found.id))
    }

    fn take(&mut self, outcome: Outcome) {
        if self.hides(&outcome) {
            return;
        }
        self.imitated.extend(outcome.found.iter().flat_map(|_| outcome.imitated).map(|id| (*id).into()));
        self.found.extend(outcome.found);
        self.limits.extend(outcome.limit);
        self.repaired.extend(outcome.repaired);
        self.clipped.extend(outcome.clipped);
    }
}
