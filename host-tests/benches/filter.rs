//! The 15-state filter's step, sparse against dense nalgebra and the `minikalman` crate, in the same run: `cargo bench -p host-tests --bench filter`.
//!
//! Times on a host vary by some per cent; on the emulated core the same two functions, `dense::step` and
//! `dense::sparse_step` (never inlined), can be counted in instructions.

#[path = "../../emulator/bench-firmware/src/rival.rs"]
mod rival;

use std::hint::black_box;
use std::time::Instant;

use nalgebra::{SMatrix, Vector3};
use tumble_core::estimate::six_face::Real;
use tumble_core::estimate::two_step::dense;
use tumble_core::estimate::two_step::filter::{Covariance, Filter, Motion, STEP_MULTIPLY_ADDS, State};

/// Steps in one measurement; the best of [`ROUNDS`] counts.
const STEPS: u32 = 20_000;
const ROUNDS: u32 = 15;

fn convert<T: Real>(value: f64) -> T {
    nalgebra::convert(value)
}

fn motion<T: Real>() -> Motion<T> {
    Motion {
        tau_s: convert(0.08),
        drive: SMatrix::from_fn(|i, j| convert(0.05 * ((3 * i + 2 * j) as f64).sin())),
        impulse: Vector3::new(convert(0.02), convert(-0.01), convert(0.8)),
        attitude_variance: convert(1e-9),
        velocity_variance: convert(3e-7),
    }
}

/// Nanoseconds a call.
fn time(mut step: impl FnMut()) -> f64 {
    let round = |_| {
        let start = Instant::now();
        (0..STEPS).for_each(|_| step());
        start.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS)
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}

fn compare<T: Real>(name: &str) {
    let (state, covariance) = (State::<T>::zeros(), Covariance::<T>::identity() * convert::<T>(1e-4));
    let (motion, position, variance) = (motion::<T>(), Vector3::repeat(convert::<T>(1e-4)), convert::<T>(1e-6));
    let (transition, process) = (dense::transition(&motion), dense::process(&motion));
    let mut filter = Filter::new(state, covariance);
    let sparse = time(|| {
        dense::sparse_step(black_box(&mut filter), black_box(&motion), &position, variance);
    });
    let mut now = (state, covariance);
    let dense = time(|| {
        let next = dense::step(&now.0, &now.1, black_box(&transition), &process, &position, variance);
        now = black_box(next.unwrap_or((state, covariance)));
    });
    println!("{name}: sparse {sparse:.0} ns, dense {dense:.0} ns, {:.1} times", dense / sparse);
}

/// The `minikalman` crate's step against ours, both `f32`.
fn compare_with_minikalman() {
    let (state, covariance) = (State::<f32>::zeros(), Covariance::<f32>::identity() * 1e-4);
    let (motion, position, variance) = (motion::<f32>(), Vector3::repeat(1e-4f32), 1e-6);
    let (transition, process) = (dense::transition(&motion), dense::process(&motion));
    let mut filter = Filter::new(state, covariance);
    let sparse = time(|| {
        dense::sparse_step(black_box(&mut filter), black_box(&motion), &position, variance);
    });
    let mut rival = rival::filter(&state, &covariance, &transition, &process, variance);
    let theirs = time(|| black_box(&mut rival)(rival::Ask::Step(black_box(&position))));
    println!("f32: sparse {sparse:.0} ns, minikalman 0.8.1 {theirs:.0} ns, {:.1} times", theirs / sparse);
}

fn main() {
    println!("{STEP_MULTIPLY_ADDS} multiply-adds a sparse step");
    compare::<f32>("f32");
    compare::<f64>("f64");
    compare_with_minikalman();
}
