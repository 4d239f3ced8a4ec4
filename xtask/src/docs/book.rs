//! The guide as a book: mdbook in one fixed version, installed into the target folder where the machine does not have it.
//!
//! Installing takes the network once, and about a minute and a half of one core. Nothing is passed over in silence: without mdbook and
//! without network the command fails and says what was not built.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use crate::process;

/// Version of mdbook that the guide is built with.
const VERSION: &str = "0.5.4";

/// Builds the guide into `target/book`.
pub fn build() -> anyhow::Result<ExitCode> {
    let Some(mdbook) = mdbook()? else {
        eprintln!(
            "error: the guide was not built as a book: mdbook {VERSION} could not be installed (see above); \
             hint: with network, cargo install mdbook --version {VERSION} --locked; --no-book leaves it out"
        );
        return Ok(ExitCode::FAILURE);
    };
    process::run(Command::new(mdbook).arg("build").arg(process::root().join("docs")))
}

/// The program: that of the machine if it has this version, else the one in the target folder, which is installed if need be.
fn mdbook() -> anyhow::Result<Option<PathBuf>> {
    let tools = process::root().join("target/tools");
    let own = tools.join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    if let Some(found) = [PathBuf::from("mdbook"), own.clone()].into_iter().find(has_version) {
        return Ok(Some(found));
    }
    println!("docs: installing mdbook {VERSION} into {}", tools.display());
    let mut install = process::cargo();
    // Unoptimized it builds in half of the time, and the guide still takes a second.
    install.args(["install", "mdbook", "--version", VERSION, "--locked", "--no-default-features", "--debug"]);
    install.arg("--force").arg("--quiet").arg("--root").arg(&tools).env("CARGO_INCREMENTAL", "0");
    let installed = process::run(&mut install)? == ExitCode::SUCCESS;
    Ok((installed && has_version(&own)).then_some(own))
}

fn has_version(program: &PathBuf) -> bool {
    let output = Command::new(program).arg("--version").output();
    output.is_ok_and(|output| is_version(&String::from_utf8_lossy(&output.stdout)))
}

/// True for `mdbook v0.5.4`.
fn is_version(words: &str) -> bool {
    words.split_whitespace().any(|word| word.trim_start_matches('v') == VERSION)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_fixed_version_is_taken() {
        assert!(is_version(&format!("mdbook v{VERSION}\n")));
        assert!(is_version(&format!("mdbook {VERSION}")));
        for other in ["mdbook v0.4.52", "mdbook v0.5.40", ""] {
            assert!(!is_version(other), "{other}");
        }
    }
}
