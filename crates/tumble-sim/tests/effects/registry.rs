//! All effects alike: names, limits, draws, and that recordings without them stay what they were.

use crate::common::{Pair, short};
use std::collections::BTreeSet;
use tumble_sim::effect::{EffectError, Values};
use tumble_sim::rng::{Purpose, Rng};
use tumble_sim::{Effect, Scheme, SchemeConfig};

/// The contract's list.
const CONTRACT: &str = "gyro_g_sensitivity gyro_g_squared gyro_scale_quadratic gyro_scale_cubic gyro_scale_asymmetry \
    gyro_saturation accel_saturation gyro_coarse_quantization gyro_dead_zone gyro_bias_temperature gyro_scale_temperature \
    gyro_warm_up gyro_bias_step gyro_bias_random_walk accel_bias_temperature accel_scale_temperature accel_bias_step \
    accel_bias_random_walk accel_quadratic accel_cubic accel_lever_arm accel_internal_lever_arms gyro_accel_lag \
    timestamp_jitter timestamp_quantization dropped_samples duplicated_samples byte_tearing incomplete_turn \
    platform_tilt_change spin_axis_wobble table_rocking vibration_line shock earth_rotation axis_mapping wrong_full_scale \
    undersampling frozen_reading accel_warm_up";

#[test]
fn the_catalogue_is_the_contracts() {
    let ids: Vec<&str> = Effect::ALL.iter().map(|kind| kind.id).collect();
    assert_eq!(ids, CONTRACT.split_whitespace().collect::<Vec<_>>());
    assert!(Effect::FOREIGN.len() >= 10 && Effect::FOREIGN.iter().all(|kind| kind.id.starts_with("x_")));
    assert_eq!(Effect::kinds().map(|kind| kind.id).collect::<BTreeSet<_>>().len(), Effect::kinds().count());
    for kind in Effect::kinds() {
        assert!(kind.values.contains(kind.default), "{}", kind.id);
        assert!(kind.values.contains(kind.draws.0) && kind.values.contains(kind.draws.1), "{}", kind.id);
        assert!([kind.name, kind.meaning, kind.unit, kind.source].iter().all(|text| !text.is_empty()), "{}", kind.id);
        let mut rng = Rng::new(1, Purpose::Person);
        for _ in 0..50 {
            let drawn = Effect::drawn(kind, &mut rng).magnitude();
            assert!(
                (kind.draws.0..=kind.draws.1).contains(&drawn) && kind.values.contains(drawn),
                "{}: {drawn}",
                kind.id
            );
        }
    }
}

#[test]
fn every_effect_can_be_recorded_with_and_without_counts() {
    for kind in Effect::kinds() {
        for counts in [false, true] {
            let mut config = if counts { SchemeConfig::realistic(Scheme::Single, 9) } else { short(9) };
            config.timing.still_s = 0.5;
            config.timing.turn_s = 3.0;
            config.world.sensor.rate_hz = 50.0;
            let magnitude = if kind.id == "earth_rotation" { 10.0 } else { kind.default };
            let pair = Pair::of(config.clone(), &format!("{}={magnitude}", kind.id));
            let truth = &pair.with.truth.effects[0];
            assert_eq!((truth.id, truth.magnitude, truth.unit), (kind.id, magnitude, kind.unit));
            assert!(!truth.parameters.is_empty() && truth.parameters.iter().all(|p| p.value.is_finite()), "{truth:?}");
            let samples = &pair.with.samples;
            assert_ne!(*samples, pair.without.samples, "{} does nothing", kind.id);
            assert!(samples.windows(2).all(|two| two[1].t_s > two[0].t_s), "{}", kind.id);
            let finite = |s: &tumble_sim::Sample| (s.angular_rate_rad_s + s.specific_force_mps2).norm().is_finite();
            assert!(samples.iter().all(finite), "{}", kind.id);
            config.effects = vec![Effect::new(kind.id, Some(magnitude)).unwrap()];
            assert_eq!(config.record().unwrap().samples, *samples, "{}: the same seed", kind.id);
        }
    }
}

#[test]
fn an_effect_of_no_size_leaves_the_nominal_recording_to_the_bit() {
    let none_at_all = ["gyro_g_squared=0", "gyro_bias_step=0", "accel_internal_lever_arms=0", "earth_rotation=1"];
    for word in none_at_all {
        let pair = Pair::of(short(2), word);
        assert_eq!(pair.with.samples, pair.without.samples, "{word}");
    }
    assert!(Pair::of(short(2), "gyro_bias_step=0").without.truth.effects.is_empty());
}

#[test]
fn several_effects_do_not_change_each_others_draws() {
    let alone = Pair::quiet("gyro_bias_step=0.1").with.truth.effects.remove(0);
    let mut config = short(11);
    config.effects = vec![Effect::parse("shock=1").unwrap(), Effect::parse("gyro_bias_step=0.1").unwrap()];
    assert_eq!(config.record().unwrap().truth.effects[1], alone);
    // Only the magnitude changes with the magnitude.
    let twice = Pair::quiet("gyro_bias_step=0.2").with.truth.effects.remove(0);
    for (one, two) in alone.parameters.iter().zip(&twice.parameters) {
        let factor = if one.name == "step_time" { 1.0 } else { 2.0 };
        assert!((two.value - factor * one.value).abs() < 1e-12, "{}", one.name);
    }
}

#[test]
fn bad_words_are_told_what_is_right() {
    let message = |word: &str| Effect::parse(word).unwrap_err().to_string();
    assert!(matches!(Effect::parse("gyro_bias_stap"), Err(EffectError::Unknown { .. })));
    assert!(message("gyro_bias_stap").contains("gyro_bias_step"), "{}", message("gyro_bias_stap"));
    assert!(message("lever").contains("accel_lever_arm"), "{}", message("lever"));
    let far = message("gyro_bias_step=1000");
    assert!(far.contains("from 0 to 50 dps") && far.contains("1000"), "{far}");
    assert!(message("gyro_bias_step=NaN").contains("from 0 to 50 dps"));
    assert!(message("gyro_bias_step=-1").contains("from 0 to 50 dps"));
    assert!(message("shock=hard").contains("'hard' is not a number"));
    assert!(message("axis_mapping=1.5").contains("a whole number from 1 to 4"));
    assert!(message("").contains("there is no effect"));
    assert!(matches!(Effect::ALL[35].values, Values::Whole(1, 4)));
    assert_eq!(Effect::parse(" shock = 2 ").unwrap().magnitude(), 2.0);
}

#[test]
fn realistic_recordings_are_clean_within_their_words() {
    for seed in 0..20 {
        let config = SchemeConfig::realistic(Scheme::Double, seed);
        let motion = &config.world.motion;
        assert!((0.0..3.0).contains(&motion.table.tilt_deg) && (0.1..0.5).contains(&motion.hands.wobble_deg));
        let thermal = &config.world.sensor.thermal;
        assert!((0.2..0.8).contains(&thermal.warm_up_degc));
        assert!((thermal.gyro_bias_per_degc.amax() * thermal.warm_up_degc).to_degrees() < 0.002);
        assert!(config.world.sensor.quantisation.is_some() && config.effects.is_empty());
        assert!(config.world.sensor.drift.gyro.instability > 0.0 && config.clock.rate_error.abs() < 0.005);
    }
}
