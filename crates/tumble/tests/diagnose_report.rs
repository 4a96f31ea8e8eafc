//! What `tumble diagnose` shows to people: one page, one screen, one object, whatever the verdict.

use std::process::Command;

use tumble::diagnose::diagnosis::{
    BEYOND, ChannelFit, Diagnosis, FitReport, Found, HeldOut, Limit, OtherRecording, Pair, Place, RunnerUp, Unknown,
    Value, Verdict,
};
use tumble::diagnose::exhibits::{Exhibits, Regression, Segment};
use tumble::diagnose::report::terminal::{MOST_LINES, WIDTH};
use tumble::diagnose::report::{self, Source};
use tumble::diagnose::twin::rows::{Address, CHANNELS, Class};

const SECTIONS: [&str; 9] =
    ["verdict", "where", "what", "fit", "regressor", "evidence", "isolability", "unknown", "limits"];
const VERDICTS: [Verdict; 4] =
    [Verdict::NothingMissing, Verdict::EffectFound, Verdict::UnknownEffect, Verdict::NotTestable];

fn found(id: &str, rest: &[&str]) -> Found {
    let value =
        |i: usize| Value { name: format!("parameter_{i}"), value: 0.1 * i as f64, sigma: 0.003, unit: "dps/g".into() };
    Found {
        id: id.into(),
        name: format!("a long sentence about what {id} does to the gyroscope and to everything that rests on it"),
        equation: "rate_raw += G * f, G 3x3, and some more so that it does not fit into one line".into(),
        evidence: 494.2,
        runner_up: Some(RunnerUp { id: "gyro_bias_random_walk".into(), gap: 148.0 }),
        tied_with: rest.iter().map(|id| (*id).to_owned()).collect(),
        tied_with_shapes: Vec::new(),
        separate_by: "rest on both faces of every axis, and come back to the first. ".repeat(6),
        parameters: (0..9).map(value).collect(),
        place: place(),
        typical: "0.1 deg/s/g <sheet>".into(),
        held_out: Some(HeldOut { before: 3.1, after: 1.0, constancy_p: 0.4 }),
        other_recordings: (0..3)
            .map(|k| OtherRecording { file: format!("<b>{k}</b>.csv"), before: 3.0, after: 1.0, gain: 900.0 })
            .collect(),
    }
}

fn place() -> Place {
    let channels = CHANNELS.map(String::from).to_vec();
    Place { channels, segments: (0..40).filter(|k| k % 3 != 1).collect(), start_s: 2.0, end_s: 193.5 }
}

/// As full as a diagnosis gets.
fn diagnosis(verdict: Verdict) -> Diagnosis {
    let effects = match verdict {
        Verdict::EffectFound | Verdict::UnknownEffect => {
            ["gyro_g_sensitivity", "gyro_bias_step", "accel_cubic", "gyro_accel_lag", "earth_rotation"]
                .map(|id| found(id, &["gyro_g_squared", "gyro_warm_up"]))
                .to_vec()
        }
        _ => Vec::new(),
    };
    let unknown = (verdict == Verdict::UnknownEffect).then(|| Unknown {
        place: place(),
        correlates_with: vec!["slow oscillation: sin(2 pi t/24 s), cos(2 pi t/24 s) (gyroscope)".into(); 5],
        resembles: vec!["accel_internal_lever_arms".into(); 4],
        p_value: 1e-12,
    });
    let fit = |before, after| FitReport {
        before: Pair { train: before, held_out: before },
        after: Pair { train: after, held_out: after },
        per_channel: CHANNELS.iter().map(|name| (name.to_string(), ChannelFit { before, after })).collect(),
    };
    let limit = |k: usize| Limit {
        id: format!("an_effect_of_number_{k}"),
        limit: if k.is_multiple_of(2) { 0.01 } else { f64::MAX },
        unit: "dps/g".into(),
        fisher_sigmas: k.is_multiple_of(2).then_some(6.5),
        testable: k.is_multiple_of(2),
        why: if k.is_multiple_of(2) { String::new() } else { "the temperature did not change & so on".into() },
    };
    Diagnosis {
        format: "tumble-diagnosis",
        version: 1,
        verdict,
        effects,
        unknown,
        fit: if verdict == Verdict::NotTestable { FitReport::default() } else { fit(3.1, 1.0) },
        detection_limits: (0..37).map(limit).collect(),
        reasons: vec!["Record rests on all six faces, with a full turn on each, so that scale can show.".repeat(2); 4],
    }
}

fn exhibits() -> Exhibits {
    let at: Vec<Address> = (0..2400)
        .map(|k| Address { class: Class::RestRate, channel: k % 6, stretch: k / 24, t_s: k as f64, late: k % 2 == 0 })
        .collect();
    let wave = |k: usize| 5.0 * (k as f64 * 0.37).sin();
    let noise = |k: usize| (k as f64 * 12.9898).sin();
    let names = ["gyro_g_sensitivity", "gyro_bias_step", "accel_cubic"].map(String::from).to_vec();
    Exhibits {
        before: (0..2400).map(|k| wave(k) + noise(k)).collect(),
        after: (0..2400).map(noise).collect(),
        after_at: at.clone(),
        at,
        segments: (0..100)
            .map(|number| {
                let name = if number == 3 { "<script>alert(1)</script>".into() } else { "rest +x".into() };
                Segment { number, name, start_s: number as f64, end_s: number as f64 + 1.0 }
            })
            .collect(),
        regressions: vec![Regression {
            id: names[0].clone(),
            signal: (0..2400).map(wave).collect(),
            before: (0..2400).map(|k| wave(k) + noise(k)).collect(),
        }],
        scores: vec![(names[0].clone(), 494.0), (names[1].clone(), 3.0), (names[2].clone(), -12.0)],
        threshold: 4.6,
        isolability: vec![vec![1.0, 0.97, 0.2], vec![0.6, 1.0, f64::NAN], vec![0.0, 0.1, 1.0]],
        isolable: names,
        correlates: Vec::new(),
    }
}

fn source() -> Source {
    Source { file: "<script>alert('x')</script>.csv".into(), sensor: Some("a & b".into()), samples: 9, length_s: 1.0 }
}

/// Every opened tag is closed in its order, and no reference leads out of the page.
fn check_page(page: &str) {
    let (head, rest) = page.split_once("<style>").expect("a style");
    let body = rest.split_once("</style>").expect("which ends").1;
    let mut open: Vec<&str> = Vec::new();
    let text = head.to_owned() + body;
    for tag in text.split('<').skip(1) {
        let (inside, after) = tag.split_once('>').expect("every tag ends");
        assert!(!after.contains('>'), "a bare > after <{inside}>");
        let name = inside.split_whitespace().next().expect("a name");
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "closed out of order");
        } else if !inside.ends_with('/') && !name.starts_with('!') {
            open.push(name);
        }
        assert_eq!(inside.matches('"').count() % 2, 0, "quotes in <{inside}>");
    }
    assert!(open.is_empty(), "left open: {open:?}");
    for word in ["http:", "https:", "<script", "src=", "href=", "url(", "@import", "NaN"] {
        assert!(!page.contains(word), "{word} in the page");
    }
    assert!(page.split(|c: char| !c.is_alphanumeric()).all(|word| word != "inf"), "infinity in the page");
}

fn check_story(story: &str) {
    assert!(story.lines().count() <= MOST_LINES, "{} lines:\n{story}", story.lines().count());
    for line in story.lines() {
        assert!(line.chars().count() <= WIDTH, "too wide: {line}");
    }
}

#[test]
fn the_page_has_all_sections_for_every_verdict() {
    for verdict in VERDICTS {
        for exhibits in [Some(exhibits()), None] {
            let page = report::page(&source(), &diagnosis(verdict), exhibits.as_ref());
            check_page(&page);
            for id in SECTIONS {
                assert!(page.contains(&format!("<section id=\"{id}\">")), "{verdict:?} without {id}");
            }
            assert!(page.contains("&lt;script&gt;alert(&#39;x&#39;)"), "the file's name is told");
            let pictures = page.matches("<svg role=\"img\" aria-label=").count();
            assert_eq!(pictures, page.matches("<svg").count(), "every picture has its words");
            if exhibits.is_some() && verdict == Verdict::EffectFound {
                assert_eq!(pictures, 5, "where, channels, regressor, evidence, isolability");
            }
        }
    }
}

#[test]
fn the_story_fits_a_screen_and_tells_the_main_things() {
    for verdict in VERDICTS {
        let exhibits = exhibits();
        let diagnosis = diagnosis(verdict);
        let story = report::story(&diagnosis, Some(&exhibits));
        check_story(&story);
        check_story(&report::story(&diagnosis, None));
        assert!(story.contains("\nlimits "), "{verdict:?}: {story}");
        if verdict == Verdict::EffectFound || verdict == Verdict::UnknownEffect {
            for label in ["where", "what", "how sure", "left over"] {
                assert!(story.contains(&format!("\n{label} ")), "{verdict:?} without {label}: {story}");
            }
        }
        if verdict == Verdict::NotTestable {
            assert!(story.starts_with("CANNOT TELL This recording cannot tell: Record rests on all six"), "{story}");
        }
    }
}

#[test]
fn an_effect_that_makes_it_worse_is_not_praised() {
    let mut diagnosis = diagnosis(Verdict::EffectFound);
    diagnosis.fit.after.held_out = 5000.0;
    assert!(report::words::verdict(&diagnosis).ends_with("do not trust the name."));
}

#[test]
fn json_holds_numbers_where_there_are_none() {
    let mut diagnosis = diagnosis(Verdict::EffectFound);
    diagnosis.effects[0].parameters[0].sigma = f64::NAN;
    diagnosis.effects[0].evidence = f64::INFINITY;
    diagnosis.effects[0].held_out = Some(HeldOut { before: f64::NAN, after: f64::NAN, constancy_p: f64::NAN });
    let json = serde_json::to_value(&diagnosis).expect("an object");
    let effect = &json["effects"][0];
    assert_eq!(effect["parameters"][0]["sigma"], BEYOND);
    assert_eq!(effect["evidence"], BEYOND);
    assert_eq!(effect["held_out"]["before"], 0.0);
    assert_eq!(effect["held_out"]["constancy_p"], 1.0);
    assert_eq!(json["detection_limits"][1]["limit"], BEYOND);
    check_page(&report::page(&source(), &diagnosis, Some(&exhibits())));
}

/// A real run: two short recordings of one sensor with a large effect, through the program itself.
#[test]
fn the_program_writes_the_page_and_tries_the_second_recording() {
    let folder = tempfile::tempdir().expect("a place to write");
    let path = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let tumble = |words: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_tumble")).args(words).output().expect("it was built");
        assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    };
    let (first, second, page) = (path("<first>.csv"), path("second.csv"), path("page"));
    // The seed draws the sensor and its effect, so that one seed in two schemes is one sensor in two sessions.
    let simulate = ["--rate-hz", "50", "--effect", "gyro_g_sensitivity=0.5", "--seed", "1"];
    for (file, scheme) in [(&first, "single"), (&second, "double")] {
        tumble(&[&["simulate", "-o", file, "--scheme", scheme], &simulate[..]].concat());
    }
    let story = tumble(&["diagnose", &first, &second, "--report", &page]);
    check_story(&story);
    let html = std::fs::read_to_string(format!("{page}/report.html")).expect("the page");
    check_page(&html);
    assert!(html.contains("&lt;first&gt;.csv"), "the file's name is told");
    let json = std::fs::read_to_string(format!("{page}/diagnosis.json")).expect("the object");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["format"], "tumble-diagnosis");
    assert_eq!(json["effects"][0]["id"], "gyro_g_sensitivity");
    let other = &json["effects"][0]["other_recordings"][0];
    let figure = |key: &str| other[key].as_f64().expect("a number");
    assert!(figure("after") < 0.1 * figure("before"), "{other}");
}
