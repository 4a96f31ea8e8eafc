//! The search: every candidate against one nominal fit, with thresholds that chance on this very recording sets.

mod before;
pub mod bench;
pub mod family;
pub mod generic;
pub mod ledger;
mod memory;
pub mod null;
pub mod restless;
pub mod select;
pub mod shares;
pub mod sharpen;
mod slide;
pub mod unknown;
pub mod wandering;
