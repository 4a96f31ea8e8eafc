//! `cargo xtask test`: every check and test, the quick ones first; the first that fails ends the run.

use std::path::Path;

use crate::args::Arguments;
use crate::emulator::{FIRMWARE, cargo_in_emulator, program};
use crate::firmware::{self, Board, selection};
use crate::process::{cargo, root, run};
use crate::report::Steps;
use crate::toolchain::{self, TARGET, Toolchain};
use crate::{Failure, size};

/// Runs all steps.
pub fn run_all(arguments: &Arguments) -> Result<(), Failure> {
    let mut steps = Steps::new();
    let toolchain = steps.step("set-up", || toolchain::set_up(arguments.toolchain))?;
    println!("firmware is built with {}", toolchain.name());
    style(&mut steps)?;
    host(&mut steps)?;
    let image = board(&mut steps, toolchain)?;
    in_the_loop(&mut steps, toolchain, &image)?;
    steps.print(None);
    Ok(())
}

/// Formatting of all workspaces, before anything is compiled.
fn style(steps: &mut Steps) -> Result<(), Failure> {
    for folder in ["", "emulator", "emulator/probe-firmware", "emulator/bench-firmware"] {
        let name = format!("format of {}", if folder.is_empty() { "the workspace" } else { folder });
        steps.step(&name, || run(cargo().current_dir(root().join(folder)).args(["fmt", "--all", "--check"])))?;
    }
    Ok(())
}

fn host(steps: &mut Steps) -> Result<(), Failure> {
    let in_root = |subcommand: &str| {
        let mut command = cargo();
        command.current_dir(root()).args([subcommand, "--workspace"]);
        command
    };
    // `--locked`: a lock file behind its manifest is a defect of the clone, not something to mend in passing.
    steps.step("clippy on the host", || {
        run(in_root("clippy").args(["--locked", "--all-targets", "--", "-D", "warnings"]))
    })?;
    steps.step("documentation", || {
        // The firmware's modules exist only where it is compiled for the board.
        run(in_root("doc").args(["--no-deps", "--exclude", "tumble-firmware"]).env("RUSTDOCFLAGS", "-D warnings"))
    })?;
    steps.step("tests on the host", || run(&mut in_root("test")))
}

/// The firmware for both boards; the image for the emulated one.
fn board(steps: &mut Steps, toolchain: Toolchain) -> Result<std::path::PathBuf, Failure> {
    for board in Board::ALL {
        let name = format!("clippy on the firmware, {}", board.feature());
        match toolchain {
            Toolchain::Native => steps.step(&name, || {
                run(toolchain.cargo_for_board("clippy").args(selection(board)).args(["--", "-D", "warnings"]))
            })?,
            Toolchain::Debian => steps.skip(&name, "Debian's compiler comes without clippy"),
        }
    }
    steps.step("documentation of the firmware", || {
        let mut doc = toolchain.cargo_for_board("doc");
        run(doc.args(selection(Board::BlackPill)).arg("--no-deps").env("RUSTDOCFLAGS", "-D warnings"))
    })?;
    let mut image = std::path::PathBuf::new();
    for board in Board::ALL.into_iter().rev() {
        let name = format!("firmware and its size, {}", board.feature());
        image = steps.step(&name, || {
            let image = firmware::build(toolchain, board)?;
            size::report(board, &image).map(|_| image)
        })?;
    }
    Ok(image)
}

fn in_the_loop(steps: &mut Steps, toolchain: Toolchain, image: &Path) -> Result<(), Failure> {
    steps.step("clippy on the emulator", || {
        run(cargo_in_emulator("clippy").args(["--locked", "--all-targets", "--", "-D", "warnings"]))
    })?;
    let mut tests = cargo_in_emulator("test");
    tests.env(FIRMWARE, image);
    match toolchain {
        Toolchain::Native => steps.step("tests of the emulated board", || run(&mut tests))?,
        Toolchain::Debian => {
            let why = format!("its probe firmware is built with the {TARGET} target of the running toolchain");
            steps.skip("tests of the emulated board", &why);
        }
    }
    let seed = ["--seed", "1"].map(String::from);
    steps.step("the demo's story", || program("demo", image, &seed))?;
    steps.step("the demo's story, by hand", || program("demo", image, &["--seed", "2", "--by-hand"].map(String::from)))
}
