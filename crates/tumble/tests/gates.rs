//! Gates of the diagnosis: none on clean recordings, each on its own effect.
//!
//! The fast tests take a few seconds. The figures of the report come from
//! `cargo test -p tumble --release --test gates -- --ignored --nocapture`.

use std::collections::BTreeMap;
use std::time::Instant;

use tumble::calibrate::{Session, conditions};
use tumble::diagnose::gates::{Gated, Scene, examine};
use tumble::diagnose::twin::data::Raw;
use tumble::recording::{Inference, Metadata, Recording, Row, STANDARD_GRAVITY_MPS2, TurnStops};
use tumble_sim::scheme::Imperfection;
use tumble_sim::sensor::Sample;
use tumble_sim::{Effect, Scheme, SchemeConfig};

const SCHEMES: [Scheme; 4] = [Scheme::Double, Scheme::Single, Scheme::Quarter, Scheme::MultiPose { poses: 12 }];

/// Stamps with so many decimals, as a logger's text has them.
fn recording(samples: &[Sample], metadata: Metadata, decimals: i32) -> Recording {
    let unit = 10f64.powi(decimals);
    let rows = samples.iter().map(|sample| Row {
        t_s: (sample.t_s * unit).round() / unit,
        gyro_dps: sample.angular_rate_rad_s.map(f64::to_degrees).into(),
        accel_g: (sample.specific_force_mps2 / STANDARD_GRAVITY_MPS2).into(),
        temp_c: Some(sample.temperature_degc),
    });
    Recording { metadata, rows: rows.collect(), notices: Vec::new() }
}

fn gates(recording: &Recording) -> Gated {
    let inference = Inference::of(recording);
    let readings = recording.samples(&inference);
    let origin_s = recording.origin_s();
    let session = Session {
        readings: &readings,
        origin_s,
        lost: inference.missing(),
        conditions: conditions(&recording.metadata),
    };
    let tape = session.settle_at(1.0, &mut |_| {}).tape;
    let samples: Vec<Raw> = recording.rows.iter().map(|row| Raw::of(row, origin_s)).collect();
    examine(&Scene { recording, inference: &inference, samples: &samples, segments: tape.segments() })
}

/// A configuration of any kind that is clean: schemes, wobble up to 1°, by hand or fenced, 50 to 200 Hz, quantised or not,
/// stamps of four to six decimals, stated or not.
fn clean(seed: u64) -> (SchemeConfig, Metadata, i32) {
    let scheme = SCHEMES[(seed % 4) as usize];
    let mut config =
        if seed.is_multiple_of(3) { SchemeConfig::new(scheme, seed) } else { SchemeConfig::realistic(scheme, seed) };
    config = match seed / 4 % 6 {
        0 => config.with(Imperfection::Wobble(1.0)).with(Imperfection::ByHand(2.0)),
        1 => config.with(Imperfection::Clock(0.01)).with(Imperfection::Lever(0.05)),
        2 => Imperfection::ALL.iter().fold(config, |config, one| config.with(*one)),
        3 => config.with(Imperfection::CrookedBox(0.5)).with(Imperfection::TemperatureRamp(1.0)),
        _ => config,
    };
    config.averaged = [1, 2, 1, 4][(seed / 7 % 4) as usize];
    let fenced = config.turns_word() == "fenced";
    let mut metadata = Metadata { turns: fenced.then_some(TurnStops::Fenced), ..Metadata::default() };
    if seed % 5 < 3 {
        let ranges = config.world.sensor.quantisation;
        metadata.gyro_range_dps = ranges.map(|r| r.gyro_range_dps);
        metadata.accel_range_g = ranges.map(|r| r.accel_range_g);
    }
    (config, metadata, 4 + (seed % 3) as i32)
}

fn clean_gates(seed: u64) -> Gated {
    let (config, metadata, decimals) = clean(seed);
    let made = config.record().expect("a valid configuration");
    gates(&recording(&made.samples, metadata, decimals))
}

fn with_effect(word: &str, scheme: Scheme, seed: u64) -> Gated {
    let mut config = SchemeConfig::realistic(scheme, seed);
    config.effects = vec![Effect::parse(word).expect("a known effect")];
    let made = config.record().expect("a valid configuration");
    let metadata = Metadata {
        turns: Some(TurnStops::Fenced),
        gyro_range_dps: Some(2000.0),
        accel_range_g: Some(16.0),
        ..Metadata::default()
    };
    gates(&recording(&made.samples, metadata, 6))
}

fn words(gated: &Gated) -> String {
    let one = |found: &tumble::diagnose::diagnosis::Found| {
        let numbers: Vec<String> =
            found.parameters.iter().map(|p| format!("{}={:.4}±{:.4}{}", p.name, p.value, p.sigma, p.unit)).collect();
        format!(
            "{} [{:.0}] {} @{:?} {:.2}-{:.2}s",
            found.id,
            found.evidence,
            numbers.join(" "),
            found.place.channels,
            found.place.start_s,
            found.place.end_s
        )
    };
    gated.found.iter().map(one).chain(gated.stop.clone()).collect::<Vec<_>>().join("; ")
}

/// Effects with sizes that must be seen, on the scheme with turns both ways.
const PLAIN: [&str; 20] = [
    "timestamp_jitter=0.3",
    "timestamp_quantization=3",
    "dropped_samples=0.5",
    "duplicated_samples=0.5",
    "byte_tearing=30",
    "gyro_saturation=60",
    "accel_saturation=0.8",
    "gyro_coarse_quantization=0.4",
    "axis_mapping=1",
    "axis_mapping=2",
    "axis_mapping=3",
    "axis_mapping=4",
    "wrong_full_scale=2",
    "wrong_full_scale=0.5",
    "vibration_line=3",
    "table_rocking=0.05",
    "shock=1",
    "undersampling=20",
    "spin_axis_wobble=5",
    "duplicated_samples=6",
];

#[test]
fn clean_recordings_pass() {
    for seed in 0..12 {
        let gated = clean_gates(seed);
        assert!(gated.found.is_empty() && gated.stop.is_none(), "seed {seed}: {}", words(&gated));
    }
}

#[test]
fn each_effect_is_seen() {
    for word in PLAIN {
        let gated = with_effect(word, Scheme::Double, 3);
        let id = word.split('=').next().expect("an id");
        assert!(gated.found.iter().any(|found| found.id == id), "{word}: {}", words(&gated));
    }
}

#[test]
#[ignore = "minutes: figures for the report"]
fn false_alarms() {
    let count = std::env::var("RUNS").ok().and_then(|n| n.parse().ok()).unwrap_or(240);
    let (mut alarms, mut longest_s) = (BTreeMap::<String, usize>::new(), 0.0_f64);
    for seed in 0..count {
        let (config, metadata, decimals) = clean(1000 + seed);
        let made = config.record().expect("a valid configuration");
        let recording = recording(&made.samples, metadata, decimals);
        let start = Instant::now();
        let gated = gates(&recording);
        longest_s = longest_s.max(start.elapsed().as_secs_f64());
        for found in &gated.found {
            *alarms.entry(found.id.clone()).or_default() += 1;
        }
        if !gated.found.is_empty() || gated.stop.is_some() {
            println!("{} {:?} x{}: {}", 1000 + seed, config.scheme, config.averaged, words(&gated));
        }
    }
    println!("{count} clean recordings: {alarms:?}; the longest took {longest_s:.2} s with its segments");
}

#[test]
#[ignore = "minutes: figures for the report"]
fn detection() {
    let ladder: [(&str, &[f64]); 15] = [
        ("timestamp_jitter", &[0.1, 0.3, 1.0, 2.0]),
        ("timestamp_quantization", &[2.1, 3.0, 6.0, 8.0]),
        ("dropped_samples", &[0.1, 0.5, 2.0, 6.0]),
        ("duplicated_samples", &[0.1, 0.5, 2.0, 6.0]),
        ("byte_tearing", &[3.0, 10.0, 30.0]),
        ("gyro_saturation", &[30.0, 60.0, 80.0]),
        ("accel_saturation", &[0.5, 0.8, 1.0, 1.2]),
        ("gyro_coarse_quantization", &[0.2, 0.4, 2.0]),
        ("axis_mapping", &[1.0, 2.0, 3.0, 4.0]),
        ("wrong_full_scale", &[0.25, 0.5, 2.0, 4.0]),
        ("vibration_line", &[0.3, 1.0, 3.0, 10.0]),
        ("table_rocking", &[0.005, 0.01, 0.03, 0.08]),
        ("shock", &[0.1, 0.3, 1.0, 5.0]),
        ("undersampling", &[16.0, 20.0, 25.0]),
        ("spin_axis_wobble", &[1.0, 2.0, 3.0, 6.0]),
    ];
    let only = std::env::var("ONLY").unwrap_or_default();
    for (id, sizes) in ladder.into_iter().filter(|(id, _)| id.contains(&only)) {
        for size in sizes {
            let (mut seen, mut others) = (0, BTreeMap::<String, usize>::new());
            let runs = 8;
            for seed in 0..runs {
                let scheme = if seed % 2 == 0 { Scheme::Double } else { Scheme::Single };
                let gated = with_effect(&format!("{id}={size}"), scheme, 50 + seed);
                seen += usize::from(gated.found.iter().any(|found| found.id == id));
                if seed == 0 {
                    println!("    {}", words(&gated));
                }
                for found in gated.found.iter().filter(|found| found.id != id) {
                    *others.entry(found.id.clone()).or_default() += 1;
                }
            }
            println!("{id} {size}: {seen} of {runs}; besides {others:?}");
        }
    }
}

#[test]
#[ignore = "prints what fires on real recordings"]
fn real_recordings() {
    let Ok(folder) = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/recordings")) else {
        println!("SKIPPED: no ../shared/recordings beside this checkout");
        return;
    };
    let mut paths: Vec<_> =
        folder.flatten().map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == "csv")).collect();
    paths.sort();
    for path in paths {
        let recording = Recording::read(&path).expect("readable");
        let start = Instant::now();
        let gated = gates(&recording);
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        println!(
            "{name} ({:.2} s, {} repaired): {}",
            start.elapsed().as_secs_f64(),
            gated.repaired.len(),
            words(&gated)
        );
    }
}
