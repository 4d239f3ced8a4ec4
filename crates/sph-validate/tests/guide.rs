//! The guide shows what works: commands of the program are understood, cases of the user's own and gates are read.

use std::path::Path;

#[path = "../examples/exact_riemann.rs"]
mod exact_riemann;

use clap::Parser;
use sph_validate::gate::GateFile;
use sph_validate::{cli, suites, user};

/// Name and text of README, crate README and all chapters.
fn pages() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let chapters =
        std::fs::read_dir(root.join("docs/src")).expect("the guide").map(|e| e.expect("a file").path());
    let readmes =
        ["README.md", "crates/sph-validate/README.md", "validation/README.md"].map(|name| root.join(name));
    let markdown =
        chapters.chain(readmes).filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    markdown
        .map(|path| (path.display().to_string(), std::fs::read_to_string(&path).expect("a text")))
        .collect()
}

/// Code blocks of a language.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let start = format!("```{language}\n");
    text.split(&start).skip(1).filter_map(|rest| rest.split_once("\n```")).map(|(block, _)| block).collect()
}

#[test]
fn every_command_is_understood() {
    let mut count = 0;
    for (page, text) in pages() {
        for line in text.lines() {
            let line = line.trim().trim_start_matches('`');
            let Some(options) = line.strip_prefix("cargo xtask validate") else { continue };
            let end =
                ["#", "  ", "`"].iter().filter_map(|mark| options.find(mark)).min().unwrap_or(options.len());
            let options = &options[..end];
            // A list of options in brackets, or a place for a name, is no command.
            if ["[", "|", "<", " my.ron"].iter().any(|mark| options.contains(mark)) {
                continue;
            }
            let words = std::iter::once("validate").chain(options.split_whitespace());
            let understood = cli::Arguments::try_parse_from(words);
            assert!(understood.is_ok(), "{page}: {line}: {}", understood.unwrap_err());
            count += 1;
        }
    }
    assert!(count >= 8, "only {count} commands were found");
}

#[test]
fn cases_of_the_users_own_and_gates_are_read() {
    let (mut cases, mut gates) = (0, 0);
    for (page, text) in pages() {
        for block in blocks(&text, "ron").into_iter().filter(|block| block.contains("problem:")) {
            if let Err(error) = user::parse(block, &page) {
                panic!("{page}: {error}");
            }
            cases += 1;
        }
        for block in blocks(&text, "ron,gates") {
            let read = GateFile::read(&page, block);
            assert!(read.is_ok(), "{page}: {}", read.unwrap_err());
            gates += 1;
        }
    }
    assert!(cases >= 1 && gates >= 1, "{cases} cases, {gates} files of gates");
    assert!(!suites::names().is_empty());
}

#[test]
fn the_example_finds_the_published_contact() {
    exact_riemann::main().expect("the exact solution");
}
