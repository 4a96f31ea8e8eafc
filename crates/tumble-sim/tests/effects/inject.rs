//! Effects added to samples that came from elsewhere.

use crate::common::{dps, mg, short};
use nalgebra::Vector3;
use tumble_sim::effect::{EffectError, inject};
use tumble_sim::sensor::Quantisation;
use tumble_sim::{Effect, Sample};

const RANGES: Quantisation = Quantisation { gyro_range_dps: 500.0, accel_range_g: 4.0 };

/// Stands for a real recording: in counts, with a temperature that moves, beginning at 1000 s.
fn real() -> Vec<Sample> {
    let mut config = short(21);
    config.world.sensor.quantisation = Some(RANGES);
    config.world.sensor.thermal.ramp_degc_per_s = 0.04;
    let samples = config.record().unwrap().samples;
    samples.into_iter().map(|sample| Sample { t_s: sample.t_s + 1000.0, ..sample }).collect()
}

#[test]
fn every_effect_of_the_sensor_can_be_added() {
    let before = real();
    for kind in Effect::kinds() {
        let effect = Effect::new(kind.id, None).unwrap();
        let mut samples = before.clone();
        let result = inject(&[effect], &mut samples, Some(RANGES), 4);
        if !kind.injects {
            assert_eq!(result, Err(EffectError::NotInjectable { id: kind.id }));
            assert_eq!(samples, before, "{}: refused and left alone", kind.id);
            continue;
        }
        assert_eq!(result.unwrap()[0].id, kind.id);
        assert_ne!(samples, before, "{} does nothing", kind.id);
        assert!(samples.windows(2).all(|two| two[1].t_s > two[0].t_s), "{}", kind.id);
        // The stale, the torn, the dropped and the moved are whole counts too; lines between samples are rounded again.
        let step = RANGES.gyro_counts_per_dps();
        let whole = |s: &Sample| {
            s.angular_rate_rad_s.iter().all(|w| {
                let counts = w.to_degrees() * step;
                (counts - counts.round()).abs() < 1e-6
            })
        };
        assert!(samples.iter().all(whole), "{}", kind.id);
    }
}

#[test]
fn what_is_added_has_its_size() {
    let added = |word: &str| {
        let mut samples = real();
        let truth = Effect::parse(word).unwrap().inject(&mut samples, 4).unwrap();
        let difference: Vec<_> = samples
            .iter()
            .zip(real())
            .map(|(with, without)| {
                let force = with.specific_force_mps2 - without.specific_force_mps2;
                (with.t_s, with.angular_rate_rad_s - without.angular_rate_rad_s, force)
            })
            .collect();
        (truth, difference)
    };
    let (truth, difference) = added("gyro_bias_step=0.5");
    let time_s = truth.parameters[0].value;
    assert!((1010.0..1050.0).contains(&time_s), "{time_s}");
    for (t_s, rate, force) in difference {
        let expected = if t_s >= time_s { dps(0.5) } else { 0.0 };
        assert!((rate.norm() - expected).abs() < 1e-12 && force == Vector3::zeros());
    }
    let (_, difference) = added("accel_quadratic=4");
    let peak = difference.iter().map(|(_, _, force)| force.amax()).fold(0.0, f64::max);
    assert!(peak > mg(3.0) && peak < mg(8.0), "1 g on the worst axis, a little more when it is moved: {peak}");
    // The bias of several °/s is not what a dead zone of 0.5 °/s lies about.
    let (_, difference) = added("gyro_dead_zone=0.5");
    assert!(difference.iter().all(|(_, rate, _)| rate.amax() <= dps(0.5) + 1e-12));
    let sunk = difference.iter().filter(|(_, rate, _)| rate.amax() > dps(0.4)).count();
    assert!(sunk > difference.len() / 4, "{sunk}");
}

#[test]
fn what_is_lacking_is_said() {
    let bias = [Effect::parse("gyro_bias_temperature").unwrap()];
    let mut samples = real();
    samples[10].temperature_degc = f64::NAN;
    let message = inject(&bias, &mut samples, None, 1).unwrap_err().to_string();
    assert!(message.contains("temp_c"), "{message}");
    samples.iter_mut().for_each(|sample| sample.temperature_degc = 20.0);
    assert!(inject(&bias, &mut samples, None, 1).unwrap_err().to_string().contains("0.2 °C"));
    let shock = [Effect::parse("shock").unwrap()];
    assert!(inject(&shock, &mut Vec::new(), None, 1).unwrap_err().to_string().contains("no samples"));
    assert!(inject(&shock, &mut vec![samples[0]], None, 1).is_err());
}
