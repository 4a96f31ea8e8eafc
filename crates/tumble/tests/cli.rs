//! The program as a person or a script meets it: exit status, standard output, standard error.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn tumble(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tumble")).args(words).output().expect("the program was built for this test")
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("it ends by itself")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

fn path(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).to_str().expect("a plain path").to_owned()
}

#[test]
fn wrong_usage_leaves_with_2() {
    for words in [
        &[][..],
        &["dance"],
        &["calibrate"],
        &["calibrate", "a.csv", "--reference", "moon"],
        &["simulate"],
        &["simulate", "-o", "x.csv", "--scheme", "waltz"],
        &["simulate", "-o", "x.csv", "--by-hand", "--fenced"],
        &["simulate", "-o", "x.csv", "--gyro-range-dps", "250"],
        &["simulate", "-o", "x.csv", "--lever-cm", "1,2"],
        &["simulate", "-o", "x.csv", "--imperfection", "ghosts"],
        &["simulate", "-o", "x.csv", "--tilt-deg", "80"],
        &["record", "/dev/null"],
    ] {
        let output = tumble(words);
        assert_eq!(status(&output), 2, "{words:?}: {}", text(&output.stderr));
        assert!(!Path::new("x.csv").exists(), "{words:?} wrote a file");
        assert!(!output.stderr.is_empty(), "{words:?} says nothing");
    }
    assert_eq!(status(&tumble(&["--help"])), 0);
}

#[test]
fn refused_inputs_leave_with_1_and_say_why() {
    let folder = tempfile::tempdir().expect("a place to write");
    let broken = path(&folder, "broken.csv");
    std::fs::write(&broken, "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g\n0,0,0,0,0,0,1\n0.005,0,zero,0,0,0,1\n")
        .expect("written");
    let absent = path(&folder, "absent.csv");
    for (file, part) in [(&absent, "cannot be read"), (&broken, "line 3, column gy_dps: 'zero' is not a number")] {
        let output = tumble(&["calibrate", file]);
        let message = text(&output.stderr);
        assert_eq!((status(&output), output.stdout.len()), (1, 0), "{message}");
        assert!(message.contains(part) && message.contains(file.as_str()) && message.contains("Remedy"), "{message}");

        let output = tumble(&["calibrate", file, "--json"]);
        let report: Value = serde_json::from_slice(&output.stdout).expect("one object");
        assert_eq!((status(&output), &report["verdict"]), (1, &Value::from("rejected")));
        assert!(report["reasons"][0].as_str().is_some_and(|reason| reason.contains(part)), "{report}");
        assert!(report["accelerometer"].is_null() && report["gyroscope"].is_null() && report["covariance"].is_null());
    }
    let output = tumble(&["simulate", "-o", &path(&folder, "no/such/folder.csv")]);
    assert_eq!(status(&output), 1, "{}", text(&output.stderr));
    let output = tumble(&["record", &path(&folder, "no-port"), "-o", &path(&folder, "r.csv")]);
    assert_eq!(status(&output), 1);
    assert!(text(&output.stderr).contains("no-port"), "{}", text(&output.stderr));
}

#[test]
fn a_recording_that_cannot_be_calibrated_is_rejected_without_numbers() {
    let folder = tempfile::tempdir().expect("a place to write");
    let (whole, _) = simulated(&folder, &[]);
    let whole = std::fs::read_to_string(whole).expect("it was written");
    let part = path(&folder, "part.csv");
    // Two faces of six: 64 s are enough for both.
    let two_faces: Vec<&str> = whole.lines().take(64 * 200).collect();
    std::fs::write(&part, two_faces.join("\n") + "\n").expect("written");
    let output = tumble(&["calibrate", &part, "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).expect("one object");
    assert_eq!((status(&output), &report["verdict"]), (1, &Value::from("rejected")), "{report}");
    assert!(report["accelerometer"].is_null() && report["gyroscope"].is_null() && report["covariance"].is_null());
    assert!(report["segments"].as_array().is_some_and(|segments| !segments.is_empty()));
    assert!(!report["reasons"].as_array().expect("a list").is_empty());
    assert!(text(&output.stderr).contains("rejected"), "{}", text(&output.stderr));
}

/// Makes a recording; its path and its truth.
fn simulated(folder: &tempfile::TempDir, words: &[&str]) -> (String, Value) {
    let (recording, truth) = (path(folder, "rec.csv"), path(folder, "truth.json"));
    let output = tumble(&[&["simulate", "-o", &recording, "--truth", &truth], words].concat());
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let truth = std::fs::read(&truth).expect("it was written");
    (recording, serde_json::from_slice(&truth).expect("JSON"))
}

/// The largest error over its sigma of one triad, over all that is observable.
fn worst(report: &Value, truth: &Value, triad: &str, unit: &str) -> f64 {
    let (found, truth) = (&report[triad], &truth[triad]);
    let mut worst: f64 = 0.0;
    let mut compare = |found: &Value, sigma: &Value, truth: &Value| {
        if let (Some(found), Some(sigma), Some(truth)) = (found.as_f64(), sigma.as_f64(), truth.as_f64())
            && sigma > 0.0
        {
            worst = worst.max((found - truth).abs() / sigma);
        }
    };
    for i in 0..3 {
        let (bias, sigma) = (format!("bias_{unit}"), format!("bias_sigma_{unit}"));
        compare(&found[&bias][i], &found[&sigma][i], &truth[&bias][i]);
        for j in 0..3 {
            compare(&found["correction"][i][j], &found["correction_sigma"][i][j], &truth["correction"][i][j]);
        }
    }
    worst
}

#[test]
fn a_simulated_sensor_is_found_again_within_its_sigmas() {
    let folder = tempfile::tempdir().expect("a place to write");
    for words in [&["--seed", "5"][..], &["--seed", "6", "--by-hand", "--counts"], &["--paper", "--seed", "7"]] {
        let (recording, truth) = simulated(&folder, words);
        let output = tumble(&["calibrate", &recording, "--json"]);
        assert_eq!((status(&output), text(&output.stderr)), (0, String::new()), "{words:?}");
        assert_eq!(text(&output.stdout).lines().count(), 1, "one object and nothing else");
        let report: Value = serde_json::from_slice(&output.stdout).expect("one object");
        assert_eq!((&report["format"], &report["version"]), (&Value::from("tumble-calibration"), &Value::from(1)));
        assert_eq!(report["frame"], "box");
        for (triad, unit) in [("accelerometer", "mps2"), ("gyroscope", "rad_s")] {
            let worst = worst(&report, &truth, triad, unit);
            assert!(worst < 5.0, "{words:?}: {triad} is off by {worst} sigma");
        }
        let order = report["covariance"]["order"].as_array().expect("names");
        let matrix = report["covariance"]["matrix"].as_array().expect("rows");
        assert_eq!((order.len(), matrix.len(), matrix[0].as_array().map(Vec::len)), (24, 24, Some(24)));
        let turns = report["segments"].as_array().expect("a list").iter().filter(|s| s["kind"] == "turn");
        assert_eq!(turns.count(), if words.contains(&"--paper") { 6 } else { 12 }, "{words:?}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_the_truth_is_apart() {
    let folder = tempfile::tempdir().expect("a place to write");
    let read = |words: &[&str]| std::fs::read_to_string(simulated(&folder, words).0).expect("it was written");
    let first = read(&["--scheme", "quarter", "--seed", "9", "--imperfection", "all"]);
    assert_eq!(first, read(&["--scheme", "quarter", "--seed", "9", "--imperfection", "all"]));
    assert_ne!(first, read(&["--scheme", "quarter", "--seed", "10", "--imperfection", "all"]));
    assert!(first.contains("# box: unknown") && first.contains("# turns: by-hand"), "what an honest recorder knows");
    assert!(!first.contains("seed"), "the seed would tell the truth");
}

#[test]
fn the_table_names_every_number_and_the_reference_can_be_chosen() {
    let folder = tempfile::tempdir().expect("a place to write");
    let (recording, _) = simulated(&folder, &[]);
    let table = text(&tumble(&["calibrate", &recording]).stdout);
    for part in ["verdict: ", "accelerometer bias, mg", "gyroscope correction z", "one sigma", "12 turns", "fit: "] {
        assert!(table.contains(part), "{part} is not in\n{table}");
    }
    let gravity = tumble(&["calibrate", &recording, "--json", "--reference", "gravity", "--turns", "by-hand"]);
    let report: Value = serde_json::from_slice(&gravity.stdout).expect("one object");
    assert_eq!(report["frame"], "accelerometer");
    assert_eq!(report["accelerometer"]["correction"][0][1].as_f64(), Some(0.0), "lower-triangular");
    let counts = tumble(&["calibrate", &recording, "--board-counts"]);
    assert_eq!(status(&counts), 0, "{}", text(&counts.stderr));
}
