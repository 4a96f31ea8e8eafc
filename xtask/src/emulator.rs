//! The emulated board: a workspace of its own, started here with the firmware's image.
//!
//! Its programs and tests find the image by the environment variable [`FIRMWARE`]. Its dependency `rigless` declares a newer
//! compiler than it needs, hence `--ignore-rust-version`; cargo has no setting for it.

use std::path::Path;
use std::process::Command;

use crate::args::Arguments;
use crate::firmware::{self, Board};
use crate::process::{cargo, root, run, target};
use crate::{Failure, toolchain};

/// Path of the firmware's ELF file.
pub const FIRMWARE: &str = "TUMBLE_FIRMWARE";

/// `cargo SUBCOMMAND` in the emulator's workspace.
pub fn cargo_in_emulator(subcommand: &str) -> Command {
    let mut command = cargo();
    command.current_dir(root().join("emulator")).args([subcommand, "--ignore-rust-version"]);
    command
}

/// `cargo xtask demo`: leaves with the demo's own exit status.
pub fn demo(arguments: &Arguments) -> Result<(), Failure> {
    let image = image(arguments)?;
    program("demo", &image, &arguments.rest)
}

/// Builds the image that is emulated.
pub fn image(arguments: &Arguments) -> Result<std::path::PathBuf, Failure> {
    let toolchain = toolchain::set_up(arguments.toolchain)?;
    // Standard output belongs to the demo, which may print JSON there.
    eprintln!("set-up: the firmware is built with {}", toolchain.name());
    firmware::build(toolchain, Board::BlackPill)
}

/// Builds and runs one of the emulator's programs, passing on its exit status. The build is apart, so that a build that
/// fails is told from a story that fails.
pub fn program(name: &str, image: &Path, words: &[String]) -> Result<(), Failure> {
    let target = target("emulator");
    run(cargo_in_emulator("build").args(["--bin", name]).arg("--target-dir").arg(&target))?;
    let binary = target.join("debug").join(name);
    run(Command::new(binary).env(FIRMWARE, image).args(words))
}
