//! The `minikalman` crate's step does the work of ours: what `cargo xtask bench` compares is the same filter.

#[path = "../../emulator/bench-firmware/src/rival.rs"]
mod rival;

use nalgebra::{SMatrix, Vector3};
use tumble_core::estimate::two_step::dense;
use tumble_core::estimate::two_step::filter::{Covariance, Filter, Motion, State};

#[test]
fn it_comes_to_the_same_state_and_covariance() {
    let sigma = [1e-2, 1e-2, 1e-3, 0.1, 0.1, 0.1, 0.02, 0.02, 0.02, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2];
    let state = State::<f32>::from_fn(|i, _| 0.3 * i as f32 * sigma[i]);
    let covariance = Covariance::from_diagonal(&State::from_fn(|i, _| sigma[i] * sigma[i]));
    let motion = Motion {
        tau_s: 0.08,
        drive: SMatrix::from_fn(|i, j| 0.05 - 0.007 * i as f32 - 0.004 * j as f32),
        impulse: Vector3::new(0.02, -0.01, 0.8),
        attitude_variance: 1e-6,
        velocity_variance: 3e-5,
    };
    let (position, variance) = (Vector3::new(1e-3, -2e-3, 3e-4), 1e-4);
    let mut ours = Filter::new(state, covariance);
    let mut theirs =
        rival::filter(&state, &covariance, &dense::transition(&motion), &dense::process(&motion), variance);
    for _ in 0..20 {
        dense::sparse_step(&mut ours, &motion, &position, variance);
        theirs(rival::Ask::Step(&position));
    }
    let (mut state, mut covariance) = (State::zeros(), Covariance::zeros());
    theirs(rival::Ask::Read(&mut state, &mut covariance));
    for i in 0..sigma.len() {
        // A variance loses 6e-8 of what it was at each of 80 updates, of either filter; correlations make that a few times more.
        let tolerance = |j: usize| 1e-4 * (ours.covariance()[(i, i)] * ours.covariance()[(j, j)]).sqrt();
        assert!((state[i] - ours.state()[i]).abs() < 1e-3 * ours.covariance()[(i, i)].sqrt(), "state {i}");
        for j in 0..sigma.len() {
            let (a, b) = (covariance[(i, j)], ours.covariance()[(i, j)]);
            assert!((a - b).abs() < tolerance(j), "covariance {i}, {j}: {a} against {b}");
        }
    }
    // It has learnt something, or nothing was compared.
    assert!(covariance[(3, 3)] < 0.5 * sigma[3] * sigma[3]);
}
