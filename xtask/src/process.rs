//! Running other programs, saying which when one fails.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The workspace's top folder: this package's parent, wherever the checkout stands.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// Where a workspace is built: where its owner says (`CARGO_TARGET_DIR`), else in its own `target`. Every build whose product is
/// looked for afterwards says it, so that no configuration sends the product elsewhere.
pub fn target(workspace: &str) -> PathBuf {
    let own = || root().join(workspace).join("target");
    let said = std::env::var_os("CARGO_TARGET_DIR").filter(|folder| !folder.is_empty());
    said.map_or_else(own, |folder| std::path::absolute(&folder).unwrap_or_else(|_| folder.into()))
}

/// The cargo that started this program, so that one toolchain builds everything.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The compiler beside it.
pub fn rustc() -> Command {
    Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

/// The command as a person would type it.
pub fn spelled(command: &Command) -> String {
    let mut words = Vec::new();
    if let Some(folder) = command.get_current_dir().and_then(|dir| dir.strip_prefix(root()).ok())
        && folder.components().next().is_some()
    {
        words.push(format!("cd {} &&", folder.display()));
    }
    for (key, value) in command.get_envs() {
        if let Some(value) = value {
            words.push(format!("{}={}", key.display(), quoted(&value.to_string_lossy())));
        }
    }
    let program = Path::new(command.get_program()).file_name().unwrap_or_default();
    words.push(program.to_string_lossy().into_owned());
    words.extend(command.get_args().map(|word| quoted(&word.to_string_lossy())));
    words.join(" ")
}

fn quoted(word: &str) -> String {
    if word.is_empty() || word.contains(char::is_whitespace) { format!("'{word}'") } else { word.into() }
}

/// Runs it with this program's own output; the exit status is passed on in the error.
pub fn run(command: &mut Command) -> Result<(), crate::Failure> {
    let status = command.status().map_err(|error| not_started(command, &error))?;
    if status.success() {
        return Ok(());
    }
    let code = status.code().and_then(|code| u8::try_from(code).ok()).filter(|code| *code != 0).unwrap_or(1);
    Err(crate::Failure { message: format!("`{}` ended with {status}", spelled(command)), status: code })
}

/// What it prints, or none if it cannot be run or fails.
pub fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()
}

fn not_started(command: &Command, error: &std::io::Error) -> crate::Failure {
    format!("`{}` could not be started: {error}", spelled(command)).into()
}
