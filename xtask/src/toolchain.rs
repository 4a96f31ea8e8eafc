//! Set-up: whatever it takes to compile for the board's Cortex-M4F on this machine.
//!
//! The rule is a rustup target. Where there is no rustup, or it cannot download, Debian's security packages bring a
//! compiler new enough (1.96) with its library's sources but no precompiled library for the board: `core` is then built
//! from source (`-Zbuild-std`, which a stable compiler allows under `RUSTC_BOOTSTRAP=1`) and linked by `ld.lld`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::Failure;
use crate::process::{self, output, root, run};

/// The board's target: Cortex-M4 with its single-precision FPU.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// Everything the fallback needs.
const DEBIAN_PACKAGES: [&str; 4] = ["rustc-web", "cargo-web", "rust-web-src", "lld"];
const DEBIAN_FILES: [&str; 4] =
    ["/usr/bin/rustc", "/usr/bin/cargo", "/usr/lib/rustlib/src/rust/library/core/Cargo.toml", "/usr/bin/ld.lld"];

/// What the person asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The rustup target if it is to be had, else Debian's packages.
    Auto,
    /// Debian's packages.
    Debian,
}

/// How firmware is compiled here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toolchain {
    /// The running toolchain has the target.
    Native,
    /// Debian's, with `core` from source.
    Debian,
}

/// Makes sure that firmware can be built.
pub fn set_up(choice: Choice) -> Result<Toolchain, Failure> {
    if choice == Choice::Auto {
        if has_target() {
            return Ok(Toolchain::Native);
        }
        eprintln!("set-up: the {TARGET} target is not installed; asking rustup for it");
        if run(Command::new("rustup").args(["target", "add", TARGET])).is_ok() && has_target() {
            return Ok(Toolchain::Native);
        }
        eprintln!("set-up: rustup could not add it; falling back on Debian's packages");
    }
    set_up_debian()
}

/// Does the running toolchain bring the compiled `core` of the target?
fn has_target() -> bool {
    let folder = output(process::rustc().args(["--print", "target-libdir", "--target", TARGET]));
    folder.is_some_and(|folder| Path::new(folder.trim()).is_dir())
}

fn set_up_debian() -> Result<Toolchain, Failure> {
    if !debian_is_complete() {
        install_debian()?;
    }
    if debian_is_complete() {
        return Ok(Toolchain::Debian);
    }
    let missing: Vec<_> = DEBIAN_FILES.iter().filter(|file| !Path::new(file).exists()).copied().collect();
    Err(format!("Debian's packages are installed but these files are not there: {}", missing.join(", ")).into())
}

fn debian_is_complete() -> bool {
    DEBIAN_FILES.iter().all(|file| Path::new(file).exists())
}

fn install_debian() -> Result<(), Failure> {
    let packages = DEBIAN_PACKAGES.join(" ");
    let is_root = output(Command::new("id").arg("-u")).is_some_and(|id| id.trim() == "0");
    if !is_root {
        return Err(format!(
            "this machine cannot build for the board yet. Either\n  rustup target add {TARGET}\nor, on Debian 12,\n  \
             sudo apt-get update\n  sudo apt-get install --no-install-recommends {packages}\nthen start again"
        )
        .into());
    }
    eprintln!("set-up: apt-get install {packages}");
    run(Command::new("apt-get").args(["update", "-qq"]))?;
    run(Command::new("apt-get")
        .env("DEBIAN_FRONTEND", "noninteractive")
        .args(["install", "-y", "-qq", "--no-install-recommends"])
        .args(DEBIAN_PACKAGES))
}

impl Toolchain {
    /// `cargo SUBCOMMAND --release --target …` for the board, to be followed by a package and its features.
    pub fn cargo_for_board(self, subcommand: &str) -> Command {
        let mut command = match self {
            Self::Native => process::cargo(),
            Self::Debian => debian_cargo(),
        };
        command.current_dir(root()).args([subcommand, "--release", "--target", TARGET]);
        command.arg("--target-dir").arg(self.target());
        if self == Self::Debian {
            command.arg("-Zbuild-std=core");
        }
        command
    }

    /// Where its builds go: Debian's to a folder of their own, so that changing to and fro rebuilds nothing.
    pub fn target(self) -> PathBuf {
        match self {
            Self::Native => process::target(""),
            Self::Debian => process::target("").join("debian"),
        }
    }

    /// In a word for the person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Native => "rustup's target",
            Self::Debian => "Debian's rustc-web, core built from source",
        }
    }
}

/// By full path, and with the compiler named, because rustup's proxies may stand first in PATH.
fn debian_cargo() -> Command {
    let mut cargo = Command::new("/usr/bin/cargo");
    cargo
        .env("RUSTC", "/usr/bin/rustc")
        .env("RUSTDOC", "/usr/bin/rustdoc")
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", "ld.lld") // Debian's compiler has no rust-lld
        .env_remove("RUSTUP_TOOLCHAIN");
    cargo
}
