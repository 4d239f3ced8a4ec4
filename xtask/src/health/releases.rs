//! The long steps before a release.

use std::path::Path;
use std::process::{Command, ExitStatus};

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

/// Compares the public interfaces with those of an earlier commit: the one that is named, or else the latest tag.
pub(super) fn interfaces(baseline: Option<&str>) -> anyhow::Result<Finding> {
    let name = "public interfaces";
    let Some(baseline) = baseline.map(str::to_owned).or_else(latest_tag) else {
        // A first release can break nobody's code.
        return Ok(Finding::of(
            name,
            "no earlier release: there is no tag, and no --baseline".to_owned(),
            vec![],
        ));
    };
    if !process::has_subcommand("semver-checks") {
        return Ok(Finding::without_tool(name, "cargo-semver-checks"));
    }
    let mut command = process::cargo();
    command.args(["semver-checks", "--baseline-rev", &baseline]).current_dir(process::root());
    for public in packages::public_crates()? {
        command.args(["--package", &public]);
    }
    step(name, &mut command)
}

fn latest_tag() -> Option<String> {
    let mut command = Command::new("git");
    let output =
        command.args(["describe", "--tags", "--abbrev=0"]).current_dir(process::root()).output().ok()?;
    let tag = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !tag.is_empty()).then_some(tag)
}

fn step(name: &'static str, command: &mut Command) -> anyhow::Result<Finding> {
    let typed = format!("{command:?}").replace('"', "");
    let status = command.status().with_context(|| format!("cannot start {typed}"))?;
    let faults = fault(&typed, status);
    Ok(Finding::of(name, typed, faults))
}

fn fault(typed: &str, status: ExitStatus) -> Vec<String> {
    if status.success() { Vec::new() } else { vec![format!("{typed} failed: {status}")] }
}

/// Copies the files that git tracks; what they have changed since the last commit comes along.
fn copy_tracked(to: &Path) -> anyhow::Result<()> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(process::root()).output()?;
    for file in String::from_utf8(listed.stdout)?.split('\0').filter(|file| !file.is_empty()) {
        let target = to.join(file);
        let folder = target.parent().context("a file has a folder")?;
        std::fs::create_dir_all(folder)?;
        let source = process::root().join(file);
        if source.is_symlink() && source.is_dir() {
            link(&std::fs::read_link(&source)?, &target).with_context(|| file.to_owned())?;
        } else {
            std::fs::copy(source, &target).with_context(|| file.to_owned())?;
        }
    }
    Ok(())
}

/// A link to a folder; one of an earlier copy is replaced.
#[cfg(unix)]
fn link(to: &Path, at: &Path) -> std::io::Result<()> {
    if at.is_symlink() {
        std::fs::remove_file(at)?;
    }
    std::os::unix::fs::symlink(to, at)
}

#[cfg(not(unix))]
fn link(to: &Path, _: &Path) -> std::io::Result<()> {
    Err(std::io::Error::other(format!("a link to the folder {} is only copied on Unix", to.display())))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// The project has links to folders: a copy without them would not build.
    #[test]
    fn a_copy_has_the_links_of_the_project_and_can_be_made_twice() {
        let copy = std::env::temp_dir().join(format!("xtask-copy-{}", std::process::id()));
        for _ in 0..2 {
            copy_tracked(&copy).expect("a copy");
        }
        let gates = copy.join("crates/sph-validate/validation/riemann/gates.ron");
        assert!(gates.is_file() && copy.join("crates/sph-validate/validation").is_symlink());
        std::fs::remove_dir_all(copy).expect("its removal");
    }
}
