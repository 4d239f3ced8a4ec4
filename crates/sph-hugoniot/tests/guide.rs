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
    let readmes = ["README.md", "crates/sph-hugoniot/README.md"].map(|name| root().join(name));
    let pages = chapters.chain(readmes);
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
    let (mut count, folder) = (0, tempfile::tempdir().expect("a folder"));
    for (page, text) in pages() {
        // Measured points that a page shows are those that its case names.
        let measured = blocks(&text, "text").into_iter().find(|block| block.contains("u_p [m/s], u_s"));
        let path = match measured {
            Some(table) => {
                std::fs::write(folder.path().join("measured.csv"), table).expect("a file");
                folder.path().join("guide.ron").display().to_string()
            }
            None => page.clone(),
        };
        // Whole files of other programs stand in brackets; a piece of a case file begins with the name of its field.
        for block in blocks(&text, "ron").into_iter().filter(|block| !block.starts_with('(')) {
            let case = whole(block);
            if let Err(error) = config::parse(&case, &path) {
                panic!("{page}:\n{error}");
            }
            count += 1;
        }
    }
    assert!(count >= 3, "only {count} pieces were found");
}

/// What a page tells to type of the program: lines of code, and words between backticks that have an option or a name.
fn commands(text: &str) -> Vec<Vec<String>> {
    let (mut found, mut in_code) = (Vec::new(), false);
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        } else if in_code {
            found.extend(command(line.trim().trim_start_matches("$ ")));
        } else {
            found.extend(line.split('`').skip(1).step_by(2).filter_map(command));
        }
    }
    found
}

/// Words of a command without remark and redirection; of `[options]` and of a|choice what would be typed first.
fn command(line: &str) -> Option<Vec<String>> {
    let line = line.strip_prefix("cargo ").unwrap_or(line);
    let rest = line.strip_prefix("hugoniot ")?;
    let end = ["#", "  ", ">", "|  "].iter().filter_map(|mark| rest.find(mark)).min().unwrap_or(rest.len());
    let first = |word: &str| word.replace(['[', ']'], "").split('|').next().unwrap_or_default().to_owned();
    let words: Vec<String> = rest[..end].split_whitespace().map(first).collect();
    let is_number = |word: &String| word == "N" || word == "SECONDS";
    let words = words.into_iter().map(|word| if is_number(&word) { "1".to_owned() } else { word });
    let words: Vec<String> = std::iter::once("hugoniot".to_owned()).chain(words).collect();
    (words.len() > 1 && words.iter().all(|word| word != "…")).then_some(words)
}

#[test]
fn every_command_of_the_program_is_understood_and_its_case_is_there() {
    let mut count = 0;
    for (page, text) in pages() {
        for words in commands(&text) {
            if let Err(error) = cli::Arguments::try_parse_from(&words) {
                // A command alone, `hugoniot run`, names what is spoken of.
                assert!(words.len() == 2 && error.use_stderr(), "{page}: {}: {error}", words.join(" "));
            }
            let cases = words.iter().filter(|word| word.starts_with("cases/"));
            cases.for_each(|case| assert!(root().join(case).exists(), "{page}: {case}"));
            count += 1;
        }
    }
    assert!(count >= 30, "only {count} commands were found");
}

/// What takes seconds is done: every `init`, `check` and `schema`, and every run of the smoke case.
#[test]
fn quick_commands_of_the_guide_do_what_they_say() {
    let place = tempfile::tempdir().expect("a folder");
    copy_cases(&root().join("cases"), &place.path().join("cases"));
    let mut done = std::collections::BTreeSet::new();
    for (page, text) in pages() {
        for words in commands(&text) {
            let is_quick = match words[1].as_str() {
                "init" | "schema" => true,
                "check" => words.iter().any(|word| word.starts_with("cases/")),
                "run" => words.iter().any(|word| word == "cases/smoke.ron"),
                _ => false,
            };
            if !is_quick || !done.insert(words.clone()) {
                continue;
            }
            let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_hugoniot"));
            let output =
                program.args(&words[1..]).current_dir(place.path()).output().expect("the program runs");
            let said = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(0), "{page}: {}: {said}", words.join(" "));
        }
    }
    assert!(done.len() >= 5, "{done:?}");
}

/// The cases with what they name.
fn copy_cases(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("the cases") {
        let path = entry.expect("a file").path();
        if path.is_file() {
            std::fs::copy(&path, to.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
}
