//! `cargo xtask bench`: exact instructions of the core's hot spots and of whole estimates on the emulated
//! core, the host's time for a step, and the size of the firmware.

use std::path::PathBuf;

use crate::args::Arguments;
use crate::firmware::{self, Board};
use crate::process::{self, root};
use crate::toolchain::{self, TARGET, Toolchain};
use crate::{Failure, emulator, size};

/// Leaves with the program's own exit status.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let toolchain = toolchain::set_up(arguments.toolchain)?;
    eprintln!("set-up: the firmware is built with {}", toolchain.name());
    let image = image(toolchain)?;
    let product = firmware::build(toolchain, Board::BlackPill)?;
    emulator::program("bench", &image, &arguments.rest)?;
    println!("\nhost time of a step");
    process::run(process::cargo().current_dir(root()).args([
        "bench",
        "--quiet",
        "-p",
        "host-tests",
        "--bench",
        "filter",
    ]))?;
    size::report(Board::BlackPill, &product).map(drop)
}

/// Builds the image whose functions are counted, a workspace of its own.
fn image(toolchain: Toolchain) -> Result<PathBuf, Failure> {
    let mut build = toolchain.cargo_for_board("build");
    build.args(["--manifest-path", "emulator/bench-firmware/Cargo.toml"]);
    process::run(&mut build)?;
    Ok(toolchain.target().join(TARGET).join("release/bench-firmware"))
}
