//! From a case to its recording.

use nalgebra::Vector3;
use serde_json::{Value, json};
use tumble_sim::motion::Hands;
use tumble_sim::rng::{Purpose, Rng};
use tumble_sim::sensor::ShapedNoise;
use tumble_sim::{Effect, SchemeConfig, SimError};

use super::case::{Case, Setting};
use super::size::Size;
use crate::recording::Recording;
use crate::simulate::{self, Made};

/// A recording in this setting.
pub fn make(setting: &Setting, effects: &[Effect]) -> Result<Made, SimError> {
    let mut config = if setting.swing {
        SchemeConfig::blind(setting.scheme, setting.seed, None)
    } else {
        SchemeConfig::realistic(setting.scheme, setting.seed)
    };
    if setting.by_hand {
        let wobble_deg = config.world.motion.hands.wobble_deg;
        config.world.motion.hands = Hands { wobble_deg, ..Hands::by_hand() };
    }
    config.effects = effects.to_vec();
    let mut recorded = config.record()?;
    if setting.noise > 1.0 {
        shake(&config, setting, &mut recorded);
    }
    Ok(simulate::written(&config, recorded))
}

/// Adds white noise while the box moves, until there is `noise` times as much as at rest. The estimator measures the noise
/// of a recording at rest, and then believes too little of the motion.
fn shake(config: &SchemeConfig, setting: &Setting, recorded: &mut tumble_sim::Recording) {
    let sensor = &config.world.sensor;
    let more = (setting.noise * setting.noise - 1.0).sqrt();
    let mut rng = Rng::new(setting.seed ^ 0x5AAE, Purpose::Noise);
    let mut noise =
        |density: f64| ShapedNoise::new(density * more, sensor.rate_hz, sensor.noise.bandwidth_hz, &mut rng);
    let (mut gyro, mut accel) = (noise(sensor.noise.gyro_density()), noise(sensor.noise.accel_density()));
    for sample in &mut recorded.samples {
        let (rate, force): (Vector3<f64>, Vector3<f64>) = (gyro.step(&mut rng), accel.step(&mut rng));
        if recorded.world.motion.idle_at(sample.t_s) {
            continue;
        }
        let (rate, force) = (sample.angular_rate_rad_s + rate, sample.specific_force_mps2 + force);
        sample.angular_rate_rad_s = sensor.quantisation.map_or(rate, |ranges| ranges.gyro(&rate));
        sample.specific_force_mps2 = sensor.quantisation.map_or(force, |ranges| ranges.accel(&force));
    }
}

/// A case's recording and its secret.
pub fn make_case(case: &Case, sizes: &[Size]) -> Result<(Recording, Value), String> {
    let effects = sizes.iter().map(|size| Effect::new(&size.id, Some(size.magnitude))).collect::<Result<Vec<_>, _>>();
    let effects = effects.map_err(|error| error.to_string())?;
    let made = make(&case.setting, &effects).map_err(|error| error.to_string())?;
    let hidden = if effects.is_empty() { "nothing" } else { "effect" };
    let secret = json!({
        "format": "tumble-secret",
        "version": 1,
        "hidden": hidden,
        "group": case.group,
        "scheme": case.setting.scheme.name(),
        "seed": case.setting.seed,
        "by_hand": case.setting.by_hand,
        "swing": case.setting.swing,
        "sizes": sizes,
        "truth": made.truth,
    });
    Ok((made.recording, secret))
}
