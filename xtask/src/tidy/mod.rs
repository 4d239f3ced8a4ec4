//! `cargo xtask tidy`: what ARCHITECTURE.md says of the house is held to be so.
//!
//! * crates depend in one direction ([`dependencies`]);
//! * sources obey the house rules: module docs, no machine paths, no stray prints, no ignored tests, no unlisted
//!   unsafe code, files that can be read ([`sources`]).
//!
//! All faults are told at once, each with its place.

mod dependencies;
mod sources;

use std::fmt;
use std::process::ExitCode;

use crate::{files, process};

/// Something that is not as it should be.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fault {
    /// File, relative to the root, with `/` between its parts.
    pub path: String,
    /// Line, from 1 on; 0 for the file as a whole.
    pub line: usize,
    /// What is wrong, and a hint.
    pub message: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.path, self.message),
            line => write!(f, "{}:{line}: {}", self.path, self.message),
        }
    }
}

/// Looks at the whole repository; exit status 1 if something is not tidy.
pub fn run() -> anyhow::Result<ExitCode> {
    let texts = files::texts(&process::root())?;
    let findings = look(&texts)?;
    for note in &findings.notes {
        println!("note: {note}");
    }
    for fault in &findings.faults {
        eprintln!("error: {fault}");
    }
    println!("tidy: {} files, {} faults", texts.len(), findings.faults.len());
    Ok(if findings.faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// All that is found, faults in the order of their places.
fn look(texts: &[files::Text]) -> anyhow::Result<sources::Findings> {
    let mut findings = sources::check(texts);
    findings.faults.extend(dependencies::check(&process::metadata(&["--no-deps", "--offline"])?)?);
    findings.faults.extend(dependencies::check_lints(texts));
    findings.faults.sort();
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_house_is_tidy() {
        let texts = files::texts(&process::root()).unwrap();
        let faults = look(&texts).unwrap().faults;
        let told: Vec<String> = faults.iter().map(ToString::to_string).collect();
        assert!(told.is_empty(), "{}", told.join("\n"));
    }
}
