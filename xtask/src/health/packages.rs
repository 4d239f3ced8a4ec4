//! What each public crate would hold when it is published.

use std::path::Path;

use anyhow::Context;

use super::Finding;
use crate::code::blank;
use crate::process;

/// Files that each crate shows to its first reader.
const EXPECTED: [&str; 5] = ["Cargo.toml", "README.md", "LICENSE-APACHE", "LICENSE-MIT", "src/lib.rs"];
/// A crate with more than this is a burden to everybody who depends on it [bytes].
const MOST_BYTES: u64 = 2_000_000;

/// Macros that take a file into the code.
const TAKES_IN: [&str; 3] = ["include_str!", "include_bytes!", "include!"];
/// What cargo calls the folder of a crate.
const CRATE_FOLDER: &str = "CARGO_MANIFEST_DIR";

/// Names of the crates that may be published.
pub(super) fn public_crates() -> anyhow::Result<Vec<String>> {
    let metadata = process::metadata(&["--no-deps"])?;
    let packages = metadata["packages"].as_array().context("metadata has no packages")?;
    let public =
        packages.iter().filter(|package| package["publish"].as_array().is_none_or(|to| !to.is_empty()));
    Ok(public.filter_map(|package| package["name"].as_str().map(str::to_owned)).collect())
}

pub(super) fn check() -> anyhow::Result<Finding> {
    let crates = public_crates()?;
    let mut faults = Vec::new();
    for name in &crates {
        let listed = listed(name)?;
        let folder = process::root().join("crates").join(name);
        let missing = EXPECTED.iter().filter(|file| !listed.iter().any(|found| found == *file));
        faults.extend(missing.map(|file| format!("{name} would be published without {file}")));
        let bytes: u64 =
            listed.iter().filter_map(|file| folder.join(file).metadata().ok()).map(|m| m.len()).sum();
        if bytes > MOST_BYTES {
            faults
                .push(format!("{name} would be published with {bytes} bytes of files; at most {MOST_BYTES}"));
        }
        faults.extend(outside(name, &folder, &listed)?);
    }
    Ok(Finding::of("packages", format!("contents of {}", crates.join(", ")), faults))
}

/// Files that the crate would be published with.
fn listed(name: &str) -> anyhow::Result<Vec<String>> {
    let output = process::cargo()
        .args(["package", "--list", "--allow-dirty", "--quiet", "--package", name])
        .current_dir(process::root())
        .output()
        .context("cannot start cargo package")?;
    let complaint = String::from_utf8_lossy(&output.stderr);
    anyhow::ensure!(output.status.success(), "cargo package --list -p {name}: {complaint}");
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect())
}

/// Files that the crate's code takes in from outside the crate: they would be missing where it is built alone.
fn outside(name: &str, folder: &Path, listed: &[String]) -> anyhow::Result<Vec<String>> {
    let mut faults = Vec::new();
    for file in listed.iter().filter(|file| file.starts_with("src/") && file.ends_with(".rs")) {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let taken = taken_in(&text).into_iter().filter(|taken| taken.is_outside(file));
        faults.extend(taken.map(|Taken { line, path, .. }| {
            format!("{name}/{file}:{line} takes in a file from outside: {path}")
        }));
    }
    Ok(faults)
}

/// A file that a source takes in.
#[derive(Debug, PartialEq)]
struct Taken {
    /// Line, from 1 on.
    line: usize,
    /// The path as it is written, its parts joined.
    path: String,
    /// Whether it is seen from the crate's folder, not from that of the source.
    from_crate: bool,
}

impl Taken {
    /// True if the path leaves the crate on its way. A link inside the crate is followed when the crate is packed.
    fn is_outside(&self, source: &str) -> bool {
        let mut depth = if self.from_crate { 0 } else { source.matches('/').count() };
        for part in self.path.split(['/', '\\']) {
            match part {
                "" | "." => {}
                ".." if depth == 0 => return true,
                ".." => depth -= 1,
                _ => depth += 1,
            }
        }
        self.path.starts_with('/') && !self.from_crate
    }
}

/// What a source takes in, with the lines of the macros: on one line or on several, by a text or by `concat!`.
fn taken_in(source: &str) -> Vec<Taken> {
    let (all, code): (Vec<char>, Vec<char>) = (source.chars().collect(), blank(source).chars().collect());
    let is_part_of_word = |c: &char| c.is_alphanumeric() || *c == '_';
    let mut taken = Vec::new();
    for at in (0..code.len()).filter(|&at| at == 0 || !is_part_of_word(&code[at - 1])) {
        let Some(name) = TAKES_IN.iter().find(|name| begins_with(&code[at..], name)) else { continue };
        let from = at + name.len();
        let argument: String = all[from..end_of_argument(&code, from)].iter().collect();
        // Every other part stands between quotes.
        let texts: Vec<&str> = argument.split('"').skip(1).step_by(2).collect();
        let from_crate = texts.contains(&CRATE_FOLDER);
        let path = texts.into_iter().filter(|text| *text != CRATE_FOLDER).collect();
        let line = 1 + all[..at].iter().filter(|c| **c == '\n').count();
        taken.push(Taken { line, path, from_crate });
    }
    taken
}

fn begins_with(code: &[char], name: &str) -> bool {
    name.chars().enumerate().all(|(k, c)| code.get(k) == Some(&c))
}

/// Where the brackets of a macro close that open from here on.
fn end_of_argument(code: &[char], from: usize) -> usize {
    let mut open = 0_usize;
    for (at, c) in code.iter().enumerate().skip(from) {
        match c {
            '(' | '[' | '{' => open += 1,
            ')' | ']' | '}' if open <= 1 => return at,
            ')' | ']' | '}' => open -= 1,
            _ => {}
        }
    }
    code.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_outside(file: &str, source: &str) -> bool {
        let taken = taken_in(source);
        assert_eq!(taken.len(), 1, "{source}");
        taken[0].is_outside(file)
    }

    #[test]
    fn paths_that_leave_the_crate_are_found_however_they_are_written() {
        for (file, source) in [
            ("src/lib.rs", "const A: &str = include_str!(\"../../a.ron\");"),
            ("src/a/b.rs", "const A: &str = include_str!(\n    \"../../../a.ron\",\n);"),
            ("src/a/b.rs", "const A: &[u8] = include_bytes!(\"../c/../../../a.png\");"),
            (
                "src/a/b.rs",
                "const A: &str = include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/../a.ron\"));",
            ),
            (
                "src/lib.rs",
                "const A: &str = include_str!(\n    concat!(\n        \"..\",\n        \"/../a.ron\"\n    )\n);",
            ),
            ("src/lib.rs", "include!(r\"../../a.rs\");"),
            ("src/lib.rs", "include!{\"/etc/a.rs\"}"),
        ] {
            assert!(is_outside(file, source), "{source}");
        }
    }

    #[test]
    fn paths_that_stay_in_the_crate_are_none() {
        for (file, source) in [
            ("src/lib.rs", "#[doc = include_str!(\"../README.md\")]"),
            ("src/a/b.rs", "const A: &str = include_str!(\"../../validation/a/gates.ron\");"),
            (
                "src/a/b.rs",
                "include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/src/a.ron\")); f(\"../../../\");",
            ),
        ] {
            assert!(!is_outside(file, source), "{source}");
        }
        assert_eq!(taken_in("//! By `include_str!(\"../../../a\")`.\nfn include() {}\n"), []);
    }

    #[test]
    fn a_file_from_outside_is_told_with_its_place() {
        let taken = taken_in("fn f() {}\n\nconst A: &str = include_str!(\n    \"../../a.ron\"\n);\n");
        let expected = Taken { line: 3, path: "../../a.ron".into(), from_crate: false };
        assert_eq!(taken, [expected]);
    }
}
