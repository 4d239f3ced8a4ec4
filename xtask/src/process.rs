//! Child processes.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::Context;
use serde_json::Value;

/// The cargo that runs this task.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The root of the workspace: the parent of this package's folder.
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_owned()
}

/// Runs a command and gives its exit status on; 1 where it was ended by a signal.
pub fn run(command: &mut Command) -> anyhow::Result<ExitCode> {
    let status =
        command.status().with_context(|| format!("cannot start {}", command.get_program().display()))?;
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Becomes another program, whose exit status is then this one's: a Ctrl-C is its own to answer, and the shell waits for it.
#[cfg(unix)]
pub fn hand_over(command: &mut Command) -> anyhow::Result<ExitCode> {
    use std::os::unix::process::CommandExt;
    let error = command.exec();
    Err(error).with_context(|| format!("cannot start {}", command.get_program().display()))
}

/// As [`run`], where a process cannot become another.
#[cfg(not(unix))]
pub fn hand_over(command: &mut Command) -> anyhow::Result<ExitCode> {
    run(command)
}

/// The packages of the workspace as cargo reads their manifests; `options` are those of `cargo metadata`.
pub fn metadata(options: &[&str]) -> anyhow::Result<Value> {
    let output = cargo()
        .args(["metadata", "--format-version", "1", "--manifest-path"])
        .arg(root().join("Cargo.toml"))
        .args(options)
        .output()
        .context("cannot start cargo metadata")?;
    let complaint = String::from_utf8_lossy(&output.stderr);
    anyhow::ensure!(output.status.success(), "cargo metadata failed: {complaint}");
    serde_json::from_slice(&output.stdout).context("cargo metadata gave no JSON")
}

/// Whether cargo has a subcommand that is not its own.
pub fn has_subcommand(name: &str) -> bool {
    cargo().args([name, "--version"]).output().is_ok_and(|output| output.status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_cannot_be_become_is_named() {
        let error = hand_over(&mut Command::new("no-such-program")).unwrap_err().to_string();
        assert_eq!(error, "cannot start no-such-program");
    }

    #[test]
    fn metadata_that_cargo_refuses_to_give_is_an_error_with_its_words() {
        let packages = metadata(&["--no-deps", "--offline"]).unwrap();
        assert!(packages["packages"].as_array().is_some_and(|packages| !packages.is_empty()));
        let error = metadata(&["--no-such-option"]).unwrap_err().to_string();
        assert!(error.starts_with("cargo metadata failed") && error.contains("--no-such-option"), "{error}");
    }
}
