//! A number for everything that a figure of a run can depend on, and for the form in which it is kept: the sources of the
//! solver, the materials and this crate, the locked versions of the libraries, compiler, target and profile. Runs that an
//! earlier program has finished are taken over only if their number is this one. What only judges, shows or starts runs is
//! left out ([`LEFT_OUT`]): it may change, and no run is computed again for that.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Files and folders, seen from this package; those that are there. In a published package the siblings are not: then the
/// lock file beside the manifest names their versions.
pub const SOURCES: [&str; 11] = [
    "../sph-core/Cargo.toml",
    "../sph-core/src",
    "../sph-materials/Cargo.toml",
    "../sph-materials/src",
    "../sph-riemann/Cargo.toml",
    "../sph-riemann/src",
    "../sph-window/Cargo.toml",
    "../sph-window/src",
    "src",
    "../../Cargo.lock",
    "Cargo.lock",
];

/// Files and folders below the sources that cannot change what a run gives or how it is kept, and why. A file that is not
/// named here counts, so that a new one is never forgotten.
pub const LEFT_OUT: [(&str, &str); 11] = [
    ("src/bin", "starts the command line"),
    ("src/cli.rs", "chooses runs and writes what they gave"),
    ("src/gate.rs", "judges figures of runs that have ended"),
    ("src/gate_tests.rs", "tests"),
    ("src/page.rs", "shows runs that have ended"),
    ("src/page_tests.rs", "tests"),
    ("src/plots.rs", "draws runs that have ended"),
    ("src/provenance.rs", "says where a report comes from"),
    ("src/report.rs", "judges and lists runs that have ended"),
    ("src/report_tests.rs", "tests"),
    ("src/summary.rs", "shows runs that have ended"),
];

/// What cargo says of the build.
const SETTINGS: [&str; 6] =
    ["TARGET", "PROFILE", "OPT_LEVEL", "DEBUG", "CARGO_ENCODED_RUSTFLAGS", "CARGO_CFG_TARGET_FEATURE"];

fn main() -> io::Result<()> {
    let mut hasher = DefaultHasher::new();
    for source in SOURCES.into_iter().filter(|source| Path::new(source).exists()) {
        println!("cargo::rerun-if-changed={source}");
    }
    hash_sources(Path::new(""), &mut hasher)?;
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

/// Takes in the names and the contents of all sources that count, seen from the folder of the package.
///
/// # Errors
/// If a source cannot be read.
pub fn hash_sources(package: &Path, hasher: &mut impl Hasher) -> io::Result<()> {
    for source in SOURCES.into_iter().map(|source| package.join(source)).filter(|source| source.exists()) {
        for file in files(&source)? {
            let name = file.strip_prefix(package).unwrap_or(&file);
            if LEFT_OUT.iter().all(|(left_out, _)| !name.starts_with(left_out)) {
                name.to_string_lossy().hash(hasher);
                fs::read(&file)?.hash(hasher);
            }
        }
    }
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
