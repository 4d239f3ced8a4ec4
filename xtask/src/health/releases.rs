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
    if let Err(error) = copy_tracked(&process::root(), &copy) {
        let why = format!("what git tracks cannot be copied: {error:#}");
        return Ok(Finding::not_made(name, "cargo check of a copy".to_owned(), why));
    }
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
    let of_tag = || latest_tag(&process::root());
    let baseline = match baseline.map_or_else(of_tag, |named| Ok(Some(named.to_owned()))) {
        Ok(Some(baseline)) => baseline,
        // A first release can break nobody's code.
        Ok(None) => {
            let said = "no earlier release: there is no tag, and no --baseline".to_owned();
            return Ok(Finding::of(name, said, vec![]));
        }
        Err(error) => {
            let why = format!("the latest tag is not known: {error:#}; hint: --baseline REVISION");
            return Ok(Finding::not_made(name, "cargo semver-checks".to_owned(), why));
        }
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

/// The latest tag before the state of the repository that stands in a folder; none if there is none.
fn latest_tag(folder: &Path) -> anyhow::Result<Option<String>> {
    // `git describe` fails where there is no tag as where there is no repository.
    if git(folder, &["tag", "--merged", "HEAD"])?.trim().is_empty() {
        return Ok(None);
    }
    Ok(Some(git(folder, &["describe", "--tags", "--abbrev=0"])?.trim().to_owned()))
}

/// What git says in a folder; an error with its complaint if it fails.
fn git(folder: &Path, arguments: &[&str]) -> anyhow::Result<String> {
    let output =
        Command::new("git").args(arguments).current_dir(folder).output().context("cannot start git")?;
    let complaint = String::from_utf8_lossy(&output.stderr);
    anyhow::ensure!(output.status.success(), "git {}: {}", arguments.join(" "), complaint.trim());
    Ok(String::from_utf8(output.stdout)?)
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

/// Copies the files that git tracks; what they have changed since the last commit comes along. Of an earlier copy only what
/// was built stays.
fn copy_tracked(from: &Path, to: &Path) -> anyhow::Result<()> {
    let listed = git(from, &["ls-files", "-z"])?;
    clear(to).with_context(|| to.display().to_string())?;
    for file in listed.split('\0').filter(|file| !file.is_empty()) {
        let (source, target) = (from.join(file), to.join(file));
        if !source.is_symlink() && !source.exists() {
            continue; // It was deleted since the last commit.
        }
        let folder = target.parent().context("a file has a folder")?;
        std::fs::create_dir_all(folder)?;
        if source.is_symlink() && source.is_dir() {
            link(&std::fs::read_link(&source)?, &target).with_context(|| file.to_owned())?;
        } else {
            std::fs::copy(source, &target).with_context(|| file.to_owned())?;
        }
    }
    Ok(())
}

/// Takes everything out of a folder but what cargo has built there.
fn clear(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.ends_with("target") {
            continue;
        }
        if path.is_dir() && !path.is_symlink() {
            std::fs::remove_dir_all(path)?;
        } else {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// A link to a folder.
#[cfg(unix)]
fn link(to: &Path, at: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(to, at)
}

#[cfg(not(unix))]
fn link(to: &Path, _: &Path) -> std::io::Result<()> {
    Err(std::io::Error::other(format!("a link to the folder {} is only copied on Unix", to.display())))
}

#[cfg(all(test, unix))]
mod tests {
    use std::path::PathBuf;

    use super::*;

    /// A folder for one test; what an earlier one has left there is taken away.
    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("xtask-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("a folder");
        folder
    }

    /// A repository with one commit.
    fn repository(name: &str) -> PathBuf {
        let folder = folder(name);
        git(&folder, &["init", "--quiet"]).expect("a repository");
        std::fs::create_dir(folder.join("src")).expect("a folder");
        for file in ["kept.rs", "src/deleted.rs"] {
            std::fs::write(folder.join(file), "//! Nothing.\n").expect("written");
        }
        git(&folder, &["add", "."]).expect("added");
        let author = ["-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false"];
        git(&folder, &[&author[..], &["commit", "--quiet", "--message", "first"]].concat())
            .expect("a commit");
        folder
    }

    /// The project has links to folders: a copy without them would not build.
    #[test]
    fn a_copy_has_the_links_of_the_project_and_can_be_made_twice() {
        let copy = folder("copy");
        for _ in 0..2 {
            copy_tracked(&process::root(), &copy).expect("a copy");
        }
        let gates = copy.join("crates/sph-validate/validation/riemann/gates.ron");
        assert!(gates.is_file() && copy.join("crates/sph-validate/validation").is_symlink());
        std::fs::remove_dir_all(copy).expect("its removal");
    }

    #[test]
    fn a_copy_loses_what_was_deleted_and_keeps_what_was_built() {
        let (project, copy) = (repository("tracked"), folder("tracked-copy"));
        copy_tracked(&project, &copy).expect("a copy");
        std::fs::create_dir_all(copy.join("target/debug")).expect("a folder");
        assert!(copy.join("src/deleted.rs").is_file());
        std::fs::remove_file(project.join("src/deleted.rs")).expect("deleted");
        copy_tracked(&project, &copy).expect("a copy");
        assert!(!copy.join("src").exists() && copy.join("kept.rs").is_file());
        assert!(copy.join("target/debug").is_dir());
        for folder in [project, copy] {
            std::fs::remove_dir_all(folder).expect("its removal");
        }
    }

    /// An empty copy would pass any check, and a tag that cannot be asked for is not one that is not there.
    #[test]
    fn a_folder_without_repository_is_an_error_and_one_without_tags_is_none() {
        let (nothing, project) = (folder("no-repository"), repository("tags"));
        std::fs::write(nothing.join(".git"), "nothing").expect("no repository, whatever stands above");
        let copy = nothing.join("copy");
        assert!(copy_tracked(&nothing, &copy).is_err() && !copy.exists());
        assert!(latest_tag(&nothing).is_err());
        assert_eq!(latest_tag(&project).expect("an answer"), None);
        git(&project, &["tag", "v0.1.0"]).expect("a tag");
        assert_eq!(latest_tag(&project).expect("an answer").as_deref(), Some("v0.1.0"));
        for folder in [nothing, project] {
            std::fs::remove_dir_all(folder).expect("its removal");
        }
    }
}
