//! The 15-state filter's step by the `minikalman` crate: the same F, Q, H and R as `two_step::dense::step`, all three components of
//! position at once. Its matrices are dense, and F stays the same from step to step, so that nothing is counted for building it.
//!
//! `host-tests/tests/rival.rs` takes in this same file and checks that both come to the same state and covariance.

use minikalman::prelude::*;
use minikalman::regular::{RegularKalmanBuilder, RegularObservationBuilder};
use nalgebra::Vector3;
use tumble_core::estimate::two_step::filter::{Covariance, POSITION, STATES, State};

const OBSERVED: usize = 3;

/// What is asked of it: its own type is too long to be written.
pub enum Ask<'a> {
    /// A prediction, and this position.
    Step(&'a Vector3<f32>),
    /// Where it stands: for the test.
    #[allow(dead_code, reason = "the board's bench does not ask")]
    Read(&'a mut State<f32>, &'a mut Covariance<f32>),
}

/// From a state and a covariance.
#[allow(non_snake_case, reason = "its macros are named so")]
pub fn filter(
    state: &State<f32>,
    covariance: &Covariance<f32>,
    transition: &Covariance<f32>,
    process: &Covariance<f32>,
    variance: f32,
) -> impl FnMut(Ask<'_>) + use<> {
    impl_buffer_x!(mut x, STATES, f32, 0.0);
    impl_buffer_A!(mut a, STATES, f32, 0.0);
    impl_buffer_P!(mut p, STATES, f32, 0.0);
    impl_buffer_Q_direct!(mut q, STATES, f32, 0.0);
    impl_buffer_temp_x!(mut temp_x, STATES, f32, 0.0);
    impl_buffer_temp_P!(mut temp_p, STATES, f32, 0.0);
    impl_buffer_z!(mut z, OBSERVED, f32, 0.0);
    impl_buffer_H!(mut h, OBSERVED, STATES, f32, 0.0);
    impl_buffer_R!(mut r, OBSERVED, f32, 0.0);
    impl_buffer_y!(mut y, OBSERVED, f32, 0.0);
    impl_buffer_S!(mut s, OBSERVED, f32, 0.0);
    impl_buffer_K!(mut k, STATES, OBSERVED, f32, 0.0);
    impl_buffer_temp_S_inv!(mut temp_s_inv, OBSERVED, f32, 0.0);
    impl_buffer_temp_HP!(mut temp_hp, OBSERVED, STATES, f32, 0.0);
    impl_buffer_temp_PHt!(mut temp_pht, STATES, OBSERVED, f32, 0.0);
    impl_buffer_temp_KHP!(mut temp_khp, STATES, f32, 0.0);
    for i in 0..STATES {
        x.as_matrix_mut().set_at(i, 0, state[i]);
        for j in 0..STATES {
            a.as_matrix_mut().set_at(i, j, transition[(i, j)]);
            p.as_matrix_mut().set_at(i, j, covariance[(i, j)]);
            q.as_matrix_mut().set_at(i, j, process[(i, j)]);
        }
    }
    for axis in 0..OBSERVED {
        h.as_matrix_mut().set_at(axis, POSITION + axis, 1.0);
        r.as_matrix_mut().set_at(axis, axis, variance);
    }
    let mut filter = RegularKalmanBuilder::new::<STATES, f32>(a, x, p, q, temp_x, temp_p);
    let mut observation = RegularObservationBuilder::new::<STATES, OBSERVED, f32>(
        h, z, r, y, s, k, temp_s_inv, temp_hp, temp_pht, temp_khp,
    );
    move |ask| match ask {
        Ask::Step(position) => {
            filter.predict();
            for axis in 0..OBSERVED {
                observation.measurement_vector_mut().as_matrix_mut().set_at(axis, 0, position[axis]);
            }
            filter.correct(&mut observation);
        }
        Ask::Read(state, covariance) => {
            for i in 0..STATES {
                state[i] = filter.state_vector().as_matrix().get_at(i, 0);
                for j in 0..STATES {
                    covariance[(i, j)] = filter.estimate_covariance().as_matrix().get_at(i, j);
                }
            }
        }
    }
}
