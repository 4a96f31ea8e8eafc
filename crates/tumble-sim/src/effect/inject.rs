//! Effects added to a recording of a real sensor.
//!
//! The real reading stands for the ideal one. Of the gyro's reading, the median of each axis is taken off first: a
//! session rests half of its time and turns as much one way as the other, so that the median is the bias to within some
//! noise, and a dead zone or an asymmetry lies about rest and not about the bias.

use super::chain::Chain;
use super::error::EffectError;
use super::kind::{Scene, WIDEST};
use super::sized::Effect;
use super::units::DPS;
use crate::STANDARD_GRAVITY_MPS2 as G;
use crate::rng::{Purpose, Rng};
use crate::sensor::{EffectTruth, Ideal, Instant, Quantisation, Sample, Signal, Stages};
use nalgebra::{UnitQuaternion, Vector3};

/// Adds effects to samples. With `ranges`, readings stay whole counts.
///
/// # Errors
/// If an effect cannot be added, or needs what the samples have not; they are unchanged then.
pub fn inject(
    effects: &[Effect],
    samples: &mut Vec<Sample>,
    ranges: Option<Quantisation>,
    seed: u64,
) -> Result<Vec<EffectTruth>, EffectError> {
    if let Some(effect) = effects.iter().find(|effect| !effect.kind().injects) {
        return Err(EffectError::NotInjectable { id: effect.kind().id });
    }
    let scene = scene(samples, ranges)?;
    let mut chain = Effect::chain(effects, scene, seed);
    chain.adopt(samples)?;
    let mut analog = samples.clone();
    chain.shift(&mut analog);
    let rest = median_rate(samples);
    let mut rng = Rng::new(seed, Purpose::Noise);
    for (sample, analog) in samples.iter_mut().zip(&analog) {
        let below = ranges.map(|ranges| below_a_count(&ranges, &mut rng)).unwrap_or_default();
        let signal = changed(analog, &below, &mut chain, &rest);
        settle(
            &mut sample.angular_rate_rad_s,
            &signal.angular_rate_rad_s,
            ranges.map(|r| r.gyro_counts_per_dps() / DPS),
        );
        settle(
            &mut sample.specific_force_mps2,
            &signal.specific_force_mps2,
            ranges.map(|r| r.accel_counts_per_g() / G),
        );
    }
    chain.stream(samples, &scene.ranges);
    Ok(chain.truths())
}

impl Effect {
    /// Adds it to samples of a real sensor; see [`inject`].
    ///
    /// # Errors
    /// As [`inject`].
    pub fn inject(&self, samples: &mut Vec<Sample>, seed: u64) -> Result<EffectTruth, EffectError> {
        let truths = inject(core::slice::from_ref(self), samples, None, seed)?;
        truths.into_iter().next().ok_or(EffectError::NotInjectable { id: self.id() })
    }
}

/// What the sensor's rounding may have taken away: even over one count, as it is where noise is not much below one.
/// Without it an effect of less than half a count would be rounded away, every time.
fn below_a_count(ranges: &Quantisation, rng: &mut Rng) -> Below {
    // Not quite half: what no effect touches must be rounded to what it was.
    let mut part = |counts_per_unit: f64| Vector3::from_fn(|_, _| rng.symmetric(0.4999) / counts_per_unit);
    Below { rate: part(ranges.gyro_counts_per_dps() / DPS), force: part(ranges.accel_counts_per_g() / G) }
}

/// Parts of a count, SI.
#[derive(Default)]
struct Below {
    rate: Vector3<f64>,
    force: Vector3<f64>,
}

/// What the sensor would have said before rounding.
fn changed(analog: &Sample, below: &Below, chain: &mut Chain, rest: &Vector3<f64>) -> Signal {
    let mut at = Instant {
        t_s: analog.t_s,
        ideal: Ideal {
            angular_rate_rad_s: analog.angular_rate_rad_s + below.rate - rest,
            specific_force_mps2: analog.specific_force_mps2 + below.force,
        },
        angular_acceleration_rad_s2: Vector3::zeros(),
        temperature_degc: analog.temperature_degc,
        rotation_n_from_b: UnitQuaternion::identity(),
    };
    at.ideal = chain.ideal(&at);
    let mut signal = Signal {
        angular_rate_rad_s: at.ideal.angular_rate_rad_s + rest,
        specific_force_mps2: at.ideal.specific_force_mps2,
    };
    chain.analog(&at, &mut signal);
    chain.converter(&at, &mut signal);
    signal
}

/// Moves a reading by the whole counts that come nearest to what it should be. Counting from the old reading keeps it
/// on the sensor's own grid even if that is not quite the sheet's.
fn settle(reading: &mut Vector3<f64>, wanted: &Vector3<f64>, counts_per_unit: Option<f64>) {
    for (old, new) in reading.iter_mut().zip(wanted.iter()) {
        let by = new - *old;
        match counts_per_unit {
            Some(counts) if (by * counts).round() == 0.0 => {}
            Some(counts) => {
                let (low, high) = ((-32768.0 / counts).min(*old), (32767.0 / counts).max(*old));
                *old = (*old + (by * counts).round() / counts).clamp(low, high);
            }
            // What the arithmetic alone moved, by parts in 1e16, stays what it was.
            None if by.abs() <= 1e-14 * (1.0 + old.abs()) => {}
            None => *old = *new,
        }
    }
}

/// The recording's length and its rate by the median of its steps.
fn scene(samples: &[Sample], ranges: Option<Quantisation>) -> Result<Scene, EffectError> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return Err(EffectError::Lacks { what: "no samples" });
    };
    let mut steps: Vec<f64> = samples.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).collect();
    let step_s = median(&mut steps);
    if !(step_s > 0.0 && step_s.is_finite()) {
        return Err(EffectError::Lacks { what: "fewer than two samples at increasing times" });
    }
    Ok(Scene {
        start_s: first.t_s,
        duration_s: last.t_s - first.t_s,
        rate_hz: 1.0 / step_s,
        ranges: ranges.unwrap_or(WIDEST),
    })
}

fn median_rate(samples: &[Sample]) -> Vector3<f64> {
    Vector3::from_fn(|i, _| median(&mut samples.iter().map(|s| s.angular_rate_rad_s[i]).collect::<Vec<_>>()))
}

/// 0 of nothing.
fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
