//! The long steps before a release.

use std::path::Path;
use std::process::Command;

use anyhow::Context;

use super::{Finding, packages};
use crate::process;

/// Packs every public crate and builds each from its package, as publishing would.
pub(super) fn dry_run() -> anyhow::Result<Finding> {
    let mut command = process::cargo();
    command.args(["publish", "--workspace", "--dry-run", "--allow-dirty"]).current_dir(process::root());
    step("dry run of publishing", &mut command)
}

/// Builds with the oldest versions that the manifests allow, in a copy of the project.
pub(super) fn oldest_dependencies() -> anyhow::Result<Finding> {
    let name = "oldest dependencies";
    let copy = process::root().join("target").join("oldest-dependencies");
    copy_tracked(&copy)?;
    let mut update = process::cargo();
    // The flag is for this one check; the compiler stays the stable one, and builds nothing with it.
    update.args(["update", "-Z", "direct-minimal-versions"]).env("RUSTC_BOOTSTRAP", "1").current_dir(&copy);
    let updated = step(name, &mut update)?;
    if !updated.faults.is_empty() {
        return Ok(updated);
    }
    let mut check = process::cargo();
    check.args(["check", "--workspace"]).current_dir(&copy);
    step(name, &mut check)
}

/// Compares the public interfaces with those of an earlier commit.
pub(super) fn interfaces(baseline: Option<&str>) -> anyhow::Result<Finding> {
    let name = "public interfaces";
    let Some(baseline) = baseline else {
        let said = "not compared: name a commit or tag with --baseline".to_owned();
        return Ok(Finding { name, faults: Vec::new(), said });
    };
    if !is_installed("semver-checks") {
        return Ok(missing(name, "cargo-semver-checks"));
    }
    let mut command = process::cargo();
    command.args(["semver-checks", "--baseline-rev", baseline]).current_dir(process::root());
    for public in packages::public_crates()? {
        command.args(["--package", &public]);
    }
    step(name, &mut command)
}

/// Looks known advisories up.
pub(super) fn advisories() -> anyhow::Result<Finding> {
    let name = "advisories";
    if !is_installed("audit") {
        return Ok(missing(name, "cargo-audit"));
    }
    step(name, process::cargo().arg("audit").current_dir(process::root()))
}

fn is_installed(subcommand: &str) -> bool {
    process::cargo().args([subcommand, "--version"]).output().is_ok_and(|output| output.status.success())
}

/// A step that was not made is told, and is no fault: not every machine has every tool.
fn missing(name: &'static str, tool: &str) -> Finding {
    Finding { name, faults: Vec::new(), said: format!("not looked at: cargo install --locked {tool}") }
}

fn step(name: &'static str, command: &mut Command) -> anyhow::Result<Finding> {
    let typed = format!("{command:?}").replace('"', "");
    let status = command.status().with_context(|| format!("cannot start {typed}"))?;
    let faults = if status.success() { Vec::new() } else { vec![format!("{typed} failed: {status}")] };
    Ok(Finding { name, faults, said: typed })
}

/// Copies the files that git tracks; what they have changed since the last commit comes along.
fn copy_tracked(to: &Path) -> anyhow::Result<()> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(process::root()).output()?;
    for file in String::from_utf8(listed.stdout)?.split('\0').filter(|file| !file.is_empty()) {
        let target = to.join(file);
        let folder = target.parent().context("a file has a folder")?;
        std::fs::create_dir_all(folder)?;
        std::fs::copy(process::root().join(file), &target).with_context(|| file.to_owned())?;
    }
    Ok(())
}
