//! Effects added to a recording of a real sensor.
//!
//! The real reading stands for the ideal one. Of the gyro's reading, the median of each axis is taken off first: a
//! session rests half of its time and turns as much one way as the other, so that the median is the bias to within some
//! noise, and a dead zone or an asymmetry lies about rest and not about the bias.

use super::kind::{Scene, WIDEST};
use super::model::{Chain, EffectTruth, Instant, Signal};
use super::{Effect, EffectError};
use crate::sensor::{Quantisation, Sample};
use crate::world::Ideal;
use nalgebra::{UnitQuaternion, Vector3};

/// Adds effects to samples. Readings are rounded to `ranges` again if there are any.
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
    chain.shift(samples);
    let rest = median_rate(samples);
    for sample in samples.iter_mut() {
        change(sample, &mut chain, &rest, ranges);
    }
    chain.stream(samples, &scene.ranges);
    Ok(chain.truths())
}

fn change(sample: &mut Sample, chain: &mut Chain, rest: &Vector3<f64>, ranges: Option<Quantisation>) {
    let ideal =
        Ideal { angular_rate_rad_s: sample.angular_rate_rad_s - rest, specific_force_mps2: sample.specific_force_mps2 };
    let mut at = Instant {
        t_s: sample.t_s,
        ideal,
        angular_acceleration_rad_s2: Vector3::zeros(),
        temperature_degc: sample.temperature_degc,
        rotation_n_from_b: UnitQuaternion::identity(),
    };
    at.ideal = chain.ideal(&at);
    let before = Signal {
        angular_rate_rad_s: at.ideal.angular_rate_rad_s + rest,
        specific_force_mps2: at.ideal.specific_force_mps2,
    };
    let mut signal = before;
    chain.analog(&at, &mut signal);
    chain.converter(&at, &mut signal);
    // What the effect leaves alone stays what it was, to the last digit.
    let unchanged =
        Signal { angular_rate_rad_s: ideal.angular_rate_rad_s + rest, specific_force_mps2: ideal.specific_force_mps2 };
    for i in 0..3 {
        if signal.angular_rate_rad_s[i] != unchanged.angular_rate_rad_s[i] {
            let rounded = ranges.map_or(signal.angular_rate_rad_s, |r| r.gyro(&signal.angular_rate_rad_s));
            sample.angular_rate_rad_s[i] = rounded[i];
        }
        if signal.specific_force_mps2[i] != unchanged.specific_force_mps2[i] {
            let rounded = ranges.map_or(signal.specific_force_mps2, |r| r.accel(&signal.specific_force_mps2));
            sample.specific_force_mps2[i] = rounded[i];
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
