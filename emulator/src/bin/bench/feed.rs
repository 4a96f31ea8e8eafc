//! Sessions for `bench-firmware` to estimate: simulated, taken through the core's own segmenter, and handed over as words.

use tumble::settle;
use tumble::study::trial::readings;
use tumble_core::estimate::Conditions;
use tumble_core::setup::{BoxFaces, TurnStops};
use tumble_core::tape::{Exclusion, Kind, Segment, Tape};
use tumble_sim::{Scheme, SchemeConfig};

/// As in `bench-firmware/src/estimate.rs`.
pub const CHUNK: usize = 256;
type SessionTape = Tape<4096, 160>;
const EXCLUSIONS: [Exclusion; 7] = [
    Exclusion::None,
    Exclusion::Clipped,
    Exclusion::Gap,
    Exclusion::Redone,
    Exclusion::SteadyTurn,
    Exclusion::BiasJump,
    Exclusion::Outlier,
];

/// What is estimated.
pub struct Session {
    /// In words.
    pub name: String,
    /// How long it took the person, s.
    pub seconds: f64,
    /// Records on the tape.
    pub records: usize,
    /// What the host makes of the same tape: passes, and a gyroscope scale.
    pub expected: (u32, f32),
    words: Vec<u32>,
}

impl Session {
    /// Six faces with a turn each way, all times longer by a factor.
    pub fn stretched(factor: f64) -> Result<Self, String> {
        let mut config = SchemeConfig::new(Scheme::Double, 1);
        for time in [&mut config.timing.still_s, &mut config.timing.turn_s, &mut config.timing.move_s] {
            *time *= factor;
        }
        Self::of("six faces, both ways".to_owned(), &config, TurnStops::Fenced, BoxFaces::Square)
    }

    /// Poses without turns.
    pub fn poses(poses: usize) -> Result<Self, String> {
        let config = SchemeConfig::new(Scheme::MultiPose { poses }, 1);
        Self::of(format!("{poses} poses, box unknown"), &config, TurnStops::ByHand, BoxFaces::Unknown)
    }

    fn of(name: String, config: &SchemeConfig, stops: TurnStops, faces: BoxFaces) -> Result<Self, String> {
        let recording = config.record().map_err(|error| format!("{name}: {error:?}"))?;
        let mut tape = Box::new(SessionTape::new());
        settle::record(&readings(&recording.samples), 1.0, &mut tape);
        if tape.fill() >= 1.0 {
            return Err(format!("{name}: the tape is too short"));
        }
        let conditions = Conditions { stops, faces, gravity_mps2: config.world.gravity_mps2 as f32 };
        Ok(Self {
            seconds: recording.samples.last().map_or(0.0, |sample| sample.t_s),
            records: tape.len(),
            expected: estimate(&tape, conditions).ok_or_else(|| format!("{name}: no estimate"))?,
            words: words(&tape, conditions),
            name,
        })
    }
}

fn estimate(tape: &SessionTape, conditions: Conditions) -> Option<(u32, f32)> {
    let (estimate, _) = settle::estimate(tape, conditions, &mut |_| {}).ok()?;
    Some((estimate.passes, estimate.calibration.gyroscope.triad.correction.m11))
}

fn words(tape: &SessionTape, conditions: Conditions) -> Vec<u32> {
    let mut words = vec![
        1,
        u32::from(conditions.stops != TurnStops::Fenced),
        u32::from(conditions.faces != BoxFaces::Square),
        conditions.gravity_mps2.to_bits(),
        tape.len() as u32,
        tape.segments().len() as u32,
    ];
    for record in (0..tape.len()).filter_map(|index| tape.record(index)) {
        words.push(record.dt_s.to_bits());
        words.extend(record.rotation_rad.iter().chain(&record.specific_force_mps2).map(|value| value.to_bits()));
    }
    tape.segments().iter().for_each(|segment| words.extend(segment_words(segment)));
    words
}

fn segment_words(segment: &Segment) -> [u32; 10] {
    let (what, face, value) = match segment.kind {
        Kind::Still { face, rate_variance } => (0, face, rate_variance),
        Kind::OnTable { face, angle_rad } => (1, Some(face), angle_rad),
        Kind::Hand => (2, None, 0.0),
    };
    let face = face.map_or(u32::MAX, |face| face.index() as u32);
    let exclusion = EXCLUSIONS.iter().position(|one| *one == segment.exclusion).unwrap_or(0);
    let [start, end] = [segment.start_us, segment.end_us].map(|t| [t as u32, (t >> 32) as u32]);
    let (first, last) = (u32::from(segment.first), u32::from(segment.end));
    [what, face, value.to_bits(), first, last, start[0], start[1], end[0], end[1], exclusion as u32]
}

/// All sessions' words, each session's at the beginning of a chunk, and at the end a chunk that says so.
pub fn chunks(sessions: &[Session]) -> Vec<Vec<u32>> {
    let mut chunks: Vec<Vec<u32>> =
        sessions.iter().flat_map(|session| session.words.chunks(CHUNK)).map(<[u32]>::to_vec).collect();
    chunks.push(vec![0]);
    chunks
}
