//! A number for everything that a figure of a run can depend on: the sources of the solver, the materials and the
//! suites, the locked versions of the libraries, compiler, target and profile. Runs that an earlier program has finished
//! are taken over only if their number is this one. Gates, reports and plots are not part of it: they may change, and no
//! run is computed again for that.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Files and folders, seen from this package; those that are there. In a published package the siblings are not: then the
/// lock file beside the manifest names their versions.
const SOURCES: [&str; 16] = [
    "../sph-core/Cargo.toml",
    "../sph-core/src",
    "../sph-materials/Cargo.toml",
    "../sph-materials/src",
    "../sph-riemann/Cargo.toml",
    "../sph-riemann/src",
    "../sph-window/Cargo.toml",
    "../sph-window/src",
    "src/case.rs",
    "src/conservation.rs",
    "src/metric.rs",
    "src/reference",
    "src/run.rs",
    "src/suites",
    "../../Cargo.lock",
    "Cargo.lock",
];

/// What cargo says of the build.
const SETTINGS: [&str; 6] =
    ["TARGET", "PROFILE", "OPT_LEVEL", "DEBUG", "CARGO_ENCODED_RUSTFLAGS", "CARGO_CFG_TARGET_FEATURE"];

fn main() -> io::Result<()> {
    let mut hasher = DefaultHasher::new();
    for source in SOURCES.into_iter().filter(|source| Path::new(source).exists()) {
        println!("cargo::rerun-if-changed={source}");
        for file in files(Path::new(source))? {
            file.to_string_lossy().hash(&mut hasher);
            fs::read(&file)?.hash(&mut hasher);
        }
    }
    for setting in SETTINGS {
        env::var_os(setting).unwrap_or_default().to_string_lossy().hash(&mut hasher);
    }
    let compiler = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version =
        String::from_utf8_lossy(&Command::new(compiler).arg("--version").output()?.stdout).into_owned();
    version.hash(&mut hasher);
    println!("cargo::rustc-env=SPH_VALIDATE_CODE={:016x}", hasher.finish());
    println!("cargo::rustc-env=SPH_VALIDATE_COMPILER={}", version.trim());
    Ok(())
}

/// The file, or all files of the folder, in a fixed order.
fn files(path: &Path) -> io::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut entries: Vec<PathBuf> =
        fs::read_dir(path)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>()?;
    entries.sort();
    let below: io::Result<Vec<Vec<PathBuf>>> = entries.iter().map(|entry| files(entry)).collect();
    Ok(below?.into_iter().flatten().collect())
}
