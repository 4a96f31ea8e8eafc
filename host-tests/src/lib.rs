//! What several of the tests need.

pub mod sim;

use std::path::PathBuf;

/// A real recording by name, or none, said plainly, where the folder is absent: the recordings are no part of the
/// product, and a clone must test without them.
pub fn recording(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/recordings")).join(name);
    if path.exists() {
        return Some(path);
    }
    println!("SKIPPED: {name} is not in ../shared/recordings beside this checkout");
    None
}
