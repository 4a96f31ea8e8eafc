//! The diagnosis against recordings whose physics is known: nothing, something, something it does not know, nothing to go by.

use tumble::diagnose::carry::carry;
use tumble::diagnose::diagnosis::{Limit, Verdict};
use tumble::diagnose::transfer::try_on;
use tumble::diagnose::{Options, Outcome, diagnose};
use tumble::recording::{BoxFaces, Inference, Metadata, Recording, Row, TurnStops};
use tumble_sim::effect::Effect;
use tumble_sim::motion::Hands;
use tumble_sim::{Scheme, SchemeConfig};

fn recording(scheme: Scheme, seed: u64, effect: Option<&str>) -> (Recording, tumble_sim::Truth) {
    let mut config = SchemeConfig::realistic(scheme, seed);
    config.effects = effect.map(|word| Effect::parse(word).expect("a known effect")).into_iter().collect();
    made(&config)
}

fn made(config: &SchemeConfig) -> (Recording, tumble_sim::Truth) {
    let made = config.record().expect("a valid configuration");
    let row = |sample: &tumble_sim::Sample| Row {
        t_s: (sample.t_s * 1e6).round() / 1e6,
        gyro_dps: sample.angular_rate_rad_s.map(f64::to_degrees).into(),
        accel_g: (sample.specific_force_mps2 / tumble_sim::STANDARD_GRAVITY_MPS2).into(),
        temp_c: Some(sample.temperature_degc),
    };
    let turns = if config.turns_word() == "fenced" { TurnStops::Fenced } else { TurnStops::ByHand };
    let metadata = Metadata { turns: Some(turns), box_faces: Some(BoxFaces::Square), ..Metadata::default() };
    let rows = made.samples.iter().map(row).collect();
    (Recording { metadata, rows, notices: Vec::new(), stamps_s: Vec::new() }, made.truth)
}

fn ask(recording: &Recording, without: &[&str]) -> Outcome {
    let without = without.iter().map(ToString::to_string).collect();
    diagnose(recording, &Options { without, seed: 1, conditions: None }, &mut |_, _| {})
}

#[test]
fn a_clean_recording_misses_nothing() {
    let (recording, _) = recording(Scheme::Double, 5, None);
    let diagnosis = ask(&recording, &[]).diagnosis;
    assert_eq!(diagnosis.verdict, Verdict::NothingMissing, "{diagnosis:?}");
    assert!(diagnosis.detection_limits.iter().any(|limit| limit.id == "gyro_g_sensitivity" && limit.limit < 0.03));
    let sigmas = |limit: &Limit| limit.fisher_sigmas.filter(|_| limit.testable);
    let searched: Vec<_> =
        diagnosis.detection_limits.iter().filter_map(|limit| Some((&limit.id, sigmas(limit)?))).collect();
    // Nine numbers are priced as if each could be anything up to typical.
    let within = |id: &str, sigmas: f64| sigmas < if id == "gyro_g_sensitivity" { 11.0 } else { 8.5 };
    assert!(searched.len() > 15 && searched.iter().all(|(id, sigmas)| within(id, *sigmas)), "{searched:?}");
}

/// A turntable: nothing trembles, and the axes that do not turn read noise of the sensor's full bandwidth and nothing else.
#[test]
fn a_turntable_with_a_wide_open_sensor_misses_nothing() {
    let mut config = SchemeConfig::new(Scheme::Double, 11);
    config.world.motion.hands = Hands::machine();
    config.world.sensor.noise.bandwidth_hz = None;
    let diagnosis = ask(&made(&config).0, &[]).diagnosis;
    assert_eq!(diagnosis.verdict, Verdict::NothingMissing, "{diagnosis:?}");
}

/// A hand that turns the box pushes it about on the table by centimetres, which shows as acceleration and is no physics of the sensor.
#[test]
fn a_box_that_slides_in_its_turns_misses_nothing_and_hides_nothing() {
    for effect in [None, Some("gyro_g_sensitivity=0.08")] {
        let mut config = SchemeConfig::realistic(Scheme::Double, 15);
        config.world.motion.hands.slide_m = 0.05;
        config.effects = effect.map(|word| Effect::parse(word).expect("a known effect")).into_iter().collect();
        let diagnosis = ask(&made(&config).0, &[]).diagnosis;
        let names: Vec<_> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
        let expected = if effect.is_some() { vec!["gyro_g_sensitivity"] } else { vec![] };
        assert!(diagnosis.unknown.is_none() && names == expected, "{effect:?}: {diagnosis:?}");
        // Without the nuisance a clean one's rows scatter by 10 and more.
        let fit = &diagnosis.fit;
        assert!(effect.is_some() || fit.before.train < 1.5, "{fit:?}");
    }
}

/// An accelerometer that slips in its mount by half a degree, this way or that by the last turn: each move ends elsewhere than the
/// gyroscope says, at random, and left alone that passes for noise of motion.
#[test]
fn moves_that_end_at_random_are_something_unknown() {
    let config = SchemeConfig::realistic(Scheme::MultiPose { poses: 24 }, 3);
    let (mut recording, _) = made(&config);
    recording.metadata = Metadata::default();
    assert_eq!(ask(&recording, &[]).diagnosis.verdict, Verdict::NothingMissing);
    let mut slipped_rad = 0.0f64;
    for row in &mut recording.rows {
        let fastest = row.gyro_dps.into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
        if fastest.abs() > 40.0 {
            slipped_rad = 0.5f64.to_radians().copysign(fastest);
        }
        let ([x, y, z], (sin, cos)) = (row.accel_g, slipped_rad.sin_cos());
        row.accel_g = [cos * x - sin * y, sin * x + cos * y, z];
    }
    let diagnosis = ask(&recording, &[]).diagnosis;
    assert_eq!(diagnosis.verdict, Verdict::UnknownEffect, "{:?} {:?}", diagnosis.effects, diagnosis.reasons);
    let unknown = diagnosis.unknown.as_ref().expect("something");
    assert!(unknown.correlates_with.iter().any(|shape| shape.contains("whose ends scatter")), "{unknown:?}");
}

#[test]
fn g_sensitivity_is_named_with_its_numbers_and_can_be_carried() {
    let (recording, truth) = recording(Scheme::Double, 6, Some("gyro_g_sensitivity=0.08"));
    let diagnosis = ask(&recording, &[]).diagnosis;
    assert_eq!(diagnosis.verdict, Verdict::EffectFound, "{diagnosis:?}");
    let found = &diagnosis.effects[0];
    assert_eq!((found.id.as_str(), diagnosis.effects.len()), ("gyro_g_sensitivity", 1));
    let pairs = found.parameters.iter().zip(&truth.effects[0].parameters);
    let chi_square: f64 = pairs.map(|(value, truth)| ((value.value - truth.value) / value.sigma).powi(2)).sum();
    // Nine numbers: χ²₉ exceeds 33.7 once in ten thousand.
    assert!(chi_square < 33.7, "{chi_square}: {:?} {:?}", found.parameters, truth.effects);
    let held_out = found.held_out.expect("it shows in both halves");
    assert!(held_out.after < held_out.before && held_out.constancy_p > 1e-4, "{held_out:?}");

    let conditions = tumble::calibrate::conditions(&recording.metadata);
    let mut readings = recording.samples(&Inference::of(&recording));
    let before = readings.clone();
    let carried =
        carry(&recording, conditions, &["gyro_g_sensitivity".into()], &[], &mut readings).expect("it can be carried");
    assert_eq!((carried.effects.len(), carried.effects[0].parameters.len()), (1, 9));
    let felt = |k: usize| before[k].sample.angular_rate_rad_s - readings[k].sample.angular_rate_rad_s;
    let largest = (0..readings.len()).map(|k| felt(k).norm().to_degrees()).fold(0.0, f32::max);
    // Its largest element is 0.08 °/s a g.
    assert!((0.04..0.4).contains(&largest), "{largest}");
    assert!(carry(&recording, conditions, &["shock".into()], &[], &mut readings).is_err());
}

#[test]
fn what_is_carried_is_not_blamed_for_what_else_there_is() {
    let mut config = SchemeConfig::realistic(Scheme::Double, 77);
    let effects = ["gyro_bias_temperature=0.03", "gyro_g_sensitivity=0.1"];
    config.effects = effects.map(|word| Effect::parse(word).expect("a known effect")).into();
    let (recording, truth) = made(&config);
    let conditions = tumble::calibrate::conditions(&recording.metadata);
    let mut readings = recording.samples(&Inference::of(&recording));
    let beside = ["gyro_g_sensitivity".to_owned()];
    let carried = carry(&recording, conditions, &["gyro_bias_temperature".into()], &beside, &mut readings);
    let carried = carried.expect("it can be carried").effects;
    assert_eq!((carried.len(), carried[0].id.as_str(), carried[0].parameters.len()), (1, "gyro_bias_temperature", 3));
    let slopes = carried[0].parameters.iter().zip(&truth.effects[0].parameters);
    let chi_square: f64 = slopes.map(|(value, truth)| ((value.value - truth.value) / value.sigma).powi(2)).sum();
    // χ²₃ exceeds 21.1 once in ten thousand; alone the slopes are off by 0.01 °/s a kelvin, 14 of these sigmas.
    assert!(chi_square < 21.1, "{chi_square}: {:?} {:?}", carried[0].parameters, truth.effects);
}

#[test]
fn an_effect_of_the_rate_is_taken_out_of_a_further_recording_too() {
    let (recording, _) = recording(Scheme::Double, 4, Some("gyro_scale_cubic=12000"));
    let mut diagnosis = ask(&recording, &[]).diagnosis;
    assert_eq!(diagnosis.effects[0].id, "gyro_scale_cubic", "{diagnosis:?}");
    try_on(&mut diagnosis, &recording, "again.csv", &Options { seed: 1, ..Options::default() });
    let other = &diagnosis.effects[0].other_recordings[0];
    // By as much the noise of moves was blamed before, so that the residuals' ratio says less than the odds.
    assert!(other.after < 0.9 * other.before && other.gain > 50.0, "{other:?}");
}

/// A clean session of poses whose gyroscope's bias jumps in the middle of a rest, and when.
fn jumps_at_rest(by_dps: [f64; 2]) -> (Recording, f64) {
    let config = SchemeConfig::realistic(Scheme::MultiPose { poses: 17 }, 4);
    let world = config.record().expect("a valid configuration").world;
    let moved = (600..).map(|k| 0.1 * f64::from(k)).find(|t_s| !world.motion_idle_at(*t_s)).expect("it is moved");
    let later = (0..).map(|k| moved + 0.1 * f64::from(k)).skip_while(|t_s| !world.motion_idle_at(*t_s));
    let rest: Vec<f64> = later.take_while(|t_s| world.motion_idle_at(*t_s)).collect();
    let jumped_s = rest[rest.len() / 2];
    let mut recording = made(&config).0;
    for row in recording.rows.iter_mut().filter(|row| row.t_s > jumped_s) {
        row.gyro_dps[0] += by_dps[0];
        row.gyro_dps[1] += by_dps[1];
    }
    (recording, jumped_s)
}

/// 0.25 °/s is found between the instants at which the search looks first; 1 °/s and 4 °/s are more than rests may differ by, and what
/// follows would pass for one steady turn.
#[test]
fn a_step_in_the_middle_of_a_rest_is_a_step_however_large() {
    for (by_dps, within_s) in [([0.15, -0.2], 0.3), ([0.6, -0.8], 2.5), ([-3.5, 2.0], 2.5)] {
        let (recording, jumped_s) = jumps_at_rest(by_dps);
        let diagnosis = ask(&recording, &[]).diagnosis;
        let names: Vec<_> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
        assert_eq!((diagnosis.verdict, &names[..]), (Verdict::EffectFound, &["gyro_bias_step"][..]), "{diagnosis:?}");
        let number = |name: &str| {
            let all = &diagnosis.effects[0].parameters;
            all.iter().find(|parameter| parameter.name == name).map(|parameter| parameter.value).expect("a number")
        };
        assert!((number("x") - by_dps[0]).abs() < 0.03 && (number("y") - by_dps[1]).abs() < 0.03, "{diagnosis:?}");
        assert!((number("at") - jumped_s).abs() < within_s, "{} for {jumped_s} s", number("at"));
    }
}

#[test]
fn what_is_not_in_the_catalogue_is_unknown() {
    let (recording, _) = recording(Scheme::Double, 7, Some("gyro_g_sensitivity=0.08"));
    let without = ["gyro_g_sensitivity", "gyro_g_squared", "gyro_bias_step"];
    let diagnosis = ask(&recording, &without).diagnosis;
    assert_eq!(diagnosis.verdict, Verdict::UnknownEffect, "{diagnosis:?}");
    let unknown = diagnosis.unknown.expect("it is unknown");
    assert!(unknown.p_value < 0.003 && !unknown.correlates_with.is_empty(), "{unknown:?}");
}

#[test]
fn one_pose_supports_no_verdict() {
    let (mut recording, _) = recording(Scheme::Double, 8, None);
    recording.rows.truncate(1200);
    let diagnosis = ask(&recording, &[]).diagnosis;
    assert_eq!(diagnosis.verdict, Verdict::NotTestable, "{diagnosis:?}");
    assert!(!diagnosis.reasons.is_empty());
}

/// The greater part of a field 65° below level is a sensitivity to gravity, and moves may be excused as noisy: neither is said.
#[test]
fn a_field_of_the_room_is_no_sensitivity_to_gravity() {
    let (recording, _) = recording(Scheme::Double, 9, Some("x_gyro_magnetic=0.5"));
    let diagnosis = ask(&recording, &[]).diagnosis;
    assert_eq!((diagnosis.verdict, diagnosis.effects.len()), (Verdict::UnknownEffect, 0), "{diagnosis:?}");
    let unknown = diagnosis.unknown.expect("it is unknown");
    assert!(unknown.correlates_with.iter().any(|shape| shape.starts_with("a field of the room")), "{unknown:?}");
}

/// Too large for one linear step: the sensor's axes must not bend to it.
#[test]
fn a_table_that_leans_by_degrees_is_found() {
    let (recording, _) = recording(Scheme::Single, 10, Some("platform_tilt_change=4"));
    let diagnosis = ask(&recording, &[]).diagnosis;
    let found: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
    assert_eq!((diagnosis.verdict, found), (Verdict::EffectFound, vec!["platform_tilt_change"]));
    let leans = diagnosis.effects[0].parameters.iter().filter(|value| value.unit == "deg").map(|value| value.value);
    let leans = leans.map(|value| value * value).sum::<f64>().sqrt();
    assert!((leans - 4.0).abs() < 0.1, "{leans}");
}

/// Each axis turns once: its scale is known beside that turn by the moves from face to face.
#[test]
fn a_turn_in_quarter_steps_may_be_incomplete() {
    let mut config = SchemeConfig::new(Scheme::Quarter, 26);
    config.effects = vec![Effect::parse("incomplete_turn=8").expect("a known effect")];
    let diagnosis = ask(&made(&config).0, &[]).diagnosis;
    let found: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
    assert_eq!((diagnosis.verdict, found), (Verdict::EffectFound, vec!["incomplete_turn"]));
}
