//! A calibration from samples that have a fault: what can be put right is, and it is said.

use std::process::Command;

use serde_json::Value;

/// The verdict, the reasons, and the mean e²/σ² of the gyroscope's correction; the recording has these effects.
fn calibrated(name: &str, seed: u64, effects: &[&str], with: &[&str]) -> (String, Vec<String>, f64) {
    let folder = tempfile::tempdir().expect("a folder");
    let (csv, truth) = (folder.path().join(format!("{name}.csv")), folder.path().join("truth.json"));
    let tool = env!("CARGO_BIN_EXE_tumble");
    let mut simulate = Command::new(tool);
    simulate.arg("simulate").arg("-o").arg(&csv).arg("--truth").arg(&truth);
    simulate.args(["--scheme", "double", "--rate-hz", "100", "--seed", &seed.to_string()]);
    effects.iter().for_each(|effect| {
        simulate.args(["--effect", effect]);
    });
    assert!(simulate.status().expect("it runs").success(), "{name}");
    let mut calibrate = Command::new(tool);
    calibrate.arg("calibrate").arg(&csv).arg("--json");
    with.iter().for_each(|id| {
        calibrate.args(["--with", id]);
    });
    let output = calibrate.output().expect("it runs");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let truth: Value = serde_json::from_slice(&std::fs::read(&truth).expect("written")).expect("JSON");
    let rows = |of: &Value, key: &str| -> Vec<f64> {
        let rows = of["gyroscope"][key].as_array().expect("rows").iter();
        rows.flat_map(|row| row.as_array().expect("a row").iter().map(|v| v.as_f64().unwrap_or(f64::NAN))).collect()
    };
    let reasons = report["reasons"].as_array().expect("a list").iter().filter_map(Value::as_str);
    let reasons: Vec<String> = reasons.map(Into::into).collect();
    let verdict = report["verdict"].as_str().expect("a word").to_owned();
    assert_ne!(verdict, "rejected", "{name}: {reasons:?}");
    assert_eq!(report["frame"], truth["frame"], "{name}: {reasons:?}");
    let (found, sigma, real) =
        (rows(&report, "correction"), rows(&report, "correction_sigma"), rows(&truth, "correction"));
    let squares = found.iter().zip(&sigma).zip(&real).map(|((found, sigma), real)| ((found - real) / sigma).powi(2));
    (verdict, reasons, squares.sum::<f64>() / 9.0)
}

#[test]
fn faults_of_the_samples_are_put_right_and_said() {
    for (effect, word) in [
        ("duplicated_samples=2", "old values under new stamps"),
        ("timestamp_jitter=2", "evenly spaced"),
        ("frozen_reading=0.5", "one channel stands still"),
    ] {
        let mut sum = 0.0;
        for seed in [31, 32, 33] {
            let (verdict, reasons, squares) = calibrated(effect, seed, &[effect], &[]);
            assert_eq!(verdict, "accepted_with_warnings", "{effect}: {reasons:?}");
            assert!(reasons.iter().any(|reason| reason.contains(word)), "{effect}: {reasons:?}");
            sum += squares / 3.0;
        }
        println!("{effect}: mean e²/σ² {sum:.1}");
        assert!(sum < 5.0, "{effect}: {sum}");
    }
}

#[test]
fn nothing_is_said_of_sound_samples() {
    let (verdict, reasons, squares) = calibrated("clean", 34, &[], &[]);
    assert_eq!((verdict.as_str(), reasons.len()), ("accepted", 0), "{reasons:?}");
    assert!(squares < 3.0, "{squares}");
}

/// Samples are put right before an effect is fitted and taken out, and what else there is is still said.
#[test]
fn an_effect_is_carried_from_faulty_samples_too() {
    let effects = ["gyro_scale_temperature=4000", "duplicated_samples=2", "accel_cubic=80"];
    let (_, without, _) = calibrated("without", 35, &effects, &[]);
    assert!(without.iter().any(|reason| reason.contains("gyro_scale_temperature")), "{without:?}");
    let mut sum = 0.0;
    for seed in [35, 36, 37] {
        let (_, reasons, squares) = calibrated("with", seed, &effects, &["gyro_scale_temperature"]);
        assert!(reasons.iter().any(|reason| reason.contains("old values under new stamps")), "{reasons:?}");
        assert!(reasons.iter().any(|reason| reason.contains("accel_cubic")), "{reasons:?}");
        let left_out = |reason: &&String| reason.starts_with("Not in these numbers");
        let left_out = reasons.iter().filter(left_out).any(|reason| reason.contains("gyro_scale_temperature"));
        assert!(!left_out, "{reasons:?}");
        sum += squares / 3.0;
    }
    println!("mean e²/σ² {sum:.1}");
    assert!(sum < 5.0, "{sum}");
}

/// The scale at the session's mean temperature hangs on how it follows temperature wherever an axis was turned away from that mean.
#[test]
fn what_is_uncertain_of_a_carried_effect_is_in_the_sigmas() {
    let mut sum = 0.0;
    for seed in 35..41 {
        let effect = "gyro_scale_temperature";
        let (_, reasons, squares) = calibrated("carried", seed, &["gyro_scale_temperature=1000"], &[effect]);
        assert!(
            reasons.iter().any(|reason| reason.contains(effect) && reason.contains("more than doubles")),
            "{reasons:?}"
        );
        sum += squares / 6.0;
    }
    println!("gyro_scale_temperature carried: mean e²/σ² {sum:.2}");
    // 54 numbers: 1 ± 0.2 if they were independent.
    assert!((0.3..2.0).contains(&sum), "{sum}");
}
