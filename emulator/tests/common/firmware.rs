//! The product's firmware, from the environment or built through cargo once a test run.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const TARGET: &str = "thumbv7em-none-eabihf";

fn built() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository");
    let target = root.join("target");
    let status = Command::new(env!("CARGO"))
        .args(["build", "--release", "--package", "tumble-firmware", "--target", TARGET])
        .args(["--no-default-features", "--features", "black-pill", "--target-dir"])
        .arg(&target)
        .current_dir(root)
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .status()
        .expect("cargo starts");
    assert!(status.success(), "the firmware does not build; is the target {TARGET} installed?");
    target.join(TARGET).join("release/tumble-firmware")
}

/// As `cargo xtask` built it (`TUMBLE_FIRMWARE`), or built now.
pub fn elf() -> &'static [u8] {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    ELF.get_or_init(|| {
        let path = std::env::var_os("TUMBLE_FIRMWARE").map_or_else(built, PathBuf::from);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    })
}
