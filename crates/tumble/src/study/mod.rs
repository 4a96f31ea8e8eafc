//! Studies: what the estimators reach over many simulated sessions, against what physics allows.
//!
//! A study is arithmetic over `tumble-sim`'s recordings and the device's own core; it neither prints nor parses.

pub mod blind;
pub mod bound;
pub mod injection;
pub mod limits;
pub mod navigation;
pub mod numbers;
pub mod paper;
pub mod parallel;
pub mod recordings;
pub mod summary;
pub mod trial;
pub mod truth;
