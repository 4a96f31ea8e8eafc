//! Ten seconds of samples at 200 Hz through the segmenter: a rest, one turn about z, a rest, with the sensor's noise.

use core::hint::black_box;
use core::sync::atomic::{AtomicU32, Ordering};

use tumble_core::motion::segmenter::Segmenter;
use tumble_core::sample::{Counts, Ranges, Sample};
use tumble_core::tape::{Kind, Tape};

use crate::bench_end;

const RATE_HZ: f32 = 200.0;
const SAMPLES: u32 = 2000;
const SAMPLE_US: u64 = 5000;
/// The turn: 90 °/s for 3.5 s between ramps of half a second, which makes 360°.
const TURN_FROM_S: f32 = 3.0;
const TURN_TO_S: f32 = 7.5;
const RAMP_S: f32 = 0.5;
const TURN_DPS: f32 = 90.0;
/// Of one sample, in counts of the widest ranges: 0.08 °/s and 2.4 mg.
const GYRO_NOISE_COUNTS: f32 = 1.3;
const ACCEL_NOISE_COUNTS: f32 = 4.9;

/// As large as the firmware's own.
type SessionTape = Tape<3072, 160>;

/// What the host reads, to know that the samples were taken for what they are: stills, and whole degrees turned.
#[unsafe(no_mangle)]
static BENCH_STILLS: AtomicU32 = AtomicU32::new(0);
#[unsafe(no_mangle)]
static BENCH_DEGREES: AtomicU32 = AtomicU32::new(0);

struct Noise(u32);

impl Noise {
    /// Near enough to normal, sigma 1.
    fn draw(&mut self) -> f32 {
        let uniform = |_| {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) as f32 / (1 << 24) as f32
        };
        (0..12).map(uniform).sum::<f32>() - 6.0
    }

    fn counts(&mut self, mean: f32, sigma: f32) -> i16 {
        let value = mean + sigma * self.draw();
        (if value < 0.0 { value - 0.5 } else { value + 0.5 }) as i16
    }
}

fn sample(index: u32, noise: &mut Noise) -> Sample {
    let t_s = index as f32 / RATE_HZ;
    let ramp = ((t_s - TURN_FROM_S).min(TURN_TO_S - t_s) / RAMP_S).clamp(0.0, 1.0);
    let rate = TURN_DPS * ramp * (32768.0 / Ranges::WIDEST.gyro_full_scale_dps);
    let gravity = 32768.0 / Ranges::WIDEST.accel_full_scale_g;
    let counts = Counts {
        gyro: [8.0, -5.0, 3.0 + rate].map(|mean| noise.counts(mean, GYRO_NOISE_COUNTS)),
        accel: [20.0, -15.0, gravity].map(|mean| noise.counts(mean, ACCEL_NOISE_COUNTS)),
        temperature: 1300,
    };
    Ranges::WIDEST.to_si(u64::from(index) * SAMPLE_US, &counts)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_segmenter(segmenter: &mut Segmenter, sample: &Sample, tape: &mut SessionTape) {
    black_box(&segmenter.step(sample, 0, tape));
}

pub fn whole_turn() {
    let mut tape = SessionTape::new();
    let mut segmenter = Segmenter::new(1.0);
    let mut noise = Noise(1);
    let (segmenter, tape) = (black_box(&mut segmenter), black_box(&mut tape));
    for index in 0..SAMPLES {
        let sample = black_box(sample(index, &mut noise));
        bench_segmenter(segmenter, &sample, tape);
        bench_end();
    }
    segmenter.finish(tape);
    for segment in tape.segments() {
        match segment.kind {
            Kind::Still { .. } => BENCH_STILLS.store(BENCH_STILLS.load(Ordering::Relaxed) + 1, Ordering::Relaxed),
            Kind::OnTable { angle_rad, .. } => {
                BENCH_DEGREES.store((angle_rad.to_degrees() + 0.5) as u32, Ordering::Relaxed);
            }
            Kind::Hand => {}
        }
    }
}
