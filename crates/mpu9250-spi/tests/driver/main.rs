//! The driver against a scripted bus (`embedded-hal-mock`): every byte it sends is in the script, or the test fails.

mod burst;
mod script;
mod self_test;
mod start;
