//! What a calibration looks like outside: the contract's JSON ([`Report`]) and a page for the terminal ([`table`]).

pub mod paper;
mod report;
pub mod study;
pub mod table;

pub use report::{
    Covariance, FitReport, GyroscopeReport, Matrix, Report, SegmentReport, TriadReport, Vector, covariance_order,
};
