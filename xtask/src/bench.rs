//! `cargo xtask bench`: exact instructions of the image on the emulated core.

use crate::args::Arguments;
use crate::{Failure, emulator};

/// Leaves with the program's own exit status.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let image = emulator::image(arguments)?;
    emulator::program("bench", &image, &arguments.rest)
}
