//! The host tool's parts: recordings, the calibration run as the board does it, and what comes out.
//!
//! The mathematics lives in `tumble-core`; here is what needs files, a terminal and a heap.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod calibrate;
pub mod cli;
pub mod conceal;
pub mod diagnose;
pub mod export;
pub mod faults;
pub mod inject;
pub mod integrate;
pub mod omissions;
pub mod output;
pub mod recording;
pub mod reference;
pub mod serial;
pub mod settle;
pub mod simulate;
pub mod study;
pub mod widen;
