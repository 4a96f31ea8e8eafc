//! When recording and simulation differ: find where, say which physics was left out, model it, and prove it.

mod answer;
pub mod carry;
pub mod catalogue;
pub mod diagnosis;
pub mod exhibits;
pub mod findings;
pub mod gates;
mod held_out;
pub mod intake;
mod judge;
mod limits;
mod numbers;
mod options;
mod outcome;
mod posterior;
pub mod prepare;
pub mod promise;
pub mod report;
mod run;
pub mod search;
mod second;
mod settings;
pub mod transfer;
pub mod twin;
mod walk_limit;

pub use options::Options;
pub use outcome::Outcome;
pub use run::{Progress, diagnose};
