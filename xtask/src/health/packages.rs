//! What each public crate would hold when it is published.

use anyhow::Context;

use super::Finding;
use crate::process;

/// Files that each crate shows to its first reader.
const EXPECTED: [&str; 5] = ["Cargo.toml", "README.md", "LICENSE-APACHE", "LICENSE-MIT", "src/lib.rs"];
/// A crate with more than this is a burden to everybody who depends on it [bytes].
const MOST_BYTES: u64 = 2_000_000;

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
fn outside(name: &str, folder: &std::path::Path, listed: &[String]) -> anyhow::Result<Vec<String>> {
    let mut faults = Vec::new();
    for file in listed.iter().filter(|file| file.starts_with("src/") && file.ends_with(".rs")) {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let depth = file.matches('/').count();
        let climbs = "../".repeat(depth + 1);
        let taken = text.lines().filter(|line| line.contains("include_") && line.contains(&climbs));
        faults
            .extend(taken.map(|line| format!("{name}/{file} takes in a file from outside: {}", line.trim())));
    }
    Ok(faults)
}
