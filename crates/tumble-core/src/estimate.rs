//! From the tape to numbers with sigmas. `docs/method.md` has the equations.

pub mod closures;
pub mod conditions;
pub mod covariance;
pub mod device;
pub mod facets;
pub mod filter;
pub mod group;
pub mod hinge;
pub mod judge;
pub mod likelihood;
pub mod model;
pub mod moves;
pub mod noise;
pub mod normal;
pub mod prior;
pub mod resting;
mod result;
pub mod scatter;
pub mod six_face;
pub mod stand;
pub mod start;
pub mod state;
pub mod sums;
pub mod turn_noise;
pub mod two_step;
pub mod walk;
pub mod wander;
pub mod wobble;

pub use conditions::Conditions;
pub use device::{Breakdown, Estimate, Estimator, PARAMETERS, Progress};
pub use noise::Noise;
