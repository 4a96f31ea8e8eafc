//! When recording and simulation differ: find where, say which physics was left out, model it, and prove it.

pub mod catalogue;
pub mod diagnosis;
pub mod gates;
pub mod prepare;
pub mod search;
pub mod twin;
