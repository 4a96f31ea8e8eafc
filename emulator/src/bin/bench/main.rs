//! `cargo xtask bench`: exact instruction counts of the core's hot spots on the emulated Cortex-M4F. The image is
//! `emulator/bench-firmware`.

use std::collections::HashMap;
use std::process::ExitCode;

mod feed;
mod growth;

use emulator::{AtRest, Board, BoardError, BoardOptions};
use tumble_core::estimate::two_step::filter::STEP_MULTIPLY_ADDS;

const USAGE: &str = "bench [--firmware ELF]

  --firmware ELF    the image of bench-firmware; otherwise the environment's TUMBLE_FIRMWARE";

/// What is measured: the function, in words, and the function that it is compared with.
const MEASURED: [(&str, &str, Option<&str>); 10] = [
    ("bench_paper_sparse", "15-state filter step, block-sparse f32", None),
    ("bench_paper_dense", "the same step, dense nalgebra 15x15", Some("bench_paper_sparse")),
    ("bench_paper_minikalman", "the same step, minikalman 0.8.1", Some("bench_paper_sparse")),
    ("bench_paper_observe", "15-state filter, observe one state", None),
    ("bench_propagate", "43-state filter, propagate", None),
    ("bench_observe_11", "43-state filter, observe, 11 coefficients", None),
    ("bench_observe_34", "43-state filter, observe, 34 coefficients", Some("bench_observe_11")),
    ("bench_observe_vector", "43-state filter, three observations at once", Some("bench_observe_11")),
    ("bench_estimate", "a whole estimate", None),
    ("bench_segmenter", "segmenter, one sample (10 s of rest and turn)", None),
];

/// Of `bench_nothing`: its `nop` and its return.
const INSTRUCTIONS_OF_NOTHING: u64 = 2;
/// Virtual seconds by which the image has certainly finished: an estimate takes some five.
const PATIENCE_S: f64 = 120.0;
const CORE_HZ: f64 = 96e6;
const SAMPLES_HZ: f64 = 200.0;

/// Instructions of each call, return included.
type Calls = HashMap<&'static str, Vec<u64>>;

fn main() -> ExitCode {
    let image = match image(std::env::args().skip(1)) {
        Ok(Some(image)) => image,
        Ok(None) => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        Err(wrong) => {
            eprintln!("bench: {wrong}\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let counted =
        std::fs::read(&image).map_err(|error| format!("{}: {error}", image.display())).and_then(|elf| measure(&elf));
    match counted {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("bench: {why}");
            ExitCode::FAILURE
        }
    }
}

fn measure(elf: &[u8]) -> Result<(), String> {
    let mut sessions = Vec::new();
    for factor in [0.5, 1.0, 2.0] {
        sessions.push(feed::Session::stretched(factor)?);
    }
    for poses in [9, 17, 34] {
        sessions.push(feed::Session::poses(poses)?);
    }
    let (calls, results) = count(elf, &sessions).map_err(|error| error.to_string())?;
    print(&calls);
    growth::states(mean(&calls["bench_paper_observe"]), mean(&calls["bench_observe_11"]), 11);
    growth::print(&sessions, &results, &calls["bench_estimate"])
}

fn image(mut words: impl Iterator<Item = String>) -> Result<Option<std::path::PathBuf>, String> {
    let mut image = std::env::var_os("TUMBLE_FIRMWARE").unwrap_or_default();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--firmware" => image = words.next().ok_or("--firmware needs a value")?.into(),
            "--help" | "-h" => return Ok(None),
            _ => return Err(format!("{word} is no option of the bench")),
        }
    }
    if image.is_empty() {
        return Err("which firmware? Give --firmware ELF, or run `cargo xtask bench`, which builds it".to_owned());
    }
    Ok(Some(image.into()))
}

fn count(elf: &[u8], sessions: &[feed::Session]) -> Result<(Calls, Vec<(u32, f32)>), BoardError> {
    let mut board = Board::new(elf, BoardOptions::default(), Box::new(AtRest))?;
    let feed = board.watch_function("bench_feed")?;
    let mut chunks = feed::chunks(sessions).into_iter();
    let at = board.symbol("BENCH_CHUNK")?;
    let end = board.watch_function("bench_end")?;
    let done = board.watch_function("bench_done")?;
    let mut names = HashMap::new();
    for name in MEASURED.iter().map(|measured| measured.0).chain(["bench_nothing"]) {
        names.insert(board.watch_function(name)?, name);
    }
    if names.len() != MEASURED.len() + 1 {
        return Err(BoardError("the compiler has merged two of the functions that are measured".to_owned()));
    }
    let mut calls = Calls::new();
    let mut results = Vec::new();
    let mut under_way = None;
    'running: loop {
        if board.now_s() >= PATIENCE_S {
            return Err(BoardError(format!("the image is not done after {PATIENCE_S} s, pc {:x?}", board.pc())));
        }
        board.run_to_arrival(PATIENCE_S)?;
        for arrival in board.take_arrivals() {
            if arrival.address == done {
                break 'running;
            }
            if arrival.address == feed {
                if calls.get("bench_estimate").map_or(0, Vec::len) > results.len() {
                    results.push(result(&board)?);
                }
                if !board.write_memory(at, chunks.next().unwrap_or_default()) {
                    return Err(BoardError("a chunk could not be handed over".to_owned()));
                }
            }
            if let Some(name) = names.get(&arrival.address) {
                under_way = Some((*name, arrival.instructions));
            } else if let (true, Some((name, began))) = (arrival.address == end, under_way.take()) {
                calls.entry(name).or_default().push(arrival.instructions - began);
            }
        }
    }
    if let Some((used, of)) = board.stack_high_water() {
        println!("stack: {used} of {of} bytes");
    }
    heed_segmenter(&board)?;
    Ok((less_the_measurement(calls)?, results))
}

/// What the last estimate came to: passes, and a gyroscope scale.
fn result(board: &Board) -> Result<(u32, f32), BoardError> {
    Ok((word(board, "BENCH_PASSES")?, f32::from_bits(word(board, "BENCH_SCALE")?)))
}

fn word(board: &Board, name: &str) -> Result<u32, BoardError> {
    let bytes = board.read_memory(board.symbol(name)?, 4).and_then(|bytes| <[u8; 4]>::try_from(bytes).ok());
    bytes.map(u32::from_le_bytes).ok_or_else(|| BoardError(format!("{name} cannot be read")))
}

/// The synthetic samples must have been taken for two rests and a whole turn, or something else was measured.
fn heed_segmenter(board: &Board) -> Result<(), BoardError> {
    match (word(board, "BENCH_STILLS")?, word(board, "BENCH_DEGREES")?) {
        (2, 359..=361) => Ok(()),
        (stills, degrees) => {
            Err(BoardError(format!("the segmenter saw {stills} stills and a turn of {degrees} degrees")))
        }
    }
}

/// Takes off what a call that does nothing is counted beyond its own instructions: the jump to `bench_end`.
fn less_the_measurement(mut calls: Calls) -> Result<Calls, BoardError> {
    let nothing = calls.remove("bench_nothing").and_then(|counts| counts.first().copied());
    let own = nothing.and_then(|count| count.checked_sub(INSTRUCTIONS_OF_NOTHING));
    let own = own.ok_or_else(|| BoardError("bench_nothing was not counted".to_owned()))?;
    calls.values_mut().flatten().for_each(|count| *count -= own);
    match MEASURED.iter().find(|measured| !calls.contains_key(measured.0)) {
        None => Ok(calls),
        Some(missing) => Err(BoardError(format!("{} was never called", missing.0))),
    }
}

fn mean(counts: &[u64]) -> f64 {
    counts.iter().sum::<u64>() as f64 / counts.len() as f64
}

fn print(calls: &Calls) {
    println!(
        "{:47}{:>7}{:>13}{:>9}{:>9}{:>8}",
        "instructions on the Cortex-M4F", "calls", "mean", "least", "most", "ratio"
    );
    for (name, words, reference) in MEASURED.into_iter().filter(|measured| measured.0 != "bench_estimate") {
        let counts = &calls[name];
        let (least, most) = (counts.iter().min().unwrap_or(&0), counts.iter().max().unwrap_or(&0));
        let ratio = reference.map_or(String::new(), |other| format!("{:.2}", mean(counts) / mean(&calls[other])));
        println!("{words:47}{:>7}{:>13.1}{least:>9}{most:>9}{ratio:>8}", counts.len(), mean(counts));
    }
    println!(
        "A sparse step needs {STEP_MULTIPLY_ADDS} multiply-adds: {:.1} instructions each.",
        mean(&calls["bench_paper_sparse"]) / STEP_MULTIPLY_ADDS as f64
    );
    let share = mean(&calls["bench_segmenter"]) * SAMPLES_HZ / CORE_HZ;
    println!("All at opt-level 3. The product is linked at \"s\", which takes more (bench-firmware/Cargo.toml).");
    println!("The segmenter's instructions at {SAMPLES_HZ:.0} Hz are {:.2} % of 96 million a second.", share * 100.0);
}
