//! Effects on the command line: simulated, added to a recording, hidden and revealed.

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

fn good(words: &[&str]) -> String {
    let output = tumble(words);
    assert_eq!(status(&output), 0, "{words:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

fn path(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).to_str().expect("a plain path").to_owned()
}

fn read(path: &str) -> String {
    std::fs::read_to_string(path).expect("it was written")
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// Metadata, header and the numbers of the rows.
fn parts(csv: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let (head, rows): (Vec<&str>, Vec<&str>) = csv.lines().partition(|l| l.starts_with('#') || l.starts_with("t_s"));
    let number = |field: &str| field.parse().expect("a number");
    (head, rows.into_iter().map(|row| row.split(',').map(number).collect()).collect())
}

#[test]
fn wrong_effects_leave_with_2_and_say_what_is_right() {
    for (words, part) in [
        (&["--effect", "gyro_bias_stap"][..], "near to it: gyro_bias_step"),
        (&["--effect", "gyro_bias_step=99"], "from 0 to 50 dps"),
        (&["--effect", "shock=hard"], "'hard' is not a number"),
        (&["--conceal", "--effect", "shock"], "cannot be used with"),
        (&["--conceal", "--truth", "t.json"], "cannot be used with"),
        (&["--inject", "real.csv"], "--effect"),
        (&["--inject", "real.csv", "--effect", "shock", "--by-hand"], "cannot be used with"),
    ] {
        let output = tumble(&[&["simulate", "-o", "x.csv"], words].concat());
        let message = text(&output.stderr);
        assert_eq!(status(&output), 2, "{words:?}: {message}");
        assert!(message.contains(part), "{words:?}: {message}");
        assert!(!Path::new("x.csv").exists(), "{words:?} wrote a file");
    }
    let list = good(&["simulate", "--list-effects"]);
    for part in
        ["gyro_g_sensitivity=0.1  dps/g", "x_gyro_after_effect=", "not for --inject", "typical: ", "magnitude: "]
    {
        assert!(list.contains(part), "{part} is not in\n{list}");
    }
}

#[test]
fn the_truth_has_the_effects() {
    let folder = tempfile::tempdir().expect("a place to write");
    let (recording, truth) = (path(&folder, "r.csv"), path(&folder, "t.json"));
    let words = ["simulate", "-o", &recording, "--truth", &truth, "--scheme", "quarter", "--nuisance"];
    good(&[&words[..], &["--effect", "gyro_bias_step=0.2", "--effect", "dropped_samples=3"]].concat());
    let truth = json(&read(&truth));
    let effects = truth["effects"].as_array().expect("a list");
    assert_eq!((effects.len(), &effects[0]["id"], &effects[0]["unit"]), (2, &"gyro_bias_step".into(), &"dps".into()));
    assert_eq!(effects[0]["magnitude"].as_f64(), Some(0.2));
    let parameters = effects[0]["parameters"].as_array().expect("a list");
    let square = |p: &Value| p["value"].as_f64().expect("a number").powi(2);
    let steps = parameters
        .iter()
        .filter(|p| p["name"].as_str().is_some_and(|name| name.starts_with("step_") && name.len() == 6));
    assert!((steps.map(square).sum::<f64>().sqrt() - 0.2).abs() < 1e-12, "{parameters:?}");
    let csv = read(&recording);
    let (head, rows) = parts(&csv);
    assert!(head.contains(&"# gyro_range_dps: 2000") && !csv.contains("effect") && !csv.contains("seed"));
    // Every reading is a whole count.
    let counts = |v: f64| (v * 16.4 - (v * 16.4).round()).abs() < 1e-4;
    assert!(rows.iter().all(|row| row[1..4].iter().all(|v| counts(*v))));
}

#[test]
fn effects_are_added_to_a_real_recording() {
    let folder = tempfile::tempdir().expect("a place to write");
    let (real, out, truth) = (path(&folder, "real.csv"), path(&folder, "out.csv"), path(&folder, "t.json"));
    good(&["simulate", "-o", &real, "--scheme", "quarter", "--nuisance", "--seed", "4"]);
    // As another logger writes: three and six decimals, its own metadata.
    let written = read(&real);
    let (_, rows) = parts(&written);
    let mut csv = "# sensor: somebody's\n# gyro_range_dps: 2000\n# accel_range_g: 16\n# turns: by-hand\nt_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g\n".to_owned();
    for row in rows {
        let [t, gx, gy, gz, ax, ay, az] = row[..7] else { panic!("seven columns") };
        csv += &format!("{t:.6},{gx:.3},{gy:.3},{gz:.3},{ax:.6},{ay:.6},{az:.6}\n");
    }
    std::fs::write(&real, &csv).expect("written");
    good(&["simulate", "--inject", &real, "--effect", "accel_bias_step=20", "-o", &out, "--truth", &truth]);
    let changed = read(&out);
    let ((old_head, old), (new_head, new)) = (parts(&csv), parts(&changed));
    assert_eq!((old_head, old.len()), (new_head, new.len()));
    let step = &json(&read(&truth))["effects"][0]["parameters"];
    let (time_s, size) =
        (step[0]["value"].as_f64().expect("s"), |i: usize| step[i]["value"].as_f64().expect("mg") / 1e3);
    let mut after = Vec::new();
    for (old, new) in old.iter().zip(&new) {
        assert_eq!(old[..4], new[..4], "stamps and gyro are left alone");
        let by: [f64; 3] = std::array::from_fn(|i| new[4 + i] - old[4 + i]);
        assert!(new[4..7].iter().all(|a| (a * 1e6 - (a * 1e6).round()).abs() < 1e-6), "as many decimals as before");
        if old[0] < time_s {
            assert_eq!(by, [0.0; 3]);
        } else {
            // Whole counts of 0.49 mg: at most one beside the step.
            assert!((0..3).all(|i| (by[i] - size(i + 1)).abs() < 0.6e-3), "{by:?}");
            after.push(by);
        }
    }
    for i in 0..3 {
        let mean = after.iter().map(|by| by[i]).sum::<f64>() / after.len() as f64;
        assert!((mean - size(i + 1)).abs() < 0.02e-3, "{mean} g: parts of a count are not rounded away");
    }
    let refused = tumble(&["simulate", "--inject", &real, "--effect", "gyro_bias_temperature", "-o", &out]);
    assert_eq!(status(&refused), 1);
    assert!(text(&refused.stderr).contains("temp_c"), "{}", text(&refused.stderr));
    let refused = tumble(&["simulate", "--inject", &real, "--effect", "table_rocking", "-o", &out]);
    assert!(status(&refused) == 1 && text(&refused.stderr).contains("simulated but not added"));
}

#[test]
fn what_is_concealed_is_revealed_and_nothing_betrays_it() {
    let folder = tempfile::tempdir().expect("a place to write");
    let recording = path(&folder, "r.csv");
    let mut hidden = Vec::new();
    let (mut heads, mut seals, mut said) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 1..=24 {
        let seed = seed.to_string();
        let output = good(&["simulate", "--conceal", "-o", &recording, "--scheme", "tumble", "--seed", &seed]);
        said.push(output);
        let csv = read(&recording);
        let (head, rows) = parts(&csv);
        heads.push(
            head.iter().filter(|line| !line.contains("rate_hz")).map(|line| (*line).to_owned()).collect::<Vec<_>>(),
        );
        assert!(rows.iter().all(|row| row.len() == 8), "a temperature in every row");
        let swing = |pick: fn(f64, f64) -> f64, from: f64| rows.iter().map(|row| row[7]).fold(from, pick);
        assert!(swing(f64::max, -300.0) - swing(f64::min, 300.0) > 1.0, "seed {seed}: a temperature that moves");
        let seal = read(&format!("{recording}.seal"));
        seals.push(seal.len());
        let revealed = json(&good(&["reveal", &recording, "--json"]));
        assert_eq!(revealed["recording_unchanged"], true);
        let effects = revealed["effects"].as_array().expect("a list");
        assert_eq!(effects.is_empty(), revealed["hidden"] == "nothing");
        let id = effects.first().map_or("nothing".to_owned(), |effect| effect["id"].as_str().expect("id").to_owned());
        assert!(!csv.contains(&id) && !seal.contains(&id));
        let words = good(&["reveal", &recording]);
        assert!(words.contains(&id), "{words}");
        hidden.push(id);
    }
    assert!(heads.iter().all(|head| *head == heads[0]), "the same metadata whatever is hidden");
    assert!(seals.iter().all(|length| *length == seals[0]), "the same length whatever is hidden");
    assert!(said.iter().all(|line| *line == said[0]), "the same words whatever is hidden");
    let nothing = hidden.iter().filter(|id| *id == "nothing").count();
    assert!((1..12).contains(&nothing), "{hidden:?}");
    hidden.sort();
    hidden.dedup();
    assert!(hidden.len() > 10, "{hidden:?}");
}

#[test]
fn a_changed_recording_and_a_broken_seal_are_told() {
    let folder = tempfile::tempdir().expect("a place to write");
    let recording = path(&folder, "r.csv");
    good(&["simulate", "--conceal", "-o", &recording, "--scheme", "tumble"]);
    std::fs::write(&recording, read(&recording) + "\n").expect("written");
    assert!(good(&["reveal", &recording]).contains("somebody changed it"));
    let seal = format!("{recording}.seal");
    for broken in [
        "",
        "tumble-seal 1\nxyz\n00\n",
        "tumble-seal 1\n0123456789abcdef\n0g\n",
        "tumble-seal 1\n0123456789abcdef\n0011\n",
    ] {
        std::fs::write(&seal, broken).expect("written");
        let output = tumble(&["reveal", &recording]);
        assert_eq!(status(&output), 1);
        assert!(text(&output.stderr).contains("is no seal of this program, or damaged"), "{}", text(&output.stderr));
    }
    std::fs::remove_file(&seal).expect("removed");
    let output = tumble(&["reveal", &recording]);
    assert!(status(&output) == 1 && text(&output.stderr).contains("r.csv.seal"));
}
