//! Known advisories on the locked dependencies, by cargo-audit and the RustSec database.
//!
//! The database is fetched, or read from a copy that is named: a clone of `RustSec/advisory-db`, or a folder of that form
//! (`crates/NAME/RUSTSEC-….md`). A copy may be old; the day of its newest advisory is told.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::Finding;
use crate::process;

/// What cargo-audit says where it has no database to look into.
const NO_DATABASE: &str = "couldn't fetch advisory database";

const NAME: &str = "advisories";

/// Looks known advisories up, in the copy that is named or in the database itself.
pub(super) fn check(copy: Option<&Path>) -> anyhow::Result<Finding> {
    if !process::has_subcommand("audit") {
        return Ok(Finding::without_tool(NAME, "cargo-audit"));
    }
    match copy {
        Some(copy) => of_copy(copy),
        None => of_database(),
    }
}

fn of_database() -> anyhow::Result<Finding> {
    let mut command = audit();
    let output = command.output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    print!("{}", String::from_utf8_lossy(&output.stdout));
    eprint!("{said}");
    if said.contains(NO_DATABASE) {
        let why = "the advisory database is out of reach; hint: with a network, or --advisories FOLDER with a copy of \
                   https://github.com/RustSec/advisory-db";
        return Ok(Finding::not_made(NAME, "cargo audit".to_owned(), why.to_owned()));
    }
    Ok(judged(output.status.success(), "cargo audit".to_owned()))
}

fn of_copy(copy: &Path) -> anyhow::Result<Finding> {
    let advisories = advisories(copy);
    let Some(newest) = advisories.iter().filter_map(|path| day(path)).max() else {
        let why = format!(
            "{}: there are no advisories; hint: a copy of https://github.com/RustSec/advisory-db has them in \
             crates/NAME/RUSTSEC-….md",
            copy.display()
        );
        return Ok(Finding::not_made(NAME, "cargo audit".to_owned(), why));
    };
    // cargo runs in the folder of the project, the copy is named from where the user stands.
    let copy = std::path::absolute(copy)?;
    let status = audit().args(["--no-fetch", "--no-yanked", "--db"]).arg(&copy).status()?;
    let count = advisories.len();
    let said = format!("cargo audit, {count} advisories of {}, the newest of {newest}", copy.display());
    Ok(judged(status.success(), said))
}

fn audit() -> Command {
    let mut command = process::cargo();
    command.args(["audit", "--color", "never"]).current_dir(process::root());
    command
}

fn judged(is_well: bool, said: String) -> Finding {
    let faults = if is_well { vec![] } else { vec!["cargo audit has found something, or failed".to_owned()] };
    Finding::of(NAME, said, faults)
}

/// The advisories of a copy; none if it is no copy.
fn advisories(copy: &Path) -> Vec<PathBuf> {
    let list = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
    };
    let is_advisory = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with("RUSTSEC-") && name.ends_with(".md")
    };
    list(&copy.join("crates")).iter().flat_map(|folder| list(folder)).filter(is_advisory).collect()
}

/// The day that an advisory bears, as `YYYY-MM-DD`.
fn day(advisory: &Path) -> Option<String> {
    let text = std::fs::read_to_string(advisory).ok()?;
    let line = text.lines().find_map(|line| line.trim().strip_prefix("date = "))?;
    Some(line.trim_matches('"').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A copy of one advisory, which no version of a crate has mended.
    fn copy_on(package: &str) -> PathBuf {
        let copy = std::env::temp_dir().join(format!("xtask-advisories-{package}-{}", std::process::id()));
        let folder = copy.join("crates").join(package);
        std::fs::create_dir_all(&folder).expect("a folder");
        let advisory = format!(
            "```toml\n[advisory]\nid = \"RUSTSEC-2019-0001\"\npackage = \"{package}\"\ndate = \"2019-02-03\"\n\n\
             [versions]\npatched = []\n```\n\n# Made up\n\nFor a test.\n"
        );
        std::fs::write(folder.join("RUSTSEC-2019-0001.md"), advisory).expect("an advisory");
        copy
    }

    /// With cargo-audit the advisory on a crate that is locked is a fault, and that on another is none; without it, as in CI,
    /// nothing passes for looked up.
    #[test]
    fn advisory_on_a_dependency_is_a_fault_and_on_another_crate_is_none() {
        for (package, is_well) in [("rand", false), ("a-crate-that-is-none", true)] {
            let copy = copy_on(package);
            let finding = check(Some(&copy)).expect("an answer");
            if process::has_subcommand("audit") {
                assert_eq!((finding.is_well(), finding.not_made.is_none()), (is_well, true), "{package}");
                assert!(finding.said.ends_with("the newest of 2019-02-03"), "{}", finding.said);
            } else {
                assert!(
                    finding.not_made.is_some_and(|why| why.contains("cargo install --locked cargo-audit"))
                );
            }
            std::fs::remove_dir_all(copy).expect("its removal");
        }
    }

    /// An empty folder would find fault with nothing.
    #[test]
    fn a_folder_without_advisories_is_none_to_look_into() {
        let finding = of_copy(Path::new("crates")).expect("an answer");
        assert!(!finding.is_well());
        assert!(finding.not_made.is_some_and(|why| why.starts_with("crates: there are no advisories")));
    }
}
