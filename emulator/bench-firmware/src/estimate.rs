//! Whole estimates, of sessions that the host simulates. Their records come in as words, a chunk at a time, so that memory
//! holds one session's tape and no copy of it.

use core::hint::black_box;
use core::sync::atomic::{AtomicU32, Ordering};

use nalgebra::Vector3;
use tumble_core::estimate::{Conditions, Estimator, Progress};
use tumble_core::face::Face;
use tumble_core::setup::{BoxFaces, TurnStops};
use tumble_core::tape::{Exclusion, Kind, Record, Segment, Tape};

use crate::bench_end;

/// More than the firmware's 3072, for a session of 400 s.
const RECORDS: usize = 4096;
const SEGMENTS: usize = 144;
/// Words of a chunk; `emulator/src/bin/bench/feed.rs` has the same.
const CHUNK: usize = 256;

type SessionTape = Tape<RECORDS, SEGMENTS>;

const EXCLUSIONS: [Exclusion; 7] = [
    Exclusion::None,
    Exclusion::Clipped,
    Exclusion::Gap,
    Exclusion::Redone,
    Exclusion::SteadyTurn,
    Exclusion::BiasJump,
    Exclusion::Outlier,
];

/// What the host fills whenever the program arrives at [`bench_feed`].
#[unsafe(no_mangle)]
static BENCH_CHUNK: [AtomicU32; CHUNK] = [const { AtomicU32::new(0) }; CHUNK];
/// What it reads after each estimate: passes, and a gyroscope scale to compare with its own.
#[unsafe(no_mangle)]
static BENCH_PASSES: AtomicU32 = AtomicU32::new(0);
#[unsafe(no_mangle)]
static BENCH_SCALE: AtomicU32 = AtomicU32::new(0);

#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn bench_feed() {
    // SAFETY: it does nothing. The name keeps functions that are alike from being merged.
    unsafe { core::arch::asm!("nop @ feed") }
}

struct Feed(usize);

impl Feed {
    fn word(&mut self) -> u32 {
        if self.0 == CHUNK {
            bench_feed();
            self.0 = 0;
        }
        self.0 += 1;
        BENCH_CHUNK[self.0 - 1].load(Ordering::Relaxed)
    }

    fn float(&mut self) -> f32 {
        f32::from_bits(self.word())
    }

    fn vector(&mut self) -> Vector3<f32> {
        Vector3::new(self.float(), self.float(), self.float())
    }

    fn time_us(&mut self) -> u64 {
        u64::from(self.word()) | u64::from(self.word()) << 32
    }

    fn segment(&mut self) -> Segment {
        let (what, face, value) = (self.word(), Face::ALL.get(self.word() as usize).copied(), self.float());
        let kind = match (what, face) {
            (0, face) => Kind::Still { face, rate_variance: value },
            (1, Some(face)) => Kind::OnTable { face, angle_rad: value },
            _ => Kind::Hand,
        };
        Segment {
            kind,
            first: self.word() as u16,
            end: self.word() as u16,
            start_us: self.time_us(),
            end_us: self.time_us(),
            exclusion: EXCLUSIONS.get(self.word() as usize).copied().unwrap_or(Exclusion::None),
            clipped: 0,
            clipped_samples: 0,
        }
    }
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_estimate(estimator: &mut Estimator<SEGMENTS>, tape: &SessionTape) -> u32 {
    loop {
        match estimator.work(tape, 64) {
            Ok(Progress::Working(_)) => {}
            Ok(Progress::Done(estimate)) => {
                BENCH_SCALE.store(estimate.calibration.gyroscope.triad.correction.m11.to_bits(), Ordering::Relaxed);
                return estimate.passes;
            }
            Err(_) => return 0,
        }
    }
}

/// Estimates what the host feeds until it says that there is no more.
pub fn sessions() {
    static mut TAPE: SessionTape = SessionTape::new();
    // SAFETY: this function is called once, by the only thread.
    let tape = unsafe { &mut *(&raw mut TAPE) };
    let mut feed = Feed(CHUNK);
    while feed.word() != 0 {
        let stops = if feed.word() == 0 { TurnStops::Fenced } else { TurnStops::ByHand };
        let faces = if feed.word() == 0 { BoxFaces::Square } else { BoxFaces::Unknown };
        let conditions = Conditions { stops, faces, gravity_mps2: feed.float() };
        tape.clear();
        let (records, segments) = (feed.word(), feed.word());
        for _ in 0..records {
            let (dt_s, rotation_rad, specific_force_mps2) = (feed.float(), feed.vector(), feed.vector());
            // A tape that is too long shows in the estimate, which the host compares with its own.
            let _ = tape.push(&Record { dt_s, rotation_rad, specific_force_mps2 });
        }
        for _ in 0..segments {
            let _ = tape.close(feed.segment());
        }
        let mut place = None;
        let passes = bench_estimate(black_box(Estimator::begin(&mut place, tape, conditions)), tape);
        bench_end();
        BENCH_PASSES.store(passes, Ordering::Relaxed);
        bench_feed();
        feed = Feed(0);
    }
}
