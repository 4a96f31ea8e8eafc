//! The core's hot spots, each called many times: `emulator/src/bin/bench.rs` counts from the arrival at a function named
//! `bench_…` to the next arrival at `bench_end`. What a call needs is built outside of it.

#![no_std]
#![no_main]

mod estimate;
mod motion;
mod rival;

use core::arch::asm;
use core::hint::black_box;

use nalgebra::{SMatrix, Vector3};
use tumble_core::estimate::filter::{AttitudeDrive, Filter};
use tumble_core::estimate::state::{Block, Row, Rows, STATES};
use tumble_core::estimate::two_step::{dense, filter as paper};

/// Calls of what always does the same work.
const REPETITIONS: usize = 100;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // The host misses `bench_done`.
    loop {}
}

/// Where a measured call ends.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn bench_end() {
    // SAFETY: it does nothing. The name keeps functions that are alike from being merged.
    unsafe { asm!("nop @ end") }
}

/// Two instructions, the return included: what is counted beyond them is the measurement's own.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn bench_nothing() {
    // SAFETY: as above.
    unsafe { asm!("nop @ nothing") }
}

#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn bench_done() -> ! {
    loop {
        // SAFETY: as above.
        unsafe { asm!("nop @ done") }
    }
}

struct Paper {
    filter: paper::Filter<f32>,
    motion: paper::Motion<f32>,
    transition: paper::Covariance<f32>,
    process: paper::Covariance<f32>,
    position: Vector3<f32>,
    variance: f32,
}

impl Paper {
    fn new() -> Self {
        let sigma = [1e-4, 1e-4, 1e-5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2];
        let state = paper::State::from_fn(|i, _| 1e-3 * i as f32 * sigma[i]);
        let variances = paper::State::from_fn(|i, _| sigma[i] * sigma[i]);
        let motion = paper::Motion {
            tau_s: 0.08,
            drive: SMatrix::from_fn(|i, j| 0.05 - 0.007 * i as f32 - 0.004 * j as f32),
            impulse: Vector3::new(0.02, -0.01, 0.8),
            attitude_variance: 1e-9,
            velocity_variance: 3e-7,
        };
        Self {
            filter: paper::Filter::new(state, paper::Covariance::from_diagonal(&variances)),
            transition: dense::transition(&motion),
            process: dense::process(&motion),
            motion,
            position: Vector3::new(1e-4, -2e-4, 3e-5),
            variance: 1e-6,
        }
    }
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_paper_sparse(paper: &mut Paper) {
    dense::sparse_step(&mut paper.filter, &paper.motion, &paper.position, paper.variance);
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_paper_dense(paper: &Paper) {
    let (state, covariance) = (paper.filter.state(), paper.filter.covariance());
    let stepped = dense::step(state, covariance, &paper.transition, &paper.process, &paper.position, paper.variance);
    black_box(&stepped);
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_paper_minikalman(rival: &mut dyn FnMut(rival::Ask<'_>), position: &Vector3<f32>) {
    rival(rival::Ask::Step(position));
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_observe_11(filter: &mut Filter, row: &Row) {
    black_box(&filter.observe(row, 1e-3, 1e-4));
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_observe_34(filter: &mut Filter, row: &Row) {
    black_box(&filter.observe(row, -2e-3, 3e-4));
}

/// Of one state, as the step does it three times.
#[unsafe(no_mangle)]
#[inline(never)]
fn bench_paper_observe(filter: &mut paper::Filter<f32>) {
    black_box(&filter.observe(paper::POSITION, 1e-4, 1e-6));
}

/// Three observations at once, as the product takes in gravity in a turn: 34 columns.
#[unsafe(no_mangle)]
#[inline(never)]
fn bench_observe_vector(filter: &mut Filter, rows: &Rows<3>) {
    black_box(&filter.observe_vector(rows, &Vector3::new(1e-3, -2e-3, 3e-3), 1e-4));
}

#[unsafe(no_mangle)]
#[inline(never)]
fn bench_propagate(filter: &mut Filter, drive: &AttitudeDrive) {
    filter.propagate(drive, 1e-9);
}

fn prior() -> Filter {
    let mut filter = Filter::default();
    // Offsets count from a block's start, and φ's is 0.
    for state in 0..STATES {
        filter.reset(Block::Attitude, state, 0.0, 0.01 + 1e-4 * state as f32);
    }
    filter
}

/// A row with this many coefficients, spread over the state.
fn row(coefficients: usize) -> Row {
    (0..coefficients)
        .fold(Row::new(), |row, k| row.with(Block::Attitude, k * STATES / coefficients, 1.0 - 0.05 * k as f32))
}

fn rows() -> Rows<3> {
    let mut rows = Rows::new();
    for k in 0..34 {
        let k = k as f32;
        rows.set(Block::Attitude, (k * 1.25) as usize, [1.0 - 0.05 * k, 0.02 * k, 0.3 - 0.01 * k]);
    }
    rows
}

fn paper_step() {
    let mut data = Paper::new();
    let (state, covariance) = (data.filter.state(), data.filter.covariance());
    let mut rival = rival::filter(state, covariance, &data.transition, &data.process, data.variance);
    let data = black_box(&mut data);
    for _ in 0..REPETITIONS {
        bench_paper_minikalman(&mut rival, &data.position);
        bench_end();
        bench_paper_dense(data);
        bench_end();
        // Of the same covariance, and on to the next.
        bench_paper_sparse(data);
        bench_end();
        bench_paper_observe(&mut data.filter);
        bench_end();
    }
}

fn device_filter() {
    let mut filter = prior();
    let drive = AttitudeDrive {
        correction: SMatrix::from_fn(|i, j| 0.1 * i as f32 - 0.03 * j as f32),
        bias: SMatrix::from_fn(|i, j| 0.02 * j as f32 - 0.05 * i as f32),
        earth: -0.08,
    };
    let (short, long, three) = (row(11), row(34), rows());
    let (filter, drive) = (black_box(&mut filter), black_box(&drive));
    let (short, long, three) = (black_box(&short), black_box(&long), black_box(&three));
    for _ in 0..REPETITIONS {
        bench_propagate(filter, drive);
        bench_end();
        bench_observe_11(filter, short);
        bench_end();
        bench_observe_34(filter, long);
        bench_end();
        bench_observe_vector(filter, three);
        bench_end();
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    bench_nothing();
    bench_end();
    paper_step();
    device_filter();
    motion::whole_turn();
    estimate::sessions();
    bench_done()
}
