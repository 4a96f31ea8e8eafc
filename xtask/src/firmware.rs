//! Building the firmware image.

use std::path::PathBuf;

use crate::Failure;
use crate::process::run;
use crate::toolchain::{TARGET, Toolchain};

/// A board the firmware knows; each is a feature of the root package.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Board {
    /// STM32F411CE, the one that is emulated.
    BlackPill,
    /// NUCLEO-F411RE.
    Nucleo,
}

impl Board {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::BlackPill, Self::Nucleo];

    /// The feature's name.
    pub fn feature(self) -> &'static str {
        match self {
            Self::BlackPill => "black-pill",
            Self::Nucleo => "nucleo-f411re",
        }
    }
}

/// Arguments that select the firmware for a board.
pub fn selection(board: Board) -> [&'static str; 5] {
    ["--package", "tumble-firmware", "--no-default-features", "--features", board.feature()]
}

/// Builds it; the path of the image. The image of the board built last stands there, so the Black Pill comes last.
pub fn build(toolchain: Toolchain, board: Board) -> Result<PathBuf, Failure> {
    run(toolchain.cargo_for_board("build").args(selection(board)))?;
    Ok(toolchain.target().join(TARGET).join("release/tumble-firmware"))
}
