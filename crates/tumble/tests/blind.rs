//! Studies of the diagnosis by processes of their own, in small.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn tumble(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tumble")).args(words).output().expect("the program was built for this test")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("text")
}

fn study(folder: &Path, more: &[&str]) -> Value {
    let folder = folder.to_str().expect("a plain path");
    let mut words =
        vec!["study", "blind", "--json", "--seeds", "1", "--clean", "2", "--scheme", "single", "-o", folder];
    words.extend(more);
    let output = tumble(&words);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

fn names(folder: &Path, part: &str) -> Vec<String> {
    let list = std::fs::read_dir(folder.join(part)).expect("the study made it");
    let mut names: Vec<String> =
        list.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_study_is_drawn_diagnosed_and_scored() {
    let folder = tempfile::tempdir().expect("a folder");
    let effects = ["--effects", "gyro_g_sensitivity,accel_bias_step"];
    // At eight times the limit any diagnosis must see it; what is under test here is the study.
    let report = study(folder.path(), &[&effects[..], &["--at", "8"]].concat());
    assert_eq!((&report["format"], &report["cases"]), (&"tumble-study-blind".into(), &4.into()));
    assert_eq!(report["broken"], Value::Array(Vec::new()));
    let rows = report["effects"].as_array().expect("rows");
    assert_eq!(rows.len(), 2);
    assert!(rows.iter().all(|row| row["by_limit"] == 1 && row["outcomes"].get("missed").is_none()), "{rows:?}");
    assert_eq!(report["clean"][0]["false_alarms"]["count"], 2);
    // Nothing that the diagnosis is given says what a recording is.
    let recordings = names(folder.path(), "recordings");
    assert_eq!(recordings.len(), 4);
    for name in &recordings {
        let stem = name.strip_suffix(".csv").expect("a CSV file");
        assert!(stem.len() == 16 && stem.chars().all(|c| c.is_ascii_hexdigit()), "{name}");
        let csv = std::fs::read_to_string(folder.path().join("recordings").join(name)).expect("text");
        assert!(!csv.contains("g_sensitivity") && !csv.contains("accel_bias"), "{name}");
        let seal = std::fs::read_to_string(folder.path().join("seals").join(format!("{name}.seal"))).expect("a seal");
        assert!(!seal.contains("g_sensitivity"), "{name}");
    }
    let cases = std::fs::read_to_string(folder.path().join("cases.csv")).expect("it was written");
    assert_eq!(cases.lines().count(), 5);

    // What is answered is not asked again: the answers keep their times.
    let again = study(folder.path(), &[&effects[..], &["--at", "8"]].concat());
    assert_eq!(again, report);
}

#[test]
fn an_effect_that_is_not_in_the_catalogue_is_wrong_usage() {
    let output = tumble(&["study", "blind", "--effects", "gyro_g_sensitivty"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("gyro_g_sensitivty"));
}

#[test]
fn without_real_recordings_the_injection_says_that_it_is_skipped() {
    let output = tumble(&["study", "injection", "--recordings", "/nonexistent/recordings"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("skipped"), "{}", text(&output.stderr));
}
