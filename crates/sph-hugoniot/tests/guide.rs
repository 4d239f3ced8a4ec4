//! The guide shows what works: its pieces of case files are read, and its commands are understood.

use std::path::{Path, PathBuf};

use clap::Parser;
use sph_hugoniot::{cli, config};

/// A case with all that is required; a piece of the guide takes the place of the field that it names.
const FIELDS: [(&str, &str); 4] = [
    ("name", "name: \"guide\","),
    ("material", "material: Library(name: \"porous-copper\"),"),
    (
        "medium",
        "medium: (cell: \"20 um\", pores: CenteredSquare(), porosity: 1.35, particle_size: \"1 um\"),",
    ),
    ("points", "points: [\"100 m/s\"],"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Name and text of README and all chapters.
fn pages() -> Vec<(String, String)> {
    let folder = root().join("docs/src");
    let chapters = std::fs::read_dir(&folder).expect("the guide").map(|entry| entry.expect("a file").path());
    let pages = chapters.chain([root().join("README.md")]);
    let markdown = pages.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    markdown
        .map(|path| (path.display().to_string(), std::fs::read_to_string(&path).expect("a text")))
        .collect()
}

/// Code blocks of a language.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let start = format!("```{language}\n");
    text.split(&start).skip(1).filter_map(|rest| rest.split_once("\n```")).map(|(block, _)| block).collect()
}

/// The page's block as a whole case.
fn whole(block: &str) -> String {
    let named = block.split(':').next().unwrap_or_default().trim();
    let others = FIELDS.iter().filter(|(name, _)| *name != named).map(|(_, text)| *text);
    format!("Case(\n{}\n{block}\n)\n", others.collect::<Vec<_>>().join("\n"))
}

#[test]
fn every_piece_of_a_case_file_is_read() {
    let mut count = 0;
    for (page, text) in pages() {
        // Whole files of other programs stand in brackets; a piece of a case file begins with the name of its field.
        for block in blocks(&text, "ron").into_iter().filter(|block| !block.starts_with('(')) {
            let case = whole(block);
            if let Err(error) = config::parse(&case, &page) {
                panic!("{page}:\n{error}");
            }
            count += 1;
        }
    }
    assert!(count >= 3, "only {count} pieces were found");
}

/// Words of a command without its comment and redirection; `None` if it is not one of the program.
fn command(line: &str) -> Option<Vec<&str>> {
    let line = line.split(['#', '>']).next().unwrap_or_default().trim();
    let line = line.strip_prefix("cargo ").unwrap_or(line);
    line.starts_with("hugoniot ").then(|| line.split_whitespace().collect())
}

#[test]
fn every_command_of_the_program_is_understood_and_its_case_is_there() {
    let mut count = 0;
    for (page, text) in pages() {
        for words in blocks(&text, "sh").iter().flat_map(|block| block.lines()).filter_map(command) {
            let understood = cli::Arguments::try_parse_from(&words);
            assert!(understood.is_ok(), "{page}: {}: {}", words.join(" "), understood.unwrap_err());
            let cases = words.iter().filter(|word| word.starts_with("cases/"));
            cases.for_each(|case| assert!(root().join(case).exists(), "{page}: {case}"));
            count += 1;
        }
    }
    assert!(count >= 4, "only {count} commands were found");
}
