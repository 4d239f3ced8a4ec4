//! The number that tells whether a finished run may be taken over: what changes it and what does not.

use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;

#[allow(dead_code, missing_docs)] // The script as it is, of which only the sources are looked at.
#[path = "../build.rs"]
mod build;

fn number_of(package: &Path) -> u64 {
    let mut hasher = DefaultHasher::new();
    build::hash_sources(package, &mut hasher).expect("the sources can be read");
    hasher.finish()
}

/// What an outcome is made of is kept without the names of its fields: another order of alike fields is another thing.
#[test]
fn every_source_counts_but_those_that_are_left_out() {
    let package = tempfile::tempdir().expect("a folder");
    let source = package.path().join("src");
    fs::create_dir_all(source.join("user/resolve")).expect("a folder");
    fs::create_dir(source.join("bin")).expect("a folder");
    let mut number = number_of(package.path());
    let mut is_another = |file: &str, content: &str| {
        fs::write(source.join(file), content).expect("written");
        let before = std::mem::replace(&mut number, number_of(package.path()));
        number != before
    };
    for file in [
        "outcome.rs",
        "store.rs",
        "watch.rs",
        "runner.rs",
        "user/schema.rs",
        "user/resolve/material.rs",
        "not_thought_of.rs",
    ] {
        assert!(is_another(file, "x: f64, y: f64"), "{file} is new");
        assert!(is_another(file, "y: f64, x: f64"), "{file} has changed");
    }
    for file in ["gate.rs", "report.rs", "plots.rs", "bin/sph-validate.rs"] {
        assert!(!is_another(file, "x: f64, y: f64"), "{file} changes no run");
    }
}

/// What is left out must be there, and the sources that are to count too.
#[test]
fn lists_name_what_is_there() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (path, why) in build::LEFT_OUT {
        assert!(package.join(path).exists(), "{path}, which {why}, is not there");
    }
    assert!(build::SOURCES.iter().filter(|path| package.join(path).exists()).count() >= 2);
}
